"""The phrases that descriptions are made of, each as its words and as the tree that the language room makes of them."""

from __future__ import annotations

from collections.abc import Sequence

from dcg_torch.types import ParseTree, Phrase, PhraseKind

_NAMES = {"beside": "next to", "nearest to": "closest to", "to the left of": "left of", "to the right of": "right of"}
"""Other wordings, and the preposition that the language room makes of them."""
PLURALS = {"cube": "cubes", "sphere": "spheres", "cylinder": "cylinders", "thing": "things", "object": "objects"}


def wording(tree: ParseTree) -> str:
    """The phrases of a tree in words."""
    first, *rest = [wording(child) for child in tree.children] or [""]
    joined = " and ".join([first, *rest]) if tree.phrase.words == ("between",) else " ".join([first, *rest])
    return " ".join(filter(None, (tree.phrase.text, joined)))


def command(noun: ParseTree, verb: str = "go", preposition: str = "to") -> ParseTree:
    """An order to go, or do another deed, to what a noun phrase means: "go to the red cube"."""
    to = ParseTree(Phrase(PhraseKind.PREPOSITION, preposition, (preposition,)), (noun,))
    return ParseTree(Phrase(PhraseKind.VERB, verb, (verb,)), (to,))


def noun_phrase(
    kind: str | None, color: str | None, words: Sequence[str] = (), modifiers: tuple[ParseTree, ...] = ()
) -> ParseTree:
    """A noun phrase in the singular: "the second red cube from the left"; without a type it is a thing."""
    noun = kind or "thing"
    front = [word for word in words if not word.startswith("from ")]
    behind = [word for word in words if word.startswith("from ")]
    text = " ".join(filter(None, ("the", *front, color, noun, *behind)))
    normal = tuple({"nearest": "closest"}.get(word, word) for word in words)
    return ParseTree(Phrase(PhraseKind.NOUN, text, normal, noun, color), modifiers)


def plural(
    kind: str | None,
    color: str | None,
    words: tuple[str, ...],
    count: int | None = None,
    modifiers: tuple[ParseTree, ...] = (),
) -> ParseTree:
    """A noun phrase in the plural: "the two red cubes"."""
    noun = kind or "thing"
    number = {None: "", 2: "two", 3: "three"}[count]
    text = " ".join(filter(None, (*(words or ("the",)), number, color, PLURALS[noun])))
    return ParseTree(Phrase(PhraseKind.NOUN, text, words, noun, color, plural=True, count=count), modifiers)


def prepositional(word: str, *nouns: ParseTree) -> ParseTree:
    """A preposition with its noun phrases: "next to" one, or "between" two."""
    return ParseTree(Phrase(PhraseKind.PREPOSITION, word, (_NAMES.get(word, word),)), nouns)


def person(who: str) -> ParseTree:
    """How a speaker names himself or the robot: "me" or "you"."""
    return ParseTree(Phrase(PhraseKind.NOUN, who, noun=who))


def a_side(place: str) -> ParseTree:
    """A side as a noun phrase: "your left", "the right"."""
    whose, _, side = place.partition(" ")
    return ParseTree(Phrase(PhraseKind.NOUN, place, ("your",) if whose == "your" else (), side))
