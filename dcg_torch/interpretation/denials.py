"""Denials of all that could be there: "not touching anything", "next to no chair", "touching nothing"."""

from __future__ import annotations

import functools
from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import NO_OTHER, NOTHING
from dcg_torch.types import NOT, ParseTree, Phrase, PhraseKind, WorldModel

_NOTHING, _ANYTHING, _THING, _OTHER, _NO = "nothing", "anything", "thing", "other", "no "


def by_denials(tree: ParseTree, said: Words, _: WorldModel) -> ParseTree:
    """A tree in which such a denial is a word of the noun phrase ("nothing touching"), or of the preposition.

    Args:
        said: the words of the tree.
    """
    return _by_nothing(tree) if _may_deny(tree) else tree


@functools.lru_cache(maxsize=1024)
def _may_deny(tree: ParseTree) -> bool:
    """Is anything said without which no denial is found?"""
    texts = [node.phrase.text for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN]
    return any(text.startswith((_NO, _NOTHING, _ANYTHING)) or f" {_OTHER} " in text for text in texts)


def _by_nothing(tree: ParseTree) -> ParseTree:
    children = tuple(map(_by_nothing, tree.children))
    phrase = tree.phrase
    if phrase.kind is PhraseKind.PREPOSITION:
        return ParseTree(_denied(phrase, children), children)
    told = {id(c): word for c in children if (word := _of_nothing(c, phrase)) is not None}
    words = tuple(dict.fromkeys((*phrase.words, *told.values())))
    return ParseTree(replace(phrase, words=words), tuple(c for c in children if id(c) not in told))


def _denied(phrase: Phrase, landmarks: tuple[ParseTree, ...]) -> Phrase:
    """ "Next to no chair" is not next to a chair."""
    none = len(landmarks) == 1 and landmarks[0].phrase.text.startswith(_NO) and landmarks[0].phrase.noun is not None
    if not none or phrase.words[0] not in listed("with nothing there"):
        return phrase
    return replace(phrase, words=(f"{NOT} {phrase.words[0]}", *phrase.words[1:]))


def _of_nothing(place: ParseTree, head: Phrase) -> str | None:
    """The word for a preposition that is denied of everything else, or of others of a kind; None where it is not."""
    if place.phrase.kind is not PhraseKind.PREPOSITION or len(place.children) != 1 or head.kind is not PhraseKind.NOUN:
        return None
    phrase, name = place.children[0].phrase, place.phrase.words[0]
    denied, plain = name.startswith(f"{NOT} "), name.removeprefix(f"{NOT} ")
    if phrase.color or place.children[0].children or plain not in listed("with nothing there"):
        return None
    if phrase.noun == _THING:
        told = phrase.text == _NOTHING if not denied else phrase.text in (_ANYTHING, f"{_ANYTHING} else")
        return f"{NOTHING}{plain}" if told else None
    like = phrase.noun == head.noun and {*phrase.words} <= {"any", _OTHER}
    none = denied and (_OTHER in phrase.words or phrase.text.startswith(_NO))
    return f"{NO_OTHER}{plain}" if like and none else None
