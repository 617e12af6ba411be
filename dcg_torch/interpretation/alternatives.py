"""One of two, whichever is more so: "the red or the blue box, whichever is bigger", "... closer to the door"."""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.interpretation.comparatives import COMPARING
from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.palette import region
from dcg_torch.names.vocabulary import OR, THAN
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel

_WHICHEVER = "whichever"
_COMPARED = frozenset({"closer to", "farther from"})


def by_alternatives(tree: ParseTree, said: Words, _: WorldModel) -> ParseTree:
    """A tree in which each of the two is compared with the other: "the red box bigger than the blue box, or ...".

    Args:
        said: the words of the tree.
    """
    nouns = [child for child in tree.children if child.phrase.kind is PhraseKind.NOUN]
    if _WHICHEVER not in said.words or len(nouns) != 2 or OR not in nouns[1].phrase.words:
        return tree
    one, other = nouns
    if one.phrase.color is None and one.phrase.noun is not None and region(one.phrase.noun) is not None:
        one = replace(
            one, phrase=replace(one.phrase, noun=other.phrase.noun, color=one.phrase.noun)
        )  # "the red or ..."
    words = [word for word in other.phrase.words if word in COMPARING]
    places = [c for c in other.children if c.phrase.words[:1] and c.phrase.words[0] in _COMPARED]
    if len(words) + len(places) != 1:
        return tree
    bare = replace(other.phrase, words=tuple(w for w in other.phrase.words if w not in (_WHICHEVER, OR, *words)))
    second = ParseTree(bare, tuple(c for c in other.children if c not in places))
    compared = _than(one, second, words, places), _than(second, one, words, places)
    either = replace(compared[1].phrase, words=(*compared[1].phrase.words, OR))
    told = {id(nouns[0]): compared[0], id(other): replace(compared[1], phrase=either)}
    return replace(tree, children=tuple(told.get(id(child), child) for child in tree.children))


def _than(one: ParseTree, other: ParseTree, words: list[str], places: list[ParseTree]) -> ParseTree:
    """One of the two, that is more so than the other."""
    than = ParseTree(Phrase(PhraseKind.PREPOSITION, THAN, (THAN,)), (other,))
    phrase = replace(one.phrase, words=(*one.phrase.words, *words))
    return ParseTree(phrase, (*one.children, *places, than))
