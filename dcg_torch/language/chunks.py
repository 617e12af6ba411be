"""Words -> verbs, prepositions and base noun phrases in their order."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from dcg_torch.language import lexicon as lx
from dcg_torch.language.colors import match_color
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.noun_phrases import NounPhrases
from dcg_torch.language.reader import Reader, Word
from dcg_torch.language.repairs import DETERMINERS

_SHORT = lx.word_set("it me my an in on at by to of us")  # any other two letters after "pick" are a slip of "up"


def items(words: Sequence[Word], reader: Reader, vocabulary: Collection[str]) -> list[Item]:
    """The phrases of a command from left to right. Words without a part in any are left out."""
    return _Chunker(words, reader, vocabulary).run()


class _Chunker(NounPhrases):
    def run(self) -> list[Item]:
        i = 0
        while i < len(self.words):
            i = self.step(i)
        return self.out

    def step(self, i: int) -> int:
        text, tag = self.texts[i], self.words[i].tag
        simple = self.simple(i)
        if simple is not None:
            self.add(simple, i, i + 1)
            return i + 1
        stop = self.what(i)
        if stop:
            return stop
        if self.is_relative(i):
            self.add(Kind.RELATIVE, i, i + 1)
            return i + 1
        if tag == "MD" or (text in {"please", "to"} and self.wraps(i)):
            return i + 1
        stop = self.facing(i) or self.alone(i) or self.view(i) or self.preposition(i)
        if stop:
            return stop
        if self.is_verb(i):
            return self.verb(i)
        stop = self.noun_phrase(i)
        if stop:
            return stop
        if text in lx.ADVERBS | lx.MODIFIERS or tag in {"RB", "RBS", "RP", "IN", "JJ", "JJR", "JJS"}:
            self.add(Kind.ADVERB, i, i + 1, words=(text,))
        return i + 1

    def facing(self, i: int) -> int | None:
        """ "(the chair) facing left", "(that) points to the right": how a thing stands."""
        match = lx.FACING_RE.match(self.joined, self.offsets[i])
        if match is None:
            return None
        verb, way, stop = match["verb"], match["way"], i + match.group().count(" ") + 1
        before = {Kind.RELATIVE}  # "go to the cone face left" is two commands
        if self.in_relative():
            before.add(Kind.NEGATION)
        if verb.endswith(("ing", "ed", "s")):
            before |= {Kind.NOUN, Kind.ADVERB, Kind.VERB, Kind.COMMA, Kind.AND, Kind.NEGATION}
        if self.previous() not in before or (self.in_phrase(stop) and match_color(self.texts, stop) is None):
            return None
        self.add(Kind.ADVERB, i, stop, words=(f"facing {lx.NORMAL_WORDS.get(way, way)}",))
        return stop

    def in_relative(self) -> bool:
        """Whether a relative pronoun stands behind the last noun phrase."""
        kinds = [item.kind for item in reversed(self.out)]
        return Kind.RELATIVE in kinds[: kinds.index(Kind.NOUN) if Kind.NOUN in kinds else 0]

    def alone(self, i: int) -> int | None:
        """ "(the cone) by itself"."""
        match = lx.ALONE_RE.match(self.joined, self.offsets[i])
        if match is None or self.previous() not in {Kind.NOUN, Kind.VERB, Kind.NEGATION, Kind.COMMA}:
            return None
        stop = i + match.group().count(" ") + 1
        self.add(Kind.ADVERB, i, stop, words=("alone",))
        return stop

    def view(self, i: int) -> int | None:
        """ "(on the left) from my point of view" is on my left."""
        match = lx.VIEW_RE.match(self.joined, self.offsets[i])
        if match is None or self.previous() is not Kind.NOUN:
            return None
        self.out[-1].words += (match["owner"],)
        return i + match.group().count(" ") + 1

    def what(self, i: int) -> int | None:
        """ "(drop) what you are holding": a thing, and a relative clause about it."""
        if self.texts[i] not in {"what", "whatever"} or self.previous() not in {Kind.VERB, Kind.PREPOSITION}:
            return None
        if self.text(i + 1) not in {"you", "i"} | lx.COPULAS:
            return None
        self.add(Kind.NOUN, i, i + 1, pronoun=True, determined=True)
        self.add(Kind.RELATIVE, i, i + 1)
        return i + 1

    def preposition(self, i: int) -> int | None:
        match = lx.PREPOSITION_RE.match(self.joined, self.offsets[i])
        if match is None:
            return None
        raw = match.group()
        stop = i + raw.count(" ") + (0 if raw.endswith(" ") else 1)
        normal = lx.PREPOSITIONS[int((match.lastgroup or "p0")[1:])][1]
        if not normal:  # "from" of "from above"
            return stop
        if raw in {"like", "before", "after", "as"} and self.tag(i) not in {"IN", "TO"}:
            return None
        if raw == "opposite" and self.tag(i) == "JJ" and self.text(i - 1) in DETERMINERS:
            return None
        if raw == "nearer" and self.text(i - 1) in DETERMINERS:
            return None
        if raw in {"closest", "nearest"} and not self.leads_landmark(stop):
            return None
        if raw == "like" and self.previous() in {Kind.PREPOSITION, Kind.VERB, None}:
            return stop  # a filler: "go to like the cone"
        if raw.startswith(("facing", "pointing", "touching")) and self.previous() not in {
            Kind.NOUN, Kind.VERB, Kind.NEGATION,
        }:  # fmt: skip
            return None
        if raw.startswith("from the") and normal in {"left of", "right of"} and self.ordered():
            normal, stop = "=", i + 1  # "the second from the left of the row"
            raw = "from"
        normal = lx.SAME.get(raw, raw) if normal == "=" else normal
        if (
            normal.split()[0] in {"closest", "farthest"}
            and raw.startswith("the ")
            and self.previous() in {Kind.PREPOSITION, None}
        ):
            self.add(Kind.NOUN, i, i + 1, pronoun=True, determined=True)  # "go to the closest to you"
            i += 1
        item = self.add(Kind.PREPOSITION, i, stop, words=(normal,))
        item.head = i
        return stop

    def ordered(self) -> bool:
        """Whether the last phrase counts along something: "the second cone (from ...)"."""
        return bool(self.out) and self.out[-1].kind is Kind.NOUN and not lx.ORDINALS.isdisjoint(self.out[-1].words)

    def leads_landmark(self, stop: int) -> bool:
        """Whether "nearest", which ends before `stop`, is a preposition: "the cone nearest me", no "nearest cone"."""
        if self.text(stop) in DETERMINERS or self.text(stop) in {"you", "me"}:
            return self.text(stop - 2) not in DETERMINERS
        return self.previous() is Kind.NOUN and self.in_phrase(stop)

    def verb(self, i: int) -> int:
        text = self.texts[i]
        lemma = self.reader.verb(text)
        item = self.add(Kind.VERB, i, i + 1, words=(lemma,), participle=self.words[i].tag in {"VBN", "VBG", "VBD"})
        stop = i + 1
        slip = lemma == "pick" and len(self.text(stop)) == 2 and self.text(stop) not in _SHORT
        if (self.text(stop) == "up" or slip) and lemma in {"pick", "lift", "take", "grab"}:
            item.words, item.stop = (f"{lemma} up",), stop + 1
        elif self.text(stop) == "for" and lemma in {"look", "search", "wait", "hunt"}:
            item.words, item.stop = (f"{lemma} for",), stop + 1
        elif self.text(stop) == "at" and lemma == "look":
            item.words, item.stop = ("look at",), stop + 1
        elif self.text(stop) == "for" and lemma in {"head", "make", "aim", "go"}:
            self.add(Kind.PREPOSITION, stop, stop + 1, words=("to",))
            return stop + 1
        item.text = " ".join(self.texts[i : item.stop])
        return item.stop
