"""What "that cube" and "those cubes" refer to: a landmark of a sentence before, with all that is said of it there.

"An orange cube is behind a green cube. Take that green cube": the green cube in front of an orange cube. And what a
sentence before only introduces: "look for a cube. Take the cube on the left".
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from dcg_torch.interpretation.converse_relations import converse_of
from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.relations import listed
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel

_DEMONSTRATIVES, _ARTICLES = listed("points back"), listed("introduces")
_TAKEN_FOR = frozenset({"near", "facing"})
"""What a parser takes such a sentence for: where the thing is, and who looks."""


def refer_back(trees: Sequence[ParseTree], said: Sequence[ParseTree]) -> list[ParseTree]:
    """Trees in which noun phrases that point back have the words of what they point to.

    Args:
        said: the trees of all readings of the command, in which sentences before are read as what is meant.
    """
    if not any(_points_back(node) for tree in trees for node in tree.walk()):
        return list(trees)
    return [_referring(tree, [other for other in said if other != tree]) for tree in trees]


def _points_back(tree: ParseTree) -> bool:
    phrase = tree.phrase
    said = phrase.kind is PhraseKind.NOUN and phrase.noun is not None and not tree.children
    return said and phrase.text.split(" ")[0] in _DEMONSTRATIVES


def _referring(tree: ParseTree, others: Sequence[ParseTree]) -> ParseTree:
    children = tuple(_referring(child, others) for child in tree.children)
    tree = tree if children == tree.children else replace(tree, children=children)
    if not _points_back(tree):
        return tree
    return next((found for other in others for found in _antecedents(tree.phrase, other)), tree)


def _antecedents(phrase: Phrase, tree: ParseTree) -> Iterator[ParseTree]:
    """What a phrase may point to in another tree: what that tree means, or a landmark of it.

    The landmark is told by the converse relation: the table under a lamp, of "a lamp is on a table".
    """
    meant = next((node for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN), tree)
    if _is_called(meant, phrase) and (meant.children or meant.phrase.words):
        yield replace(meant, phrase=replace(meant.phrase, text=phrase.text))
    for k, place in enumerate(meant.children):
        landmark = place.children[0] if len(place.children) == 1 else place
        name = converse_of(place.phrase.words[0]) if place.phrase.words else None
        if name is not None and _is_called(landmark, phrase):
            rest = replace(meant, children=(*meant.children[:k], *meant.children[k + 1 :]))
            beside = ParseTree(Phrase(PhraseKind.PREPOSITION, name, (name,)), (rest,))
            said = replace(landmark.phrase, text=phrase.text)
            yield ParseTree(said, (*landmark.children, beside))


def _is_called(tree: ParseTree, phrase: Phrase) -> bool:
    """Has a noun phrase the noun, colour and number of one that points back, without pointing back itself?"""
    own = tree.phrase
    alike = own.kind is PhraseKind.NOUN and (own.noun, own.color) == (phrase.noun, phrase.color)
    return alike and not _points_back(tree) and own.plural == phrase.plural


def by_introduction(tree: ParseTree, said: Words, _: WorldModel) -> ParseTree:
    """ "Look for a cube. Take the cube that ..." speaks of one cube: what is introduced is no landmark.

    Args:
        said: the words of the tree.
    """
    return tree if said.words.isdisjoint(_TAKEN_FOR) else _without_introduced(tree)


def _without_introduced(tree: ParseTree) -> ParseTree:
    phrase, children = tree.phrase, tuple(map(_without_introduced, tree.children))
    meant = phrase if phrase.kind is PhraseKind.NOUN else children[0].phrase if children else phrase
    children = tuple(c for c in children if not (_TAKEN_FOR.issuperset(c.phrase.words[:1]) and _introduces(c, meant)))
    return ParseTree(phrase, children)


def _introduces(place: ParseTree, phrase: Phrase) -> bool:
    """Does a place only introduce what a noun phrase means: "a cube", with the same noun and colour and no more?"""
    if len(place.phrase.words) != 1 or len(place.children) != 1:
        return False
    first = place.children[0].phrase
    bare = not (first.words or first.plural or place.children[0].children)
    said_before = place.phrase.text == first.text and first.text.split(" ")[0] in _ARTICLES
    return bare and said_before and (first.noun, first.color) == (phrase.noun, phrase.color)
