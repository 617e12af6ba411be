"""Words -> verbs, prepositions and base noun phrases in their order, on spaCy's tags.

The repairs of what the tagger gets wrong in commands are all here: verbs read as nouns, nouns read as verbs,
colours read as names, prepositions of several words.
"""

from __future__ import annotations

import enum
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field

from dcg_torch.language import lexicon as lx
from dcg_torch.language.colors import match_color
from dcg_torch.language.reader import Reader, Word

_NOUN_TAGS = frozenset({"NN", "NNS", "NNP", "NNPS"})
_MODIFIER_TAGS = frozenset({"JJ", "JJR", "JJS", "VBN", "VBG", "CD"})
_VERB_TAGS = frozenset({"VB", "VBP", "VBZ", "VBD", "VBN", "VBG"})
_DETERMINERS = frozenset("the a an this that these those your my its his our their th hte teh whichever whatever another".split())
_CONJUNCTIONS = frozenset({"and", "or", "&", "then", "but"})
_STOPS = frozenset({".", "!", "?", ";", ":"})
_RELATIVES = frozenset({"which", "that", "who", "whose", "wich", "whom"})
_SHORT = frozenset("it me my an in on at by to of us".split())  # any other two letters after "pick" are a slip of "up"


class Kind(enum.Enum):
    """What an item of a command is."""

    VERB = "verb"
    PREPOSITION = "preposition"
    NOUN = "noun"
    RELATIVE = "relative"  # which, that, who
    NEGATION = "negation"
    AND = "and"
    COMMA = "comma"
    STOP = "stop"
    ADVERB = "adverb"


@dataclass(slots=True, eq=False)
class Item:
    """A phrase before it has a place in the tree. `start` and `stop` are word indices, `head` the head word's."""

    kind: Kind
    start: int
    stop: int
    head: int
    text: str
    words: tuple[str, ...] = ()
    noun: str | None = None
    color: str | None = None
    plural: bool = False
    count: int | None = None
    pronoun: bool = False  # it, one, that: stands for something else
    participle: bool = False  # a verb's -ed or -ing form
    determined: bool = False  # has an article
    children: list[Item] = field(default_factory=list)


def items(words: Sequence[Word], reader: Reader, vocabulary: Collection[str]) -> list[Item]:
    """The phrases of a command from left to right. Words without a part in any are left out."""
    return _Chunker(words, reader, vocabulary).run()


