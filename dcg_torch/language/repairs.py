"""What each word may be: the repairs of what the tagger gets wrong in commands are all here.

Verbs read as nouns ("place yellow cube"), nouns read as verbs ("go to drill"), colours read as names, rare nouns
read as adjectives ("the hydrant").
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

from dcg_torch.language import lexicon as lx
from dcg_torch.language.colors import match_color, normal_color, single_colors
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.reader import Reader, Word

_NOUN_TAGS = frozenset({"NN", "NNS", "NNP", "NNPS"})
_VERB_TAGS = frozenset({"VB", "VBP", "VBZ", "VBD", "VBN", "VBG"})
DETERMINERS = lx.word_set(
    """
    the a an this that these those your my its his our their th hte teh whichever whatever another
    """
)
_CONJUNCTIONS = frozenset({"and", "or", "&", "then", "but"})
STOPS = frozenset({".", "!", "?", ";", ":"})
_RELATIVES = frozenset({"which", "that", "who", "whose", "wich", "whom"})

_PREMODIFIERS = lx.MODIFIERS - lx.ADVERBS - lx.SIDES
_NEVER_NOUNS = (lx.ADVERBS - lx.DIRECTIONS - {"right"}) | {
    "which",
    "that",
    "please",
    "hey",
    "hi",
    "hello",
    "no",
    "yes",
    "ok",
}


class Words:
    """The words of a command, the items made of them so far, and what a word may be at its place."""

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

    def add(self, kind: Kind, start: int, stop: int, **fields: object) -> Item:
        """Append the item of words `start` to `stop`."""
        item = Item(kind, start, stop, stop - 1, " ".join(self.texts[start:stop]))
        for name, value in fields.items():
            setattr(item, name, value)
        self.out.append(item)
        return item

    def previous(self) -> Kind | None:
        """The last item's kind."""
        return self.out[-1].kind if self.out else None

    def text(self, i: int) -> str:
        """The word at `i`, empty outside the command."""
        return self.texts[i] if 0 <= i < len(self.texts) else ""

    def tag(self, i: int) -> str:
        """The tag at `i`, empty outside the command."""
        return self.words[i].tag if 0 <= i < len(self.words) else ""

    def simple(self, i: int) -> Kind | None:
        """The kind of a word that is an item by itself."""
        text = self.texts[i]
        if text in lx.NEGATIONS:
            return Kind.NEGATION
        if text in STOPS:
            return Kind.STOP
        if text == ",":
            return Kind.COMMA
        if text in _CONJUNCTIONS:
            return Kind.AND
        return None

    def is_relative(self, i: int) -> bool:
        """Whether a relative clause begins at `i`; "that" may be an article as well."""
        if self.texts[i] not in _RELATIVES or (self.previous() is not Kind.NOUN and self.text(i - 1) != ","):
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
        if not self.out:
            return self.reader.verb(after) == after and after in lx.COMMANDS - self.known
        if self.tag(i + 1) != "VB" or after in lx.PLACES or match_color(self.texts, i + 1):
            return False
        if self.reader.verb(after) in lx.COMMANDS and after not in self.known:
            return True
        return not (self.out[-1].kind is Kind.VERB and self.out[-1].words[0] in lx.GO and self.reader.is_noun(after))

    def is_verb(self, i: int) -> bool:
        """Whether the word at `i` is a verb and no part of a noun phrase."""
        text, tag = self.texts[i], self.words[i].tag
        if text in lx.COPULAS or tag == "MD" or text in {"has", "have", "having"}:
            return True
        before, after = self.text(i - 1), self.text(i + 1)
        if before in DETERMINERS and before != "that":
            return False
        lemma = self.reader.verb(text)
        clause_start = not self.out or self.previous() in {Kind.AND, Kind.COMMA, Kind.STOP, Kind.NEGATION}
        clause_start = clause_start or before in {"please", "you", "to", "now", "then", "just", "kindly"} | STOPS
        command = lemma in lx.COMMANDS and text == lemma
        if command and clause_start and after:
            if match_color(self.texts, i) and tag not in _VERB_TAGS:
                return False
            if text in lx.MODIFIERS | {"close", "open", "left", "back"}:
                return tag in _VERB_TAGS or (text == "back" and after in {"away", "up", "off"})
            return self.previous() is not Kind.PREPOSITION
        if tag not in _VERB_TAGS or match_color(self.texts, i) or text in lx.SIDES:
            return False
        if not command and text in lx.MODIFIERS and (tag not in {"VBN", "VBG"} or self.in_phrase(i + 1)):
            return False
        if not command and tag not in {"VBN", "VBG"} and self.heads_title(i):
            return False
        if tag in {"VBN", "VBG"} and self.words[i].dep in {"amod", "compound"} and self.in_phrase(i + 1):
            if self.out and self.out[-1].kind is Kind.NOUN and self.out[-1].stop == i:
                return True  # "the ball coloured dark blue"
            return self.previous() is None and command
        if tag in {"VB", "VBP", "VBZ"} and not command:
            if normal_color(before) in single_colors() or before in _PREMODIFIERS:
                return False
            # The tagger takes the noun for a verb: "the door handle", "go to drill", "fire hydrants".
            if text in self.known or self.reader.singular(text) in self.known:
                return False
            if self.reader.is_noun(self.reader.singular(text)):
                noun_before = self.previous() is Kind.PREPOSITION or self.words[i].dep in {"compound", "pobj", "dobj"}
                alone = self.text(i + 1) in STOPS | {",", ""} and clause_start
                return not (noun_before or alone or (self.previous() is Kind.VERB and not self.in_phrase(i + 1)))
        return True

    def heads_title(self, i: int) -> bool:
        """Whether the word is the noun of a title ("sofa bottom right", "fan behind table") and no imperative.

        Asked of words that no command begins with. A verb would be in the dictionary, and be followed by an object
        or by where to go ("scoot over to the fan").
        """
        if not self.reader.is_verb(self.texts[i]):
            return True
        if not self.reader.is_noun(self.texts[i]) or self.out:
            return False
        match = lx.PREPOSITION_RE.match(self.joined, self.offsets[i + 1]) if i + 1 < len(self.texts) else None
        if match is None:
            return self.text(i + 1) in lx.SIDES or lx.FACING_RE.match(self.joined, self.offsets[i] + 1) is not None
        normal = lx.PREPOSITIONS[int((match.lastgroup or "p0")[1:])][1]
        normal = match.group() if normal == "=" else normal
        return normal not in (lx.STRONG | lx.PATHS | {"at", "by", "over"}) - {"with", "without", "of"}

    def in_phrase(self, i: int) -> bool:
        """Whether the word at `i` may go on a noun phrase."""
        text, tag = self.text(i), self.tag(i)
        return (
            tag in _NOUN_TAGS | {"JJ", "JJR", "JJS", "CD"}
            or match_color(self.texts, i) is not None
            or text in self.known
        )

    def starts_phrase(self, i: int) -> bool:
        """Whether a noun phrase may begin at `i`."""
        return self.text(i) in DETERMINERS or self.in_phrase(i)

    def picks(self, i: int) -> bool:
        """Whether the word at `i`, before "of", picks some of several: "one of the cubes", "the leftmost of them"."""
        text = self.text(i)
        chosen = (
            text in lx.QUANTIFIERS | {"middle", "center"}
            or text in lx.NUMBERS
            or text in lx.ORDINALS
            or text.endswith("most")
        )
        compared = text in lx.MODIFIERS and (text.endswith("est") or f"{text[:-2]}est" in lx.MODIFIERS)
        if self.text(i + 1) != "of" or not (chosen or compared):
            return False
        from_what = i + 2
        while self.text(from_what) in DETERMINERS:
            from_what += 1
        if self.text(from_what) in lx.GROUPS and self.text(from_what + 1) != "of":
            return False  # "the last of the row": the row is no such thing
        if text in {"middle", "center"}:  # "the middle of the three cones", but "the middle of the table"
            return self.text(from_what) in lx.NUMBERS
        return self.starts_phrase(i + 2) or self.text(i + 2) in {"them", "these", "those", "all"}

    def ends_phrase(self, i: int) -> bool:
        """Whether a noun phrase can't go on at word `i`."""
        match = lx.PREPOSITION_RE.match(self.joined, self.offsets[i]) if i < len(self.texts) else None
        if match and " " in match.group():
            return True
        return not (
            self.in_phrase(i) or self.is_noun(i) or self.text(i) in lx.MODIFIERS | {"one", "ones"} or self.joins(i)
        )

    def leads_on(self, i: int) -> bool:
        """Whether the words at `i` say where a thing is or how it stands, whatever the tagger takes them for."""
        at = self.offsets[i]
        match = lx.PREPOSITION_RE.match(self.joined, at)
        return (match is not None and " " in match.group()) or lx.FACING_RE.match(self.joined, at) is not None

    def joins(self, i: int) -> bool:
        """Whether "and" or a comma at `i` stands between the colours or other words of one thing."""
        return (
            self.text(i) in {"and", ",", "&"}
            and (match_color(self.texts, i + 1) is not None or self.text(i + 1) in lx.MODIFIERS)
            and (self.in_phrase(i + 2) or self.is_noun(i + 2) or self.text(i + 2) in {"and", "one", ","})
        )

    def is_adjective(self, i: int) -> bool:
        """Whether the tagger takes the word for an adjective, or for a participle in front of a noun."""
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
        """Whether the word at `i` may be a noun or part of one.

        `strict` trusts the tag alone, `loose` takes almost any word.
        """
        if not 0 <= i < len(self.words):
            return False
        text, tag = self.texts[i], self.words[i].tag
        if text in self.known or self.is_compound(i):
            return True
        if not all(part.isalpha() for part in text.split("'") if part) or not text.isascii() or len(text) > 40:
            return False
        if text in DETERMINERS or text in lx.PRONOUNS or self.simple(i) or text in lx.COPULAS:
            return False
        if lx.PREPOSITION_RE.match(self.joined, self.offsets[i]) and tag not in _NOUN_TAGS:
            return False
        if tag in _NOUN_TAGS:
            return text not in _NEVER_NOUNS
        if (
            strict
            or text in lx.ADVERBS | lx.MODIFIERS | lx.QUANTIFIERS
            or tag in {"MD", "TO", "WDT", "WRB", "WP", "CC"}
        ):
            return False
        if tag in {"VBN", "VBD"}:
            described = normal_color(self.text(i - 1)) in single_colors() or self.text(i - 1) in _PREMODIFIERS
            return described and not self.reader.is_english(text)  # "the red parallelepiped"
        if tag in {"VB", "VBP", "VBZ", "VBG"} and not loose:
            before = self.text(i - 1)
            return not self.is_verb(i) and (self.reader.is_noun(self.reader.singular(text)) or before in DETERMINERS)
        return loose or (self.reader.is_noun(self.reader.singular(text)) and tag not in {"IN", "DT", "PRP", "EX"})
