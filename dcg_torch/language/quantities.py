"""How many of which: articles, groups, numbers and picks at the head of a noun phrase."""

from __future__ import annotations

from dataclasses import dataclass, field

from dcg_torch.language import lexicon as lx
from dcg_torch.language.repairs import DETERMINERS, Words

_GROUP_PRONOUNS = frozenset({"them", "these", "those"})
DEMONSTRATIVES = frozenset({"that", "this", "those", "these"})


@dataclass(slots=True)
class Draft:
    """A noun phrase while it is read; `at` is the next word, `nouns` the indices of its noun's words."""

    start: int
    at: int
    nouns: list[int] = field(default_factory=list)
    color: str | None = None
    modifiers: list[str] = field(default_factory=list)
    count: int | None = None
    of: int | None = None  # how many a group has: "the row of five cubes"
    grouped: bool = False
    picked: bool = False  # "the bigger of the ...": what follows tells what it is picked from
    negative: bool = False  # "no cube"
    plural: bool = False
    determined: bool = False
    pronoun: bool = False
    closed: bool = False

    def take(self, stop: int) -> bool:
        """Go on at word `stop`."""
        self.at = stop
        return True

    def close(self) -> bool:
        """The phrase ends before the word at hand."""
        self.closed = True
        return True


class Quantities(Words):
    """Reads what says how many of which. Each part's method says whether it dealt with the word at hand."""

    def _determiner(self, draft: Draft) -> bool:
        i = draft.at
        text = self.texts[i]
        if text == "he" and i == draft.start and self.in_phrase(i + 1):
            text = "the"
        if text == "no" and i == draft.start and self.in_phrase(i + 1):
            draft.negative = True
        elif text not in DETERMINERS or (text in DEMONSTRATIVES and not self.in_phrase(i + 1)):
            return False
        if i > draft.start and self.texts[i - 1] not in lx.QUANTIFIERS | DETERMINERS | {"of", "single"}:
            return draft.close()
        if text in {"your", "my"}:
            draft.modifiers.append(text)
        draft.determined = True
        return draft.take(i + 1)

    def _group(self, draft: Draft) -> bool:
        """ "the row of five cubes" is cubes with the words "row" and "of 5", "the position of the cube" the cube."""
        i = draft.at
        unit = self.text(i - 1)
        if self.texts[i] != "of" or not draft.nouns or draft.nouns[-1] != i - 1:
            return False
        unit = unit if unit in lx.GROUPS | lx.CARRIERS else self.reader.singular(unit)
        if unit not in lx.GROUPS | lx.CARRIERS or not self.starts_phrase(i + 1):
            return False
        draft.nouns.pop()
        if unit in {"pair", "couple"}:
            draft.count = 2
        elif unit in lx.GROUPS:
            draft.modifiers.append(unit)
            draft.plural = draft.grouped = True
            if not draft.picked:
                draft.count = None  # "two rows of cubes" are not two cubes
        i += 1
        while self.text(i) in DETERMINERS:
            i += 1
        return draft.take(i)

    def _possessive(self, draft: Draft) -> bool:
        """ "the robot's cube" is the cube."""
        side = self.text(draft.at + 1) in lx.SIDES
        if self.tag(draft.at) != "POS" or not draft.nouns or not (side or self.in_phrase(draft.at + 1)):
            return False
        if side and self.texts[draft.nouns[-1]] in lx.ROBOT:
            draft.modifiers.append("your")  # "the robot's left"
        draft.nouns, draft.color = [], None
        return draft.take(draft.at + 1)

    def _pick(self, draft: Draft) -> bool:
        """ "one of the cubes", "all of the cubes", "the leftmost of the cubes"."""
        i = draft.at
        if self.texts[i] != "of" or i == draft.start or draft.nouns or not self.picks(i - 1):
            return False
        if self.texts[i - 1] == "one" and not (draft.determined or draft.modifiers):
            draft.modifiers.append("one of")
        if self.texts[i - 1] in {"one", "either"} or self.texts[i - 1] in lx.MODIFIERS:
            draft.count = 1
        draft.picked = True
        if self.text(i + 1) in _GROUP_PRONOUNS and not self.in_phrase(i + 2):
            draft.pronoun = draft.take(i + 2)  # "all of them"
            draft.plural = draft.plural or draft.count != 1
            return draft.close()
        return draft.take(i + 1)

    def _one(self, draft: Draft) -> bool:
        """ "the red one"."""
        i = draft.at
        if self.texts[i] not in {"one", "ones"} or (self.text(i + 1) == "of" and self.picks(i)):
            return False
        if not (draft.determined or draft.color or draft.modifiers):
            return False
        if draft.nouns:
            return draft.close()  # "the cube one space to the left"
        if self.in_phrase(i + 1) and self.text(i + 1) not in lx.MODIFIERS:
            draft.count = 1  # "the one red cube"
            return draft.take(i + 1)
        draft.pronoun = True
        draft.plural = draft.plural or self.texts[i] == "ones"
        draft.take(i + 1)
        return draft.close()

    def _is_measure(self, draft: Draft) -> bool:
        i = draft.at
        if draft.count is None or draft.nouns or draft.determined:
            return False
        if self.reader.singular(self.texts[i]) not in lx.MEASURES:
            return False
        return self.text(i + 1) in lx.DIRECTIONS | lx.ADVERBS or not self.is_noun(i + 1)

    def _number(self, draft: Draft) -> bool:
        i = draft.at
        text = self.texts[i]
        if text in lx.QUANTIFIERS and not draft.nouns:
            draft.plural = draft.plural or (not draft.picked and text in {"all", "both", "several", "each", "every"})
            draft.count = 2 if text == "both" else draft.count
            if not draft.picked:  # "the biggest of all the cubes"
                draft.modifiers.append(text)
            return draft.take(i + 1)
        if text not in lx.NUMBERS and not (self.tag(i) == "CD" and text.isascii() and text.isdigit()):
            return False
        if draft.nouns:
            return draft.close()
        count = lx.NUMBERS.get(text) or (int(text) if len(text) < 4 else None)
        if draft.grouped:
            draft.of = count
            return draft.take(i + 1)
        draft.count = draft.count if draft.picked else count
        draft.take(i + 1)
        if text == "one" and not self.picks(i) and not self.in_phrase(i + 1):
            if self.text(i + 1) == "of":
                draft.modifiers.append("one of")  # "one of the group"
            draft.pronoun = True
            return draft.close()
        return True
