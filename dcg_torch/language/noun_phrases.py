"""Tagged tokens -> one base noun phrase: noun, colour, number and other words, without what stands below it."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Final

from dcg_torch.english.forms import parts, singular
from dcg_torch.language.items import Item, Kind, normal_words
from dcg_torch.language.lexicon import GRAMMAR, NORMAL, NUMBERS, SETS, TAGS
from dcg_torch.language.tagging import Token

_LONGEST_NUMBER = 3
_ROLES: Final = {tag: f"_{role}" for tag, role in GRAMMAR["noun_phrase"].items()}


class NounPhrase:
    """Reads the noun phrase that begins at a token; `at` is the token behind it.

    `alone`: no noun phrase stands before it in its sentence, so that "biggest" by itself is one. A method for each role
    that a token plays says how many tokens it takes: 0 where the noun phrase ends.
    """

    def __init__(self, tokens: Sequence[Token], start: int, alone: bool) -> None:
        self.tokens = tokens
        self.start, self.at, self.alone = start, start, alone
        self.item = Item(Kind.NOUN, tokens[start].start, 0, "")
        self.nouns: list[Token] = []
        self.of: int | None = None  # how many a group has: "the row of five cubes"
        self.picked = False  # "the bigger of the ...": what follows tells what it is picked from
        self.closed = self.is_measure = self.is_group = False
        while self.at < len(tokens) and not self.closed:
            tag = tokens[self.at].tag
            late = self.headed if tag in TAGS["before_heads"] else self.nouns and tag in TAGS["starts"]
            taken = 0 if late or tag not in _ROLES else getattr(self, _ROLES[tag])(tokens[self.at])
            if not taken:
                break
            self.at += taken
        self._settle()

    @property
    def headed(self) -> bool:
        """Whether the noun has its last word."""
        return bool(self.nouns) and self.nouns[-1].tag in TAGS["heads"]

    def _determiner(self, token: Token) -> int:
        if self.at > self.start and self.tokens[self.at - 1].tag not in {"Q", "DET", "P"}:
            return 0
        self.item.negative = self.item.negative or token.value[0] in SETS["none"]
        self.item.words += token.value if token.value[0] in SETS["owned"] else ()
        self.item.determined = True
        return 1

    def _quantifier(self, token: Token) -> int:
        self.item.count = {"both": 2, "one of": 1}.get(token.value[0], self.item.count)
        if not self.picked:  # "the biggest of all the cubes"
            self.item.words += token.value
            self.item.plural = self.item.plural or token.value[0] in SETS["of_many"]
        self.picked = self.picked or token.value == ("one of",)
        return 1

    def _number(self, token: Token) -> int:
        short = token.text.isdecimal() and len(token.text) <= _LONGEST_NUMBER
        number = NUMBERS.get(token.text) or (int(token.text) if short else None)
        if self.is_group or (self.picked and self.item.count == 1 and (number or 0) > 1):
            self.of = number  # "the left one of the two cubes"
            return 1
        if not self.item.determined and singular(self.tokens[self.at + 1].text) in SETS["measures"]:
            behind = self.tokens[self.at + 2].tag
            if behind not in TAGS["starts"] - {"DET", "SIDE"} or self.tokens[self.at + 2].text in SETS["directions"]:
                self.is_measure = self.closed = True
                return 2
        self.item.count = self.item.count if self.picked else number
        if token.text == "one" and self.tokens[self.at + 1].tag not in TAGS["starts"]:
            self.item.pronoun = self.closed = True
        return 1

    def _description(self, token: Token) -> int:
        if self.item.words or token.text not in SETS["color_fillers"]:
            self.item.words += token.value
        return 1

    def _color(self, token: Token) -> int:
        after = self.tokens[self.at + 1].text
        if self.tokens[self.at + 1].tag == "MOD" and self.tokens[self.at + 1].value[0].endswith("ed"):
            self.item.words += (f"{token.value[0]} {after}",)  # "white-haired": it is no colour of the whole
            return 2
        if self.item.color is not None:  # "the red and blue tower": the first is its colour
            self.item.words += ("or " * (self.tokens[self.at - 1].text == "or") + token.value[0],)
        self.item.color = self.item.color or token.value[0]
        return 1 + (after in SETS["color_fillers"])

    def _noun(self, token: Token) -> int:
        described = self.item.words or self.item.color  # "the dark coloured ball"
        if not (described and token.text in SETS["color_fillers"] and self.tokens[self.at + 1].tag in TAGS["starts"]):
            self.nouns.append(token)
        return 1

    def _one(self, token: Token) -> int:
        """ "The red one"; "the one red cube"."""
        one = token.text == "one"
        if one and self.item.determined and self.tokens[self.at + 1].tag in {"COL", "N", "NM"}:
            self.item.count = 1
        else:
            self.item.pronoun = True
            self.closed = not self.item.words or self.tokens[self.at + 1].text != "of"  # "the middle one of the cubes"
            self.item.plural = self.item.plural or not one
        return 1

    def _name(self, token: Token) -> int:
        """ "Cube 3": a number that is part of a name."""
        if not self.headed or singular(self.tokens[self.at + 1].text) in SETS["measures"]:
            return 0
        self.item.words += token.value
        return 1

    def _denial(self, token: Token) -> int:
        """ "The not blue cube", "a non red one"."""
        after = self.tokens[self.at + 1].tag
        if not (self.item.determined or self.item.words) or self.nouns or after not in TAGS["describing"]:
            return 0
        self.item.words += (f"not {self.tokens[self.at + 1].value[0]}",)
        return 2

    def _joint(self, token: Token) -> int:
        """The "and" and commas of "the red, white and blue tower"."""
        if self.nouns or not (self.item.color or self.item.words) or self.picked:
            return 0
        at = self.at + 1 + (self.tokens[self.at + 1].text == "and")
        follows = self.tokens[at + 1].tag in {"N", "NM", "AND", "ONE", "COMMA", *TAGS["describing"]}
        return at - self.at if self.tokens[at].tag in TAGS["describing"] and follows else 0

    def _possessive(self, token: Token) -> int:
        """ "The robot's cube" is the cube."""
        if not self.nouns or self.tokens[self.at + 1].tag not in TAGS["starts"]:
            return 0
        self.nouns, self.item.color = [], None
        return 1

    def _of(self, token: Token) -> int:
        """What "of" makes of a group ("the row of cubes"), a place ("the position of the cube"), a pick."""
        return (self._group_of() or self._pick_of()) if token.text == "of" else 0

    def _group_of(self) -> int:
        if not self.headed or self.tokens[self.at + 1].tag not in TAGS["starts"]:
            return 0
        unit = singular(self.nouns[-1].text)
        crossing = any(token.text in SETS["lines"] for token in self.tokens[self.at + 2 : self.at + 4])
        if unit not in SETS["groups"] | SETS["carriers"] or (crossing and unit in SETS["lines"]):
            return 0  # "the second column of the third row" is no group of rows
        self.item.words += tuple(t.text for t in self.nouns[:-1])
        self.nouns = []
        if unit in SETS["pairs"]:
            self.item.words += (unit,) if unit in SETS["close_pairs"] else ()
            self.of, self.item.count = (2, 1) if self.picked and self.item.count == 1 else (self.of, 2)
        elif unit in SETS["groups"]:
            self.item.words += (unit,)
            self.is_group = True
            self.item.plural = True
            self.item.count = self.item.count if self.picked else None  # "two rows of cubes" are not two cubes
        return self._behind_determiners() - self.at

    def _behind_determiners(self) -> int:
        """The token behind this one and the determiners that follow it."""
        return next(k for k in itertools.count(self.at + 1) if self.tokens[k].tag != "DET")

    def _pick_of(self) -> int:
        """ "One of the cubes", "all of the cubes", "the leftmost of the cubes"."""
        picker, first, after = self.tokens[self.at - 1], self.tokens[self.at + 1], self._behind_determiners()
        # "The middle of the three cones", but "the middle of the table".
        counted = self.tokens[after].tag == "NUM" and picker.text in SETS["counted_middles"]
        bare = not self.nouns and picker.tag in {"Q", "NUM", "ORD", "MOD", "ONE"}
        if not (picker.tag == "SIDE" and counted if self.headed else bare):
            return 0
        pair = self.tokens[after].text in SETS["pairs"] and self.tokens[after + 1].text == "of"
        bare_group = self.tokens[after].text in SETS["groups"] and not pair
        several = first.tag in TAGS["starts"] or first.text in SETS["group_pronouns"]
        if bare_group or not several:
            self.closed = True  # "the last of the row": the row is no such thing
            return 0
        if self.nouns:
            self.item.words += (self.nouns.pop().text,)
        if picker.text in {"one", "either"} or picker.tag in {"ORD", "MOD", "SIDE"}:
            self.item.count = 1
        self.picked, self.item.pronoun = True, False
        return 1

    def _them(self, token: Token) -> int:
        """ "All of them"."""
        if not self.picked or token.text not in SETS["group_pronouns"]:
            return 0
        self.item.pronoun = self.closed = True
        self.item.plural = self.item.count != 1
        return 1

    def _settle(self) -> None:
        """Whether the words are a noun phrase, once they have been read, and how it is written down."""
        item, part = self.item, self.tokens[self.start : self.at]
        if not self.nouns and not item.color and item.words and part[-1].tag == "MOD":
            self._noun_after_all()
        ordered = bool(item.words) and item.words[-1] in SETS["ordinals"] and self.tokens[self.at].text == "from"
        picked = (item.determined and item.count is not None) or (item.words and (item.determined or self.alone))
        # "The biggest", "those two", "second (from the left)".
        self.named = bool(self.nouns or item.color or item.pronoun or picked or ordered or "one of" in item.words)
        item.words += () if self.of is None else (f"of {self.of}",)
        item.noun = self._noun_name() if self.nouns else None
        item.pronoun = item.pronoun or item.noun is None
        item.plural = (item.plural or (item.count or 0) > 1) and item.count != 1
        item.words = normal_words(item.words)
        item.stop, item.text = part[-1].stop, " ".join(token.text for token in part)

    def _noun_after_all(self) -> None:
        """ "(A sheet of) metal": an adjective that is a noun as well is one where no other is."""
        last = self.tokens[self.at - 1]
        kinds = parts(last.text)
        rather = kinds.get("n", 0) > kinds.get("a", 0) + kinds.get("r", 0)  # a noun than an adjective
        if last.text in SETS["sides"] or (rather if last.text in SETS["modifiers"] else "n" in kinds):
            self.item.words = self.item.words[:-1]
            self.nouns = [last]

    def _noun_name(self) -> str | None:
        """The noun in the singular; what its words say beside it goes to the words and the number."""
        spoken = [word for token in self.nouns for word in token.text.split()]
        last = self.nouns[-1]
        names = [*spoken[:-1], last.value[-1] if last.tag == "N" else singular(spoken[-1])]
        self.item.plural = self.item.plural or names[-1] != spoken[-1]
        noun = " ".join(names)
        if noun in SETS["all_things"] | SETS["some_things"]:
            self.item.plural = noun in SETS["all_things"]
            self.item.words += ("all",) if self.item.plural else ()
            return None
        side = next((word for word in self.item.words if word in SETS["left_right"]), None)
        if side and SETS["side_nouns"].issuperset(names):  # "the left hand side"
            self.item.words = tuple(word for word in self.item.words if word != side)
            return side
        return NORMAL.get(noun, noun)
