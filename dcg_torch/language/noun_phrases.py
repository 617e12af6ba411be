"""Tagged tokens -> one base noun phrase: noun, colour, number and other words, without what stands below it."""

from __future__ import annotations

from collections.abc import Sequence

from dcg_torch.english.forms import parts, singular
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.lexicon import NORMAL, NUMBERS, SETS
from dcg_torch.language.predicates import normal_words
from dcg_torch.language.tagging import Reader, Token

_HEADS = frozenset({"N", "SIDE", "ONE"})
_DESCRIBING = frozenset({"COL", "MOD"})
_NOUNS = frozenset({"ORD", "NM", "ONE", "N", "SIDE"})
_STARTS = frozenset({"DET", "Q", "NUM", "ORD", "MOD", "COL", "NM", "N", "SIDE"})
_LONGEST_NUMBER = 3


class NounPhrase(Reader):
    """Reads the noun phrase that begins at a token; `at` is the token behind it.

    `alone`: no noun phrase stands before it in its sentence, so that "biggest" by itself is one. A method for each tag
    says how many tokens it takes: 0 where the noun phrase ends.
    """

    def __init__(self, tokens: Sequence[Token], start: int, alone: bool) -> None:
        super().__init__(tokens)
        self.start, self.at, self.alone = start, start, alone
        self.nouns: list[Token] = []
        self.color: str | None = None
        self.words: list[str] = []
        self.count: int | None = None
        self.of: int | None = None  # how many a group has: "the row of five cubes"
        self.group: str | None = None
        self.picked = False  # "the bigger of the ...": what follows tells what it is picked from
        self.negative = self.plural = self.determined = self.pronoun = self.closed = self.is_measure = False
        parts = {"DET": self._determiner, "Q": self._quantifier, "NUM": self._number, "ORD": self._describe,
                 "MOD": self._describe, "COL": self._color, "NM": self._noun, "N": self._noun, "SIDE": self._noun,
                 "ONE": self._one, "NAME": self._name, "POS": self._possessive, "P": self._of, "NEG": self._denial,
                 "AND": self._joint, "COMMA": self._joint, "PRO": self._them}  # fmt: skip
        while self.at < len(tokens) and not self.closed:
            tag = tokens[self.at].tag
            late = self.headed if tag in _DESCRIBING | _NOUNS else self.nouns and tag in _STARTS
            taken = 0 if late or tag not in parts else parts[tag](tokens[self.at])
            if not taken:
                break
            self.at += taken
        self._settle()

    @property
    def headed(self) -> bool:
        """Whether the noun has its last word."""
        return bool(self.nouns) and self.nouns[-1].tag in _HEADS

    def _determiner(self, token: Token) -> int:
        if self.at > self.start and self.tag(self.at - 1) not in {"Q", "DET", "P"}:
            return 0
        self.negative = self.negative or token.text in SETS["none"]
        if token.value[0] in SETS["owned"]:
            self.words.append(token.value[0])
        self.determined = True
        return 1

    def _quantifier(self, token: Token) -> int:
        self.count = {"both": 2, "one of": 1}.get(token.value[0], self.count)
        if not self.picked:  # "the biggest of all the cubes"
            self.words += token.value
            self.plural = self.plural or token.text in SETS["of_many"]
        self.picked = self.picked or token.value == ("one of",)
        return 1

    def _number(self, token: Token) -> int:
        short = token.text.isdecimal() and len(token.text) <= _LONGEST_NUMBER
        number = NUMBERS.get(token.text) or (int(token.text) if short else None)
        if self.group is not None or (self.picked and self.count == 1 and (number or 0) > 1):
            self.of = number  # "the left one of the two cubes"
            return 1
        if not self.determined and singular(self.text(self.at + 1)) in SETS["measures"]:
            behind = self.tag(self.at + 2)
            if behind not in _STARTS - {"DET", "SIDE"} or self.text(self.at + 2) in SETS["directions"]:
                self.is_measure = self.closed = True
                return 2
        self.count = self.count if self.picked else number
        if token.text == "one" and self.tag(self.at + 1) not in _STARTS:
            self.pronoun = self.closed = True
        return 1

    def _describe(self, token: Token) -> int:
        if self.words or token.text not in SETS["color_fillers"]:
            self.words += token.value
        return 1

    def _color(self, token: Token) -> int:
        after = self.text(self.at + 1)
        if self.tag(self.at + 1) == "MOD" and after.endswith("ed") and after not in SETS["color_fillers"]:
            self.words.append(f"{token.value[0]} {after}")  # "white-haired", "red-tipped": it is no colour of the whole
            return 2
        if self.color is not None:
            self.words.append(token.value[0])  # "the red and blue tower": the first is its colour
        self.color = self.color or token.value[0]
        return 1 + (after in SETS["color_fillers"])

    def _noun(self, token: Token) -> int:
        filler = token.text in SETS["color_fillers"] and (self.words or self.color)  # "the dark coloured ball"
        if not (filler and self.tag(self.at + 1) in _STARTS):
            self.nouns.append(token)
        return 1

    def _one(self, token: Token) -> int:
        """ "The red one"; "the one red cube"."""
        one = token.text == "one"
        if one and self.determined and self.tag(self.at + 1) in {"COL", "N", "NM"}:
            self.count = 1
        else:
            self.pronoun = True
            self.closed = not self.words or self.text(self.at + 1) != "of"  # "the middle one of the cubes"
            self.plural = self.plural or not one
        return 1

    def _name(self, token: Token) -> int:
        """ "Cube 3": a number that is part of a name."""
        if not self.headed or singular(self.text(self.at + 1)) in SETS["measures"]:
            return 0
        self.words += token.value
        return 1

    def _denial(self, token: Token) -> int:
        """ "The not blue cube", "a non red one"."""
        after = self.tag(self.at + 1)
        if not (self.determined or self.words) or self.nouns or after not in _DESCRIBING:
            return 0
        self.words.append(f"not {self.tokens[self.at + 1].value[0]}")
        return 2

    def _joint(self, token: Token) -> int:
        """The "and" and commas of "the red, white and blue tower"."""
        if self.nouns or not (self.color or self.words) or self.picked:
            return 0
        at = self.at + 1 + (self.text(self.at + 1) == "and")
        follows = self.tag(at + 1) in {"N", "NM", "AND", "ONE", "COMMA", *_DESCRIBING}
        if self.tag(at) not in _DESCRIBING or not follows:
            return 0
        return at - self.at

    def _possessive(self, token: Token) -> int:
        """ "The robot's cube" is the cube."""
        if not self.nouns or self.tag(self.at + 1) not in _STARTS:
            return 0
        self.nouns, self.color = [], None
        return 1

    def _of(self, token: Token) -> int:
        """What "of" makes of a group ("the row of cubes"), a place ("the position of the cube"), a pick."""
        if token.text != "of" or self.at == self.start:
            return 0
        return self._group_of() or self._pick_of()

    def _group_of(self) -> int:
        if not self.headed or self.tag(self.at + 1) not in _STARTS:
            return 0
        last = self.nouns[-1].text
        unit = last if last in SETS["groups"] | SETS["carriers"] else singular(last)
        crossing = any(token.text in SETS["lines"] for token in self.tokens[self.at + 2 : self.at + 4])
        if unit not in SETS["groups"] | SETS["carriers"] or (crossing and unit in SETS["lines"]):
            return 0  # "the second column of the third row" is no group of rows
        self.words += [t.text for t in self.nouns[:-1]]
        self.nouns = []
        if unit in SETS["pairs"]:
            self.words += [unit] if unit in SETS["close_pairs"] else []
            if self.picked and self.count == 1:
                self.of = 2
            else:
                self.count = 2
        elif unit in SETS["groups"]:
            self.words.append(unit)
            self.group = unit
            self.plural = True
            self.count = self.count if self.picked else None  # "two rows of cubes" are not two cubes
        return self._behind_determiners() - self.at

    def _behind_determiners(self) -> int:
        """The token behind this one and the determiners that follow it."""
        after = self.at + 1
        while self.tag(after) == "DET":
            after += 1
        return after

    def _pick_of(self) -> int:
        """ "One of the cubes", "all of the cubes", "the leftmost of the cubes"."""
        picker = self.tokens[self.at - 1]
        # "The middle of the three cones", but "the middle of the table".
        counted = self.tag(self._behind_determiners()) == "NUM" and picker.text in SETS["counted_middles"]
        if self.headed and not (picker.tag == "SIDE" and counted):
            return 0
        if not self.headed and (self.nouns or picker.tag not in {"Q", "NUM", "ORD", "MOD", "ONE"}):
            return 0
        after = self._behind_determiners()
        bare_group = self.text(after) in SETS["groups"] and self.text(after + 1) != "of"
        several = self.tag(self.at + 1) in _STARTS or self.text(self.at + 1) in SETS["group_pronouns"]
        if bare_group or not several:
            self.closed = True  # "the last of the row": the row is no such thing
            return 0
        if self.nouns:
            self.words.append(self.nouns.pop().text)
        if picker.text in {"one", "either"} or picker.tag in {"ORD", "MOD", "SIDE"}:
            self.count = 1
        self.picked, self.pronoun = True, False
        return 1

    def _them(self, token: Token) -> int:
        """ "All of them"."""
        if not self.picked or self.nouns or token.text not in SETS["group_pronouns"]:
            return 0
        self.pronoun = self.closed = True
        self.plural = self.plural or self.count != 1
        return 1

    def _settle(self) -> None:
        """Whether the words are a noun phrase, once they have been read."""
        if not self.nouns and not self.color and self.words and self.tag(self.at - 1) == "MOD":
            self._noun_after_all()
        ordered = bool(self.words) and self.words[-1] in SETS["ordinals"] and self.text(self.at) == "from"
        picked = self.determined and (bool(self.words) or self.count is not None)  # "the biggest", "those two"
        picked = picked or (self.alone and bool(self.words))
        self.named = bool(self.nouns or self.color or self.pronoun or picked or ordered or "one of" in self.words)

    def _noun_after_all(self) -> None:
        """ "(A sheet of) metal": an adjective that is a noun as well is one where no other is."""
        last = self.tokens[self.at - 1]
        kinds = parts(last.text)
        rather = kinds.get("n", 0) > kinds.get("a", 0) + kinds.get("r", 0)  # a noun than an adjective
        if last.text in SETS["sides"] or (rather if last.text in SETS["modifiers"] else "n" in kinds):
            self.words.pop()
            self.nouns = [last]

    def item(self) -> Item:
        """The noun phrase as an item."""
        if self.of is not None:
            self.words.append(f"of {self.of}")
        noun = self._noun_name() if self.nouns else None
        part = self.tokens[self.start : self.at]
        item = Item(Kind.NOUN, part[0].start, part[-1].stop, " ".join(token.text for token in part))
        item.words, item.noun, item.color, item.count = normal_words(self.words), noun, self.color, self.count
        item.plural = (self.plural or (self.count or 0) > 1) and self.count != 1
        item.pronoun = self.pronoun or noun is None
        item.determined, item.negative = self.determined, self.negative
        return item

    def _noun_name(self) -> str | None:
        """The noun in the singular; what its words say beside it goes to the words and the number."""
        spoken = [word for token in self.nouns for word in token.text.split()]
        last = self.nouns[-1]
        names = [*spoken[:-1], last.value[-1] if last.tag == "N" else singular(spoken[-1])]
        self.plural = self.plural or names[-1] != spoken[-1]
        noun = " ".join(names)
        if noun in SETS["all_things"] | SETS["some_things"]:
            self.plural = noun in SETS["all_things"]
            self.words += ["all"] if self.plural else []
            return None
        side = next((word for word in self.words if word in SETS["left_right"]), None)
        if side and SETS["side_nouns"].issuperset(names):  # "the left hand side"
            self.words.remove(side)
            return side
        return NORMAL.get(noun, noun)
