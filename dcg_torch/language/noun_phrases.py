"""Words -> one base noun phrase: its noun, colour, number and other words, without what stands below it."""

from __future__ import annotations

from dcg_torch.language import lexicon as lx
from dcg_torch.language.colors import FILLERS, PLURALS, match_color
from dcg_torch.language.items import Kind
from dcg_torch.language.quantities import DEMONSTRATIVES, Draft, Quantities


class NounPhrases(Quantities):
    """Reads noun phrases. Each part's method says whether it dealt with the word at hand."""

    def noun_phrase(self, i: int) -> int | None:
        """Add the noun phrase that begins at word `i` and return the index behind it; None if none begins there.

        A distance ("two squares to the left") is passed over without an item.
        """
        if (self.text(i), self.text(i + 1)) in {("each", "other"), ("one", "another")}:
            self.add(Kind.NOUN, i, i + 2, words=("each other",), pronoun=True)
            return i + 2
        draft = Draft(i, i)
        parts = (self._determiner, self._group, self._possessive, self._pick, self._one, self._number, self._denial,
                 self._facing, self._color, self._modifier, self._noun, self._joint)  # fmt: skip
        while draft.at < len(self.texts) and not draft.closed:
            if draft.nouns and self.leads_on(draft.at):
                break
            if self._is_pronoun(draft.at):
                if draft.at == i or (draft.determined and not draft.nouns and not draft.color):
                    return self._pronoun(draft)
                break
            if self._is_measure(draft):
                return draft.at + 1
            if not any(part(draft) for part in parts):
                if self.texts[draft.at] in DEMONSTRATIVES and draft.at == i:
                    return self._pronoun(draft)
                break
        named = draft.nouns or draft.color or draft.pronoun or "one of" in draft.modifiers
        picked = draft.determined and (draft.modifiers or draft.count is not None)  # "the biggest", "those two"
        picked = picked or (draft.modifiers and draft.modifiers[-1] in lx.ORDINALS and self.text(draft.at) == "from")
        if not named and not picked:
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
        return text in lx.PRONOUNS and text not in {"one", "ones"} | DEMONSTRATIVES

    def _denial(self, draft: Draft) -> bool:
        """ "the not blue cube", "a non red one"."""
        i = draft.at
        if self.texts[i] not in {"not", "non"} or not draft.determined or draft.nouns:
            return False
        found = match_color(self.texts, i + 1)
        if found is None and not (self.text(i + 1) in lx.MODIFIERS or self.tag(i + 1) == "JJ"):
            return False
        name, stop = found or (self.texts[i + 1], i + 2)
        draft.modifiers.append(f"not {name}")
        return draft.take(stop)

    def _facing(self, draft: Draft) -> bool:
        """ "the left facing chair"."""
        i = draft.at
        if self.texts[i] not in lx.WAYS or self.text(i + 1) != "facing" or draft.nouns or not self.in_phrase(i + 2):
            return False
        draft.modifiers.append(f"facing {lx.NORMAL_WORDS.get(self.texts[i], self.texts[i])}")
        return draft.take(i + 2)

    def _color(self, draft: Draft) -> bool:
        text = self.texts[draft.at]
        if text in FILLERS and draft.modifiers and not draft.nouns and self.in_phrase(draft.at + 1):
            return draft.take(draft.at + 1)  # "the dark coloured ball"
        several = text in PLURALS and draft.determined and text not in self.known  # "the reds"
        if several and not draft.nouns and draft.color is None and self.ends_phrase(draft.at + 1):
            draft.color, draft.plural, draft.pronoun = PLURALS[text], True, True
            draft.take(draft.at + 1)
            return draft.close()
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

    def _modifier(self, draft: Draft) -> bool:
        i = draft.at
        text = self.texts[i]
        known = text in lx.MODIFIERS
        place = text in lx.DIRECTIONS | lx.PLACES
        after_noun = bool(draft.nouns) and draft.nouns[-1] == i - 1
        if draft.nouns and known and self.texts[draft.nouns[-1]] not in lx.MODIFIERS and not self.is_compound(i):
            return draft.close()
        if not known and not self.is_adjective(i):
            return False
        if after_noun and (self.tag(i) in {"VBN", "VBG"} or text in {"touching", "facing"}):
            return draft.close()  # "the ball touching ..."
        last = self.ends_phrase(i + 1) and not (self.text(i + 1) == "of" and self.picks(i))
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

    def _noun(self, draft: Draft) -> bool:
        i = draft.at
        if not self.is_noun(i):
            return False
        if draft.nouns and draft.nouns[-1] != i - 1:
            return draft.close()
        draft.nouns.append(i)
        return draft.take(i + 1)

    def _joint(self, draft: Draft) -> bool:
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

    def _finish(self, draft: Draft) -> int:
        nouns, color = draft.nouns, draft.color
        if draft.of is not None:
            draft.modifiers.append(f"of {draft.of}")
        if not nouns and color in self.known and self.texts[draft.at - 1] == color:
            nouns, color = [draft.at - 1], None  # "the orange" is a colour unless oranges are known
        head = nouns[-1] if nouns else draft.at - 1
        noun = self._name(draft, nouns, head) if nouns else None
        if "both" in draft.modifiers and nouns and noun == self.texts[head] and self.text(draft.at) == "and":
            draft.modifiers.remove("both")  # "both the cube and the cone"
            draft.count, draft.plural = None, False
        item = self.add(
            Kind.NOUN,
            draft.start,
            draft.at,
            noun=noun,
            color=color,
            words=tuple(dict.fromkeys(lx.NORMAL_WORDS.get(word, word) for word in draft.modifiers)),
            plural=(draft.plural or (draft.count or 0) > 1) and draft.count != 1,
            count=draft.count,
            pronoun=draft.pronoun or noun is None,
            determined=draft.determined,
            negative=draft.negative,
        )
        item.head = head
        return draft.at

    def _name(self, draft: Draft, nouns: list[int], head: int) -> str | None:
        """The noun in the singular; what its words say beside it goes to the draft's modifiers and number."""
        parts = [self.texts[n] for n in nouns]
        draft.plural = draft.plural or self.reader.is_plural(parts[-1], self.words[head].tag)
        parts[-1] = self.reader.singular(parts[-1])
        while len(parts) > 1 and " ".join(parts) not in self.known and self._describes(parts[0]):
            draft.modifiers.append(parts.pop(0))
        noun = " ".join(parts)
        if noun in {"everything", "something"}:
            draft.modifiers += ["all"] if noun == "everything" else []
            draft.plural = noun == "everything"
            return None
        side = next((word for word in draft.modifiers if word in {"left", "right"}), None)
        if noun == "side" and side:  # "the left hand side"
            draft.modifiers = [word for word in draft.modifiers if word not in {side, "hand"}]
            return side
        return lx.NORMAL_WORDS.get(noun, noun)

    def _describes(self, part: str) -> bool:
        """Whether the first part of a noun is rather an adjective: "matte sphere", "metal cylinder"."""
        return part in lx.SIDES | {"hand"} or self.reader.is_adjective(part)

    def _pronoun(self, draft: Draft) -> int:
        noun = lx.PRONOUNS[self.texts[draft.at]]
        self.add(Kind.NOUN, draft.start, draft.at + 1, noun=noun, pronoun=noun is None)
        return draft.at + 1
