"""Words -> one base noun phrase: its noun, colour, number and other words, without what stands below it."""

from __future__ import annotations

from dataclasses import dataclass, field

from dcg_torch.language import lexicon as lx
from dcg_torch.language.colors import match_color
from dcg_torch.language.items import Kind
from dcg_torch.language.repairs import DETERMINERS, Words

_DEMONSTRATIVES = frozenset({"that", "this", "those", "these"})


@dataclass(slots=True)
class _Draft:
    """A noun phrase while it is read; `at` is the next word, `nouns` the indices of its noun's words."""

    start: int
    at: int
    nouns: list[int] = field(default_factory=list)
    color: str | None = None
    modifiers: list[str] = field(default_factory=list)
    count: int | None = None
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


class NounPhrases(Words):
    """Reads noun phrases. Each part's method says whether it dealt with the word at hand."""

    def noun_phrase(self, i: int) -> int | None:
        """Add the noun phrase that begins at word `i` and return the index behind it; None if none begins there.

        A distance ("two squares to the left") is passed over without an item.
        """
        draft = _Draft(i, i)
        parts = (self._determiner, self._group, self._possessive, self._pick, self._one, self._number, self._color,
                 self._modifier, self._noun, self._joint)  # fmt: skip
        while draft.at < len(self.texts) and not draft.closed:
            if self._is_pronoun(draft.at):
                if draft.at == i or (draft.determined and not draft.nouns and not draft.color):
                    return self._pronoun(draft)
                break
            if self._is_measure(draft):
                return draft.at + 1
            if not any(part(draft) for part in parts):
                if self.texts[draft.at] in _DEMONSTRATIVES and draft.at == i:
                    return self._pronoun(draft)
                break
        if not (draft.nouns or draft.color or draft.pronoun or "one of" in draft.modifiers) and not (
            draft.determined and draft.modifiers
        ):
            # Anything that an article leads is a noun for want of better.
            if not (draft.determined and draft.at > i and self.is_noun(draft.at, loose=True)):
                return None
            draft.nouns.append(draft.at)
            draft.at += 1
        return self._finish(draft)

    def _is_pronoun(self, i: int) -> bool:
        text = self.texts[i]
        if text == "he" and self.in_phrase(i + 1):
            return False  # a slip of "the": nobody is called "he" in front of a noun
        return text in lx.PRONOUNS and text not in {"one", "ones"} | _DEMONSTRATIVES

    def _determiner(self, draft: _Draft) -> bool:
        i = draft.at
        text = self.texts[i]
        if text == "he" and i == draft.start and self.in_phrase(i + 1):
            text = "the"
        if text not in DETERMINERS or (text in _DEMONSTRATIVES and not self.in_phrase(i + 1)):
            return False
        if i > draft.start and self.texts[i - 1] not in lx.QUANTIFIERS | DETERMINERS | {"of", "single"}:
            return draft.close()
        if text in {"your", "my"}:
            draft.modifiers.append(text)
        draft.determined = True
        return draft.take(i + 1)

    def _group(self, draft: _Draft) -> bool:
        """ "the row of cubes" is cubes, "the position of the cube" the cube."""
        i = draft.at
        unit = self.text(i - 1)
        if self.texts[i] != "of" or not draft.nouns or draft.nouns[-1] != i - 1:
            return False
        if unit not in lx.GROUPS | lx.CARRIERS or not self.starts_phrase(i + 1):
            return False
        draft.nouns.pop()
        if unit in {"pair", "couple"}:
            draft.count = 2
        elif unit in lx.GROUPS:
            draft.modifiers.append(unit)
            draft.plural = True
        i += 1
        while self.text(i) in DETERMINERS:
            i += 1
        return draft.take(i)

    def _possessive(self, draft: _Draft) -> bool:
        """ "the robot's cube" is the cube."""
        if self.tag(draft.at) != "POS" or not draft.nouns or not self.in_phrase(draft.at + 1):
            return False
        draft.nouns, draft.color = [], None
        return draft.take(draft.at + 1)

    def _pick(self, draft: _Draft) -> bool:
        """ "one of the cubes", "all of the cubes", "the leftmost of the cubes"."""
        i = draft.at
        if self.texts[i] != "of" or i == draft.start or draft.nouns or not self.picks(i - 1):
            return False
        if self.texts[i - 1] == "one":
            draft.modifiers.append("one of")
        if self.texts[i - 1] == "one" or self.texts[i - 1] in lx.MODIFIERS:
            draft.count = 1
        return draft.take(i + 1)

    def _one(self, draft: _Draft) -> bool:
        """ "the red one"."""
        i = draft.at
        if self.texts[i] not in {"one", "ones"} or self.text(i + 1) == "of":
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

    def _is_measure(self, draft: _Draft) -> bool:
        i = draft.at
        if draft.count is None or draft.nouns or draft.determined:
            return False
        if self.reader.singular(self.texts[i]) not in lx.MEASURES:
            return False
        return self.text(i + 1) in lx.DIRECTIONS | lx.ADVERBS or not self.is_noun(i + 1)

    def _number(self, draft: _Draft) -> bool:
        i = draft.at
        text = self.texts[i]
        if text in lx.QUANTIFIERS and not draft.nouns:
            draft.plural = draft.plural or text in {"all", "both", "several"}
            draft.count = 2 if text == "both" else draft.count
            draft.modifiers.append(text)
            return draft.take(i + 1)
        if text not in lx.NUMBERS and not (self.tag(i) == "CD" and text.isascii() and text.isdigit()):
            return False
        if draft.nouns:
            return draft.close()
        draft.count = lx.NUMBERS.get(text) or (int(text) if len(text) < 4 else None)
        draft.take(i + 1)
        if text == "one" and self.text(i + 1) != "of" and not self.in_phrase(i + 1):
            draft.pronoun = True
            return draft.close()
        return True

    def _color(self, draft: _Draft) -> bool:
        found = match_color(self.texts, draft.at)
        if found is None or self.is_compound(draft.at):
            return False
        name, stop = found
        if draft.nouns and (draft.color or self.is_noun(stop) or self.text(stop) in {"one", "ones"}):
            return draft.close()  # "the cone red cube": another phrase begins
        if draft.color is None:
            draft.color = name
        else:
            draft.modifiers.append(name)  # "the red and blue tower": the first is its colour
        return draft.take(stop)

    def _modifier(self, draft: _Draft) -> bool:
        i = draft.at
        text = self.texts[i]
        known = text in lx.MODIFIERS
        place = text in lx.DIRECTIONS | lx.PLACES
        after_noun = bool(draft.nouns) and draft.nouns[-1] == i - 1
        if draft.nouns and known and self.texts[draft.nouns[-1]] not in lx.MODIFIERS and not self.is_compound(i):
            return draft.close()
        if not known and not self.is_adjective(i):
            return False
        last = self.ends_phrase(i + 1)
        rare = text not in lx.MODIFIERS - {"square"} and self.reader.is_noun(text)
        if last and rare and (after_noun or not draft.nouns):
            draft.nouns.append(i)  # the tagger takes rare nouns for adjectives: "the hydrant"
            return draft.take(i + 1)
        if after_noun and not self.is_noun(i + 1):
            return draft.close()
        if last and not place and not self.is_noun(i, strict=True):
            if draft.determined or draft.color or draft.modifiers:
                draft.modifiers.append(text)
                draft.take(i + 1)
            return draft.close()
        if last and (place or not known):
            draft.nouns.append(i)
        else:
            draft.modifiers.append(text)
        return draft.take(i + 1)

    def _noun(self, draft: _Draft) -> bool:
        i = draft.at
        if not self.is_noun(i):
            return False
        if draft.nouns and draft.nouns[-1] != i - 1:
            return draft.close()
        draft.nouns.append(i)
        return draft.take(i + 1)

    def _joint(self, draft: _Draft) -> bool:
        """The "and" and commas of "the red, white and blue tower"."""
        i = draft.at
        if self.texts[i] not in {"and", ",", "&"} or draft.nouns or not (draft.color or draft.modifiers):
            return False
        if self.text(i + 1) == "and":
            i += 1
        follows = match_color(self.texts, i + 1) is not None or self.text(i + 1) in lx.MODIFIERS
        if not follows or self.ends_phrase(i):
            return False
        return draft.take(i + 1)

    def _finish(self, draft: _Draft) -> int:
        nouns, color, modifiers, plural = draft.nouns, draft.color, draft.modifiers, draft.plural
        if not nouns and color in self.known and self.texts[draft.at - 1] == color:
            nouns, color = [draft.at - 1], None  # "the orange" is a colour unless oranges are known
        head = nouns[-1] if nouns else draft.at - 1
        noun: str | None = None
        if nouns:
            parts = [self.texts[n] for n in nouns]
            plural = plural or self.reader.is_plural(parts[-1], self.words[head].tag)
            parts[-1] = self.reader.singular(parts[-1])
            while len(parts) > 1 and parts[0] in lx.SIDES | {"hand"}:
                modifiers.append(parts.pop(0))
            noun = " ".join(parts)
            noun = lx.NORMAL_WORDS.get(noun, noun)
            side = next((word for word in modifiers if word in {"left", "right"}), None)
            if noun == "side" and side:
                noun = side
                modifiers = [word for word in modifiers if word not in {side, "hand"}]
        item = self.add(
            Kind.NOUN,
            draft.start,
            draft.at,
            noun=noun,
            color=color,
            words=tuple(dict.fromkeys(lx.NORMAL_WORDS.get(word, word) for word in modifiers)),
            plural=(plural or (draft.count or 0) > 1) and draft.count != 1,
            count=draft.count,
            pronoun=draft.pronoun or noun is None,
            determined=draft.determined,
        )
        item.head = head
        return draft.at

    def _pronoun(self, draft: _Draft) -> int:
        noun = lx.PRONOUNS[self.texts[draft.at]]
        self.add(Kind.NOUN, draft.start, draft.at + 1, noun=noun, pronoun=noun is None)
        return draft.at + 1
