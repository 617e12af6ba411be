"""What a command leaves out: "all cups but the white one", "everything except what is on the table"."""

from __future__ import annotations

import functools
from dataclasses import replace

from dcg_torch.grounding.solution import target_of, with_target
from dcg_torch.names.attributes import NOT_
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import DEFINITE, EXCEPT, ORDINALS, is_superlative
from dcg_torch.types import ParseTree, Phrase, WorldModel

_ALL = "all"
_PRONOUNS = listed("stands for a thing")


@functools.lru_cache(maxsize=1024)
def split_exceptions(tree: ParseTree) -> tuple[ParseTree, tuple[ParseTree, ...]]:
    """A command without the exceptions of its noun phrase, and for each of them the same command about what it names.

    What is left out is one of those that are meant otherwise: it is called so and stands so, if nothing else is said.
    """
    noun = target_of(tree)
    if noun is None:
        return tree, ()
    exceptions = tuple(c for c in noun.children if c.phrase.words[:1] == (EXCEPT,))
    ends = () if noun.phrase.plural else tuple(word for word in noun.phrase.words if _denies_an_end(word))
    if not exceptions and not ends:
        return tree, ()
    named = [out for child in exceptions for out in child.children]
    named += [_at_the_end(word, noun.phrase) for word in ends]
    words = tuple(word for word in noun.phrase.words if word not in ends)
    kept = ParseTree(replace(noun.phrase, words=words), tuple(c for c in noun.children if c not in exceptions))
    bare = kept.phrase.noun is None and kept.phrase.color is None
    if bare and (any(map(_counts, named)) or (kept.phrase.text == _ALL and any(map(_is_told_apart, named)))):
        of = named[0]  # "all but two of the cubes", "all but the smallest cube": they are cubes
        by_color = not (of.phrase.words or of.children or any(map(_counts, named)))  # "all but the red cups"
        color = None if by_color else of.phrase.color
        kept = ParseTree(replace(kept.phrase, noun=of.phrase.noun, color=color), kept.children + of.children)
    return with_target(tree, kept), tuple(with_target(tree, _of_those(out, kept)) for out in named)


def without(world: WorldModel, ids: frozenset[str]) -> WorldModel:
    """A world in which some things are there and are not meant."""
    may_be = frozenset(o.id for o in world.things) if world.meant is None else world.meant
    return replace(world, meant=may_be - ids)


def _denies_an_end(word: str) -> bool:
    """ "Not leftmost", "not closest": an end that is denied is that of all of the name, whatever else is said."""
    return word.startswith(NOT_) and is_superlative(word.removeprefix(NOT_))


def _at_the_end(word: str, phrase: Phrase) -> ParseTree:
    end = word.removeprefix(NOT_)
    return ParseTree(replace(phrase, text=f"the {end} {phrase.noun or 'one'}", words=(end,), count=None))


def _is_definite(out: ParseTree) -> bool:
    return out.phrase.text.partition(" ")[0] in DEFINITE


def _is_told_apart(out: ParseTree) -> bool:
    """Is it one of several of its name: "the smallest cube", "the cube on the shelf"?"""
    return bool(out.phrase.noun and (out.phrase.words or out.phrase.color or out.children))


def _counts(out: ParseTree) -> bool:
    """Is it so many of them, whichever: "two of the cubes", "one"?"""
    return out.phrase.count is not None and not _is_definite(out)


def _of_those(out: ParseTree, kept: ParseTree) -> ParseTree:
    """What is left out, with what it shares with the rest. "A mug", "what is red", "the mug": all that are so."""
    phrase = out.phrase
    by_name = phrase.noun is not None and phrase.noun != kept.phrase.noun and not _is_told_apart(out)
    several = phrase.plural or by_name or not (_is_definite(out) or _counts(out))
    if kept.phrase.text in _PRONOUNS:  # "Is it the leftmost? No. Is it red? Yes.": of all, not of the red ones
        return ParseTree(replace(phrase, noun=phrase.noun or kept.phrase.noun, plural=several), out.children)
    shared = tuple(w for w in kept.phrase.words if w not in ORDINALS and not is_superlative(w))
    words = tuple(dict.fromkeys((*shared, *phrase.words)))
    color = phrase.color or kept.phrase.color
    named = replace(phrase, noun=phrase.noun or kept.phrase.noun, color=color, words=words, plural=several)
    return ParseTree(named, (*out.children, *(c for c in kept.children if c not in out.children)))