class _Chunker:
    def __init__(self, words: Sequence[Word], reader: Reader, vocabulary: Collection[str]) -> None:
        self.words = words
        self.texts = [word.text for word in words]
        self.reader = reader
        self.compounds = {tuple(noun.lower().split()) for noun in vocabulary if " " in noun.strip()}
        self.known = {noun.lower() for noun in vocabulary}
        self.joined = " ".join(self.texts)
        self.offsets: list[int] = []
        offset = 0
        for text in self.texts:
            self.offsets.append(offset)
            offset += len(text) + 1
        self.out: list[Item] = []

    def run(self) -> list[Item]:
        i = 0
        while i < len(self.words):
            i = self.step(i)
        return self.out

    # One item at a time ------------------------------------------------------------------------------------------

    def step(self, i: int) -> int:
        text, tag = self.texts[i], self.words[i].tag
        simple = self.simple(i)
        if simple is not None:
            self.add(simple, i, i + 1)
            return i + 1
        if self.is_relative(i):
            self.add(Kind.RELATIVE, i, i + 1)
            return i + 1
        if tag == "MD" or text in {"please", "to"} and self.wraps(i):
            return i + 1
        stop = self.preposition(i)
        if stop:
            return stop
        if self.is_verb(i):
            return self.verb(i)
        stop = self.noun_phrase(i)
        if stop:
            return stop
        if text in lx.ADVERBS or tag in {"RB", "RP", "IN", "JJ"}:
            self.add(Kind.ADVERB, i, i + 1, words=(text,))
        return i + 1

    def simple(self, i: int) -> Kind | None:
        text = self.texts[i]
        if text in lx.NEGATIONS:
            return Kind.NEGATION
        if text in _STOPS:
            return Kind.STOP
        if text == ",":
            return Kind.COMMA
        if text in _CONJUNCTIONS:
            return Kind.AND
        return None

    def add(self, kind: Kind, start: int, stop: int, **fields: object) -> Item:
        item = Item(kind, start, stop, stop - 1, " ".join(self.texts[start:stop]))
        for name, value in fields.items():
            setattr(item, name, value)
        self.out.append(item)
        return item

    def previous(self) -> Kind | None:
        return self.out[-1].kind if self.out else None

    def text(self, i: int) -> str:
        return self.texts[i] if 0 <= i < len(self.texts) else ""

    def tag(self, i: int) -> str:
        return self.words[i].tag if 0 <= i < len(self.words) else ""

    # Relative pronouns and "to" before a verb ----------------------------------------------------------------------

    def is_relative(self, i: int) -> bool:
        if self.texts[i] not in _RELATIVES or self.previous() is not Kind.NOUN and self.text(i - 1) != ",":
            return False
        after = self.text(i + 1)
        if self.texts[i] == "that":
            return after in lx.COPULAS or self.tag(i + 1) in _VERB_TAGS | {"MD"} or after in {"you", "i", "has", "the"}
        return True

    def wraps(self, i: int) -> bool:
        """Whether "to" at `i` leads an infinitive: "I want you to go", but not "go to drill"."""
        if self.texts[i] == "please":
            return True
        after = self.text(i + 1)
        if self.tag(i + 1) != "VB" or not self.out:
            return False
        if self.reader.verb(after) in lx.COMMANDS and after not in self.known:
            return True
        return not (self.out[-1].kind is Kind.VERB and self.out[-1].words[0] in lx.GO and self.reader.is_noun(after))

    # Prepositions --------------------------------------------------------------------------------------------------

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
        if raw == "opposite" and self.tag(i) == "JJ" and self.text(i - 1) in _DETERMINERS:
            return None
        if raw in {"nearer", "closest", "nearest"} and self.text(i - 1) in _DETERMINERS:
            return None
        if raw in {"facing", "touching"} and self.previous() is not Kind.NOUN and self.previous() is not Kind.VERB:
            return None
        normal = lx.SAME.get(raw, raw) if normal == "=" else normal
        if normal.split()[0] in {"closest", "farthest"} and raw.startswith("the ") and self.previous() in {Kind.PREPOSITION, None}:
            self.add(Kind.NOUN, i, i + 1, pronoun=True, determined=True)  # "go to the closest to you"
            i += 1
        item = self.add(Kind.PREPOSITION, i, stop, words=(normal,))
        item.head = i
        return stop

    # Verbs -----------------------------------------------------------------------------------------------------------

    def is_verb(self, i: int) -> bool:
        text, tag = self.texts[i], self.words[i].tag
        if text in lx.COPULAS or tag == "MD" or text in {"has", "have", "having"}:
            return True
        before, after = self.text(i - 1), self.text(i + 1)
        if before in _DETERMINERS and before != "that":
            return False
        lemma = self.reader.verb(text)
        clause_start = not self.out or self.previous() in {Kind.AND, Kind.COMMA, Kind.STOP, Kind.NEGATION}
        clause_start = clause_start or before in {"please", "you", "to", "now", "then", "just", "kindly"} | _STOPS
        command = lemma in lx.COMMANDS and text == lemma
        if command and clause_start and after:
            if match_color(self.texts, i) and tag not in _VERB_TAGS:
                return False
            if text in lx.MODIFIERS | {"close", "open", "left", "back"}:
                return tag in _VERB_TAGS or (text == "back" and after in {"away", "up", "off"})
            return self.previous() is not Kind.PREPOSITION
        if tag not in _VERB_TAGS or match_color(self.texts, i) or text in lx.SIDES:
            return False
        if tag in {"VBN", "VBG"} and self.words[i].dep in {"amod", "compound"} and self.in_phrase(i + 1):
            return self.previous() is None and command
        if tag in {"VB", "VBP", "VBZ"} and not command:
            # The tagger takes the noun for a verb: "the door handle", "go to drill", "fire hydrants".
            if text in self.known or self.reader.singular(text) in self.known:
                return False
            if self.reader.is_noun(self.reader.singular(text)):
                noun_before = self.previous() is Kind.PREPOSITION or self.words[i].dep in {"compound", "pobj", "dobj"}
                alone = self.text(i + 1) in _STOPS | {",", ""} and clause_start
                return not (noun_before or alone or (self.previous() is Kind.VERB and not self.in_phrase(i + 1)))
        return True

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

    # Noun phrases --------------------------------------------------------------------------------------------------

    def in_phrase(self, i: int) -> bool:
        """Whether the word at `i` may go on a noun phrase."""
        text, tag = self.text(i), self.tag(i)
        return tag in _NOUN_TAGS | {"JJ", "JJR", "JJS", "CD"} or match_color(self.texts, i) is not None or text in self.known

    def noun_phrase(self, i: int) -> int | None:
        words, texts = self.words, self.texts
        start = i
        color: str | None = None
        modifiers: list[str] = []
        nouns: list[int] = []
        count: int | None = None
        plural = False
        determined = False
        pronoun = False
        while i < len(words):
            text, tag = texts[i], words[i].tag
            if text == "he" and i == start and self.in_phrase(i + 1):
                text = "the"  # a slip: nobody is called "he" in front of a noun
            if text in _DETERMINERS and not (text in {"that", "this", "those", "these"} and not self.in_phrase(i + 1) and text not in {"the"}):
                if i > start and not (texts[i - 1] in lx.QUANTIFIERS | {"of", "single"} or texts[i - 1] in _DETERMINERS):
                    break
                if text in {"your", "my"}:
                    modifiers.append(text)
                determined = True
                i += 1
                continue
            if text in lx.PRONOUNS and text not in {"one", "ones"}:
                if i == start or determined and not nouns and not color:
                    return self.pronoun(start, i)
                break
            if nouns and i == nouns[-1] + 1 and text == "of" and texts[i - 1] in lx.GROUPS | lx.CARRIERS | {"ones"}:
                unit = texts[i - 1]
                if self.starts_phrase(i + 1):
                    nouns.pop()
                    if unit in {"pair", "couple"}:
                        count = 2
                    elif unit in lx.GROUPS:
                        modifiers.append(unit)
                        plural = True
                    i += 1
                    while self.text(i) in _DETERMINERS:
                        i += 1
                    continue
                break
            if text == "of" and i > start and self.picks(i - 1) and not nouns:
                if texts[i - 1] == "one":
                    modifiers.append("one of")
                if texts[i - 1] == "one" or texts[i - 1] in lx.MODIFIERS:
                    count = 1
                i += 1
                continue
            if text in {"one", "ones"} and (determined or color or modifiers) and self.text(i + 1) != "of":
                if nouns:
                    break  # "the cube one space left"
                if self.in_phrase(i + 1) and self.text(i + 1) not in lx.MODIFIERS:  # "the one red cube"
                    count, i = 1, i + 1
                    continue
                pronoun = True
                plural = plural or text == "ones"
                i += 1
                break
            if count is not None and self.reader.singular(text) in lx.MEASURES and not nouns and not determined:
                after = self.text(i + 1)
                if after in lx.DIRECTIONS | lx.ADVERBS or not self.is_noun(i + 1):
                    return i + 1  # "two squares to the left": a distance is no object
            if text in lx.NUMBERS or (tag == "CD" and text.isdigit()):
                if nouns:
                    break
                count = lx.NUMBERS.get(text) or (int(text) if len(text) < 4 else None)
                i += 1
                if text == "one" and self.text(i) != "of" and not self.in_phrase(i):
                    pronoun = True
                    break
                continue
            if text in lx.QUANTIFIERS and not nouns:
                plural = plural or text in {"all", "both", "several"}
                count = 2 if text == "both" else count
                modifiers.append(text)
                i += 1
                continue
            found = match_color(texts, i)
            if found and not self.is_compound(i):
                name, stop = found
                if nouns and (self.colored_noun_follows(stop) or color):
                    break  # "the cone red cube": another phrase begins
                if color is None:
                    color = name
                else:
                    modifiers.append(name)
                i = stop
                continue
            if nouns and text in lx.MODIFIERS and texts[nouns[-1]] not in lx.MODIFIERS and not self.is_compound(i):
                break
            if text in lx.MODIFIERS or self.is_adjective(i):
                last = self.ends_phrase(i + 1)
                if last and (not nouns or nouns[-1] == i - 1) and text not in lx.MODIFIERS - {"square"} and self.reader.is_noun(text):
                    nouns.append(i)  # the tagger takes rare nouns for adjectives: "the hydrant"
                    i += 1
                    continue
                if nouns and nouns[-1] == i - 1 and not self.is_noun(i + 1):
                    break
                if last and not self.is_noun(i, strict=True) and not (text in lx.DIRECTIONS | lx.PLACES):
                    if not (determined or color or modifiers):
                        break
                    modifiers.append(text)
                    i += 1
                    break
                if last and (text in lx.DIRECTIONS | lx.PLACES or text not in lx.MODIFIERS):
                    nouns.append(i)
                else:
                    modifiers.append(text)
                i += 1
                continue
            if self.is_noun(i):
                if nouns and nouns[-1] != i - 1:
                    break
                nouns.append(i)
                i += 1
                continue
            joint = text in {"and", ",", "&"} and not nouns and (color or modifiers) and i > start
            if joint and self.text(i + 1) == "and":
                i += 1
            if joint and (match_color(texts, i + 1) or self.text(i + 1) in lx.MODIFIERS) and not self.ends_phrase(i):
                i += 1
                continue
            break
        if i == start or not (nouns or color or pronoun or (determined and modifiers) or "one of" in modifiers):
            if determined and i > start and not nouns and self.is_noun(i, loose=True) and i < len(texts):
                nouns.append(i)
                i += 1
            else:
                return None
        return self.close(start, i, nouns, color, modifiers, count, plural, determined, pronoun)

    def close(
        self, start: int, stop: int, nouns: list[int], color: str | None, modifiers: list[str], count: int | None,
        plural: bool, determined: bool, pronoun: bool,
    ) -> int:  # fmt: skip
        texts = self.texts
        head = nouns[-1] if nouns else stop - 1
        # "the orange" is a colour unless oranges are known; a closing colour is the head of a phrase without noun.
        if not nouns and color is not None and color in self.known and texts[stop - 1] == color:
            nouns, color, head = [stop - 1], None, stop - 1
        noun: str | None = None
        if nouns:
            parts = [texts[n] for n in nouns]
            plural = plural or self.reader.is_plural(parts[-1], self.words[head].tag)
            parts[-1] = self.reader.singular(parts[-1])
            while len(parts) > 1 and parts[0] in lx.SIDES | {"hand"}:
                modifiers.append(parts.pop(0))
            noun = " ".join(parts)
            noun = {"centre": "center"}.get(noun, noun)
            if noun in {"side", "hand side"} and {"left", "right"} & set(modifiers):
                noun = "left" if "left" in modifiers else "right"
                modifiers = [word for word in modifiers if word not in {"left", "right", "hand"}]
        plural = (plural or (count or 0) > 1) and count != 1
        words = tuple(dict.fromkeys(lx.NORMAL_WORDS.get(word, word) for word in modifiers))
        item = self.add(
            Kind.NOUN, start, stop, noun=noun, color=color, words=words, plural=plural, count=count,
            pronoun=pronoun or noun is None, determined=determined,
        )  # fmt: skip
        item.head = head
        return stop

    def pronoun(self, start: int, i: int) -> int:
        text = self.texts[i]
        self.add(Kind.NOUN, start, i + 1, noun=lx.PRONOUNS[text], pronoun=lx.PRONOUNS[text] is None)
        return i + 1

    # What may stand where ------------------------------------------------------------------------------------------

    def starts_phrase(self, i: int) -> bool:
        return self.text(i) in _DETERMINERS or self.in_phrase(i)

    def picks(self, i: int) -> bool:
        """Whether the word at `i` picks from a group: "one of the cubes", "all of them", "the leftmost of the cubes"."""
        text = self.text(i)
        chosen = text in lx.QUANTIFIERS or text in lx.NUMBERS or text in lx.ORDINALS or text.endswith("most")
        return (chosen or (text.endswith("est") and text in lx.MODIFIERS)) and self.starts_phrase(i + 2)

    def ends_phrase(self, i: int) -> bool:
        """Whether a noun phrase can't go on at word `i`."""
        match = lx.PREPOSITION_RE.match(self.joined, self.offsets[i]) if i < len(self.texts) else None
        if match and " " in match.group():
            return True
        return not (self.in_phrase(i) or self.is_noun(i) or self.text(i) in lx.MODIFIERS | {"one", "ones"} or self.joins(i))

    def joins(self, i: int) -> bool:
        return self.text(i) in {"and", ",", "&"} and match_color(self.texts, i + 1) is not None and (
            self.in_phrase(i + 2) or self.text(i + 2) in {"and", "one", ","}
        )

    def colored_noun_follows(self, i: int) -> bool:
        return self.is_noun(i) or self.text(i) in {"one", "ones"}

    def is_adjective(self, i: int) -> bool:
        text, word = self.texts[i], self.words[i]
        if text in self.known or self.is_compound(i) or text in lx.ADVERBS:
            return False
        if word.tag in {"JJ", "JJR", "JJS"}:
            return True
        return word.tag in {"VBN", "VBG"} and word.dep in {"amod", "compound"} and self.is_noun(i + 1)

    def is_compound(self, i: int) -> bool:
        """Whether a known noun of several words begins or goes on at `i`."""
        return any(
            tuple(self.texts[i - k : i - k + len(compound)]) == compound
            for compound in self.compounds
            for k in range(min(len(compound), i + 1))
        )

    def is_noun(self, i: int, strict: bool = False, loose: bool = False) -> bool:
        if not 0 <= i < len(self.words):
            return False
        text, tag = self.texts[i], self.words[i].tag
        if text in self.known or self.is_compound(i):
            return True
        if not all(part.isalpha() for part in text.split("'") if part) or not text.isascii() or len(text) > 40:
            return False
        if text in _DETERMINERS or text in lx.PRONOUNS or self.simple(i) or text in lx.COPULAS:
            return False
        if lx.PREPOSITION_RE.match(self.joined, self.offsets[i]) and tag not in _NOUN_TAGS:
            return False
        if tag in _NOUN_TAGS:
            return text not in lx.ADVERBS - lx.DIRECTIONS - {"right"} and not (
                text in {"which", "that", "please", "hey", "hi", "hello"}
            )
        if strict or text in lx.ADVERBS | lx.MODIFIERS | lx.QUANTIFIERS or tag in {"MD", "TO", "WDT", "WRB", "WP", "CC"}:
            return False
        if tag in {"VBN", "VBD"}:
            return False
        if tag in {"VB", "VBP", "VBZ", "VBG"} and not loose:
            before = self.text(i - 1)
            return not self.is_verb(i) and (self.reader.is_noun(self.reader.singular(text)) or before in _DETERMINERS)
        return loose or (self.reader.is_noun(self.reader.singular(text)) and tag not in {"IN", "DT", "PRP", "EX"})
