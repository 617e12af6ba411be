"""Tagged tokens -> verbs, prepositions, base noun phrases and the words between them, from left to right."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import Final

from dcg_torch.english.forms import verb
from dcg_torch.language.items import END, Item, Kind
from dcg_torch.language.lexicon import GRAMMAR, PARTICLE_VERBS, PLACING, PRONOUNS, SETS, TAGS
from dcg_torch.language.noun_phrases import NounPhrase
from dcg_torch.language.tagging import BEHIND, Token

_PARTS: Final[Mapping[str, str]] = GRAMMAR["phrases"]


def items(tokens: Sequence[Token]) -> list[Item]:
    """The phrases of a command. Tokens without a part in any are left out."""
    reader = _Phrases([*tokens, BEHIND, BEHIND, BEHIND])
    i = 0
    while i < len(tokens):
        i = reader.step(i)
    return reader.out


class _Phrases:
    def __init__(self, tokens: Sequence[Token]) -> None:
        self.tokens = tokens
        self.out: list[Item] = []

    def step(self, i: int) -> int:
        tag = self.tokens[i].tag
        if tag in TAGS["joints"]:
            self.add(Kind(tag), i, i + 1)
        return getattr(self, _PARTS[tag])(i) if tag in _PARTS else i + 1

    def add(self, kind: Kind, i: int, j: int, words: tuple[str, ...] = ()) -> Item:
        """Append the item of tokens `i` to `j`."""
        part = self.tokens[i:j]
        item = Item(kind, part[0].start, part[-1].stop, " ".join(token.text for token in part), words)
        self.out.append(item)
        return item

    @property
    def before(self) -> Item:
        """The last item."""
        return self.out[-1] if self.out else END

    def preposition(self, i: int) -> int:
        token = self.tokens[i]
        if token.text in SETS["filler_words"] and self.before.kind in {Kind.PREPOSITION, Kind.VERB, Kind.STOP}:
            return i + 1  # "go to like the cone"
        normal, end = token.value[0], token.text.split()[:3][-1]
        if token.text.startswith("from the ") and end in SETS["ends"] and self.before.is_a("counted"):
            self.add(Kind.PREPOSITION, i, i + 1, ("from",))  # "the second from the left of the row"
            side = self.add(Kind.NOUN, i, i + 1)
            side.noun, side.determined, normal = end, True, "of"
        elif token.text.startswith("the ") and self.before.kind in {Kind.PREPOSITION, Kind.STOP}:
            bare = self.add(Kind.NOUN, i, i + 1)  # "go to the closest to you"
            bare.pronoun = bare.determined = True
        self.add(Kind.PREPOSITION, i, i + 1, (normal,))
        return i + 1

    def verb(self, i: int) -> int:
        token = self.tokens[i]
        base = "have" if token.tag == "HAVE" else token.value[0] if " " in token.text else verb(token.text)
        when = (END, *self.out)[-2:] if self.before.is_a("someone") else [self.before]
        if len(when) > 1 and when[0].name in PLACING["times"]:
            del self.out[-2:]  # "before you go to the phone"
        item = self.add(Kind.VERB, i, i + 1, (base,))
        item.late = when[0].name in PLACING["late"]
        item.finite = token.tag in {"VG", "HAVE"} and token.text.endswith("s")
        item.participle = token.tag == "VG" and not item.finite
        after = self.tokens[i + 1].text
        if base in PARTICLE_VERBS.get(after, ()):
            item.words, item.stop = (f"{base} {after}",), self.tokens[i + 1].stop
            item.text += f" {after}"
            return i + 2
        return i + 1

    def adverb(self, i: int) -> int:
        value = self.tokens[i].value
        if value[0] == "view" and self.before.kind is Kind.NOUN:
            self.before.words += value[1:]  # "(on the left) from my point of view" is on my left
            self.before.stop = self.tokens[i].stop
        elif value[0] not in {"", "view"}:  # but "right" of "right behind"
            self.add(Kind.ADVERB, i, i + 1, value)
        return i + 1

    def pronoun(self, i: int) -> int:
        text, apart = self.tokens[i].text, self.before.kind is Kind.COMMA
        item = self.add(Kind.NOUN, i, i + 1, self.tokens[i].value if " " in text else ())  # "each other"
        item.noun = PRONOUNS.get(text)
        item.pronoun = item.noun is None
        if text in SETS["questions_as_things"]:  # "(drop) what you are holding"
            # But "the cube, whatever it is".
            item.determined, item.plural = True, text in SETS["all_things"] and not apart
            item.words = ("all",) * item.plural
            self.add(Kind.RELATIVE, i, i + 1)
        return i + 1

    def nominal(self, i: int) -> int:
        """A noun phrase; words that are none by themselves are adverbs: "(the cube that is) biggest"."""
        sentence = itertools.takewhile(lambda item: item.kind is not Kind.STOP, reversed(self.out))
        phrase = NounPhrase(self.tokens, i, all(item.kind is not Kind.NOUN for item in sentence))
        if phrase.named and not phrase.is_measure:
            self.out.append(phrase.item)
        elif not phrase.is_measure:
            self.add(Kind.ADVERB, i, i + 1, self.tokens[i].value)
            return i + 1
        return phrase.at
