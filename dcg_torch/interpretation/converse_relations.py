"""Converse relations: "the mug with a lamp behind it" is in front of a lamp; "the desk with no chair at it"."""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.names.vocabulary import LATERAL
from dcg_torch.types import NOT, ParseTree, Phrase, PhraseKind

_IT = ("it", "them")


def seen_from_it(place: ParseTree, *, whose: bool) -> str | None:
    """How a thing stands to what stands so to it: "the mug with a lamp behind it" is in front of the lamp."""
    below = place.children[0].phrase if len(place.children) == 1 and place.phrase.words else None
    if below is None:
        return None
    if (whose or below.text.startswith("its ")) and below.noun in LATERAL:
        return _SEEN_FROM_IT[f"{below.noun} of"]
    return _SEEN_FROM_IT.get(place.phrase.words[0]) if below.text in _IT else None


_SEEN_FROM_IT = {
    **{"on": "under", "on top of": "under", "above": "under", "under": "above"},
    **{"behind": "in front of", "in front of": "behind", "left of": "right of", "right of": "left of"},
    **{relation: relation for relation in ("next to", "beside", "near", "touching")},
    **dict.fromkeys(("around", "at"), "with"),
}


def converse_of(relation: str) -> str | None:
    """What B is to A where A is so to B: what is on a table is on it, and the table under that."""
    return _SEEN_FROM_IT.get(relation)


def lacking(tree: ParseTree) -> ParseTree:
    """ "The desk with no chair in front of it" has none: where the chair would be says no more."""
    lacks = any(c.phrase.words[:1] == ("with",) and NOT in c.phrase.words for c in tree.children)
    if tree.phrase.kind is not PhraseKind.NOUN or not lacks:
        return tree
    kept = tuple(c for c in tree.children if not (len(c.children) == 1 and _stands_for(c.children[0].phrase)))
    return replace(tree, children=kept)


def _stands_for(phrase: Phrase) -> bool:
    return phrase.noun is None and phrase.text in _IT
