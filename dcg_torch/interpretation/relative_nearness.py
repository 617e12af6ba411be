"""What is nearer to one thing than to another: "closer to the door than to the window", "than the red one is"."""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.names.vocabulary import NEARER_OF_TWO, NEARER_THAN, THAN
from dcg_torch.types import NOT, ParseTree, Phrase, PhraseKind

_NEARER = {"closer to": ("to", THAN), "farther from": ("from", THAN)}
"""What compares two distances -> the prepositions before the other landmark."""
_FARTHER = "farther from"


def nearer_of_two(tree: ParseTree) -> ParseTree:
    """A noun phrase in which such a comparison is one modifier of both landmarks, the nearer one first.

    "Closer to the door than the red one" compares with another of what is meant: that is the second landmark then.
    """
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN:
        return tree
    for k, place in enumerate(tree.children):
        name = place.phrase.words[0].removeprefix(f"{NOT} ") if place.phrase.words else ""
        if name not in _NEARER or len(place.children) != 1:
            continue
        landmark, after = place.children[0], tree.children[k + 1 : k + 2]
        told = next((c for c in (*landmark.children, *after) if c.phrase.words[:1] and len(c.children) == 1), None)
        if told is None or told.phrase.words[0] not in _NEARER[name]:
            continue
        first = replace(landmark, children=tuple(c for c in landmark.children if c is not told))
        kept = (c for c in tree.children if c is not told)
        return replace(tree, children=tuple(_both(c, first, told, phrase) if c is place else c for c in kept))
    return tree


def _both(place: ParseTree, first: ParseTree, told: ParseTree, head: Phrase) -> ParseTree:
    """The modifier of two landmarks that is in the place of one."""
    other, denied = told.children[0], place.phrase.words[0].startswith(f"{NOT} ")
    farther = place.phrase.words[0].removeprefix(f"{NOT} ") == _FARTHER
    one = other.phrase.noun in (None, head.noun) and told.phrase.words[0] == THAN
    if one and other.phrase.noun is None and other.phrase.text == "it":  # "than it is to the window"
        (further,) = other.children[:1] or (told,)
        other, one = further.children[0], False
    if one:
        name, marks = NEARER_THAN, (first, replace(other, phrase=replace(other.phrase, noun=head.noun)))
        denied = denied is not farther
    else:
        name, marks = NEARER_OF_TWO, (other, first) if farther else (first, other)
    words = (f"{NOT} {name}" if denied else name, *place.phrase.words[1:])
    return ParseTree(replace(place.phrase, words=words), marks)
