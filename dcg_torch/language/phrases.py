"""Tagged tokens -> verbs, prepositions, base noun phrases and the words between them, from left to right."""

from __future__ import annotations

from collections.abc import Sequence

from dcg_torch.english.forms import verb
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.lexicon import PARTICLE_VERBS, PLACING, PRONOUNS, SETS, VERBS
from dcg_torch.language.noun_phrases import NounPhrase
from dcg_torch.language.tagging import Reader, Token

_SIMPLE = {"REL": Kind.RELATIVE, "NEG": Kind.NEGATION, "AND": Kind.AND, "COMMA": Kind.COMMA, "STOP": Kind.STOP}
NOMINAL = frozenset({"DET", "Q", "NUM", "ORD", "MOD", "COL", "NM", "N", "SIDE", "ONE"})
_VERBAL = frozenset({"V", "VG", "BE", "HAVE"})


def items(tokens: Sequence[Token]) -> list[Item]:
    """The phrases of a command. Tokens without a part in any are left out."""
    reader = _Phrases(tokens)
    i = 0
    while i < len(tokens):
        i = reader.step(i)
    return reader.out


class _Phrases(Reader):
    def __init__(self, tokens: Sequence[Token]) -> None:
        super().__init__(tokens)
        self.out: list[Item] = []
        self.first = True  # no noun phrase stands before in the sentence

    def step(self, i: int) -> int:
        token = self.tokens[i]
        if token.tag in _SIMPLE:
            self.add(_SIMPLE[token.tag], i, i + 1)
        elif token.tag == "P":
            return self.preposition(i)
        elif token.tag in _VERBAL:
            return self.verb(i)
        elif token.tag in {"ADV", "FACE"}:
            self.adverb(i)
        elif token.tag == "PRO":
            self.pronoun(i)
        elif token.tag in NOMINAL:
            return self.nominal(i)
        return i + 1

    def add(self, kind: Kind, i: int, j: int, words: tuple[str, ...] = ()) -> Item:
        """Append the item of tokens `i` to `j`."""
        part = self.tokens[i:j]
        item = Item(kind, part[0].start, part[-1].stop, " ".join(token.text for token in part), words)
        self.out.append(item)
        self.first = kind is Kind.STOP or (self.first and kind is not Kind.NOUN)
        return item

    def previous(self) -> Kind | None:
        """The last item's kind."""
        return self.out[-1].kind if self.out else None

    def preposition(self, i: int) -> int:
        token = self.tokens[i]
        if token.text in SETS["filler_words"] and self.previous() in {Kind.PREPOSITION, Kind.VERB, None}:
            return i + 1  # "go to like the cone"
        normal = token.value[0]
        if token.text.startswith("from the") and normal in PLACING["beside"] and self.ordered():
            normal = "from"  # "the second from the left of the row"
            self.add(Kind.PREPOSITION, i, i + 1, (normal,))
            side = self.add(Kind.NOUN, i, i + 1)
            side.noun, side.determined = token.value[0].split()[0], True
            self.add(Kind.PREPOSITION, i, i + 1, ("of",))
            return i + 1
        if token.text.startswith("the ") and self.previous() in {Kind.PREPOSITION, None}:
            bare = self.add(Kind.NOUN, i, i + 1)  # "go to the closest to you"
            bare.pronoun = bare.determined = True
        self.add(Kind.PREPOSITION, i, i + 1, (normal,))
        return i + 1

    def ordered(self) -> bool:
        """Whether the last phrase counts along something: "the second cone (from ...)"."""
        return self.previous() is Kind.NOUN and self.out[-1].is_a("ordered")

    def verb(self, i: int) -> int:
        token = self.tokens[i]
        base = verb(token.text) if token.tag != "HAVE" else "have"
        item = self.add(Kind.VERB, i, i + 1, (base,))
        item.finite = token.tag in {"VG", "HAVE"} and token.text.endswith("s")
        item.participle = token.tag == "VG" and not item.finite
        after = self.text(i + 1)
        if base in PARTICLE_VERBS.get(after, ()):
            item.words, item.stop = (f"{base} {after}",), self.tokens[i + 1].stop
            item.text += f" {after}"
        elif after == "for" and base in VERBS["head"]:
            self.add(Kind.PREPOSITION, i + 1, i + 2, ("to",))
        else:
            return i + 1
        return i + 2

    def adverb(self, i: int) -> None:
        value = self.tokens[i].value
        if value[0] == "view" and self.previous() is Kind.NOUN:
            self.out[-1].words += value[1:]  # "(on the left) from my point of view" is on my left
            self.out[-1].stop = self.tokens[i].stop
        elif value[0] not in {"", "view"}:  # but "right" of "right behind"
            self.add(Kind.ADVERB, i, i + 1, value)

    def pronoun(self, i: int) -> None:
        item = self.add(Kind.NOUN, i, i + 1)
        item.noun = PRONOUNS.get(self.text(i))
        item.pronoun = item.noun is None
        if self.text(i) not in PRONOUNS:  # "(drop) what you are holding"
            item.determined = True
            self.add(Kind.RELATIVE, i, i + 1)

    def nominal(self, i: int) -> int:
        """A noun phrase; words that are none by themselves are adverbs: "(the cube that is) biggest"."""
        if self.text(i) in SETS["reciprocal_starts"] and self.text(i + 1) in SETS["reciprocal_ends"]:
            self.add(Kind.NOUN, i, i + 2, ("each other",)).pronoun = True
            return i + 2
        phrase = NounPhrase(self.tokens, i, self.first)
        if phrase.is_measure:
            return phrase.at
        if phrase.named:
            self.out.append(phrase.item())
            self.first = False
            return phrase.at
        self.add(Kind.ADVERB, i, i + 1, self.tokens[i].value or (self.text(i),))
        return i + 1
