"""What noun phrases are told of a command's words, where colours and attributes are to be judged by looking."""

from __future__ import annotations

import functools
import operator
import re
from dataclasses import dataclass, replace

from dcg_torch.names.attribute_values import stated_values
from dcg_torch.names.colors import comparing_words, is_shade, middle_shade
from dcg_torch.names.normal_form import normalise
from dcg_torch.names.palette import color_words
from dcg_torch.names.relations import listed
from dcg_torch.names.weights import names_one_of
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel


@dataclass(frozen=True)
class Looks:
    """What may be told by looking in a world.

    Attributes:
        shown, named: do things show their colours, or are these but named?
        valued: have things attributes with values?
        classes: the types that may be there, where colours are shown.
        sized: have things that show their colours several sizes?
    """

    shown: bool
    named: bool
    valued: bool
    classes: frozenset[str]
    sized: bool = False

    @classmethod
    def of(cls, world: WorldModel) -> Looks:
        """What may be told by looking in this world."""
        shown = any(o.rgb is not None for o in world.objects)
        named = not shown and any(o.color is not None for o in world.objects)
        valued = any(":" in a for of in {o.attributes for o in world.objects} for a in of)
        sized = shown and len({o.size for o in world.objects if o.size is not None}) > 1
        return cls(shown, named, valued, world.classes if shown else frozenset(), sized)


@functools.lru_cache(maxsize=1024)
def with_appearance_words(tree: ParseTree, text: str, looks: Looks) -> ParseTree:
    """The tree whose noun phrases are also told of the command's words what is to be judged by looking.

    Where things show their colours the first noun phrase is told of all words, but of its own alone if the command
    speaks of other things too. Where their colours are but named each is told of those of its words that compare
    ("darkest"). The first is told of what may be the value of an attribute where things have such.
    """
    if not looks.shown and not looks.named and not looks.valued:
        return tree
    words = _words(text)
    several = looks.shown and (_speaks_of_others(tree, looks.classes) or _is_mended(tree, text))
    values = stated_values(words) if looks.valued else ()
    names = _names_of_classes(tree, looks.classes)
    signs = color_words().signs
    if looks.sized and not {*words} & {*signs["shade"]}:
        names |= {*signs["middle"]}  # "the medium black one" is of medium size
    if looks.named or several:
        tree = _each_told(tree, names, compared=looks.named)
        words = ()
    return _told(tree, _but_names(words, names) if looks.shown else (), values)


def _names_of_classes(tree: ParseTree, types: frozenset[str]) -> frozenset[str]:
    """The words of nouns that name a class that is there: "bottle" tells of no bottle green then."""
    nouns = {node.phrase.noun for node in tree.walk() if node.phrase.noun is not None}
    return frozenset(word for noun in nouns if names_one_of(noun, types) for word in normalise(noun).split())


def _but_names(words: tuple[str, ...], names: frozenset[str]) -> tuple[str, ...]:
    return tuple(word for word in words if normalise(word) not in names) if names else words


def _speaks_of_others(tree: ParseTree, types: frozenset[str]) -> bool:
    """Whether a noun phrase after the first is one of the things that are there: "the small one above the big dot"."""
    _, *others = [node.phrase for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN] or [tree.phrase]
    goals = [noun.phrase for place in tree.children[1:] for noun in place.children]  # "between the two yellow ones"
    return any(
        names_one_of(noun.noun, types) if noun.noun else noun.text.endswith(" one") or noun in goals or _is_told(noun)
        for noun in others
    )


def _is_told(noun: Phrase) -> bool:
    """Is more said of what a pronoun stands for: "do you see a big dark one? The dot above it"?"""
    return noun.text in _PRONOUNS and bool(noun.words or noun.color)


_PRONOUNS = listed("stands for a thing")


def _is_mended(tree: ParseTree, text: str) -> bool:
    """Is the first noun phrase put together from several of the text, because the speaker took something back?"""
    first = next((node.phrase for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN), None)
    own, spoken = (re.findall(r"\w+", said.lower()) for said in ("" if first is None else first.text, text))
    return len(own) > 1 and {*own} <= {*spoken} and f" {' '.join(own)} " not in f" {' '.join(spoken)} "


def _words(text: str) -> tuple[str, ...]:
    return tuple(re.findall(r"\w+|[^\w\s]", re.sub(r"n't\b", " not", text.lower())))


def _each_told(tree: ParseTree, names: frozenset[str], *, compared: bool) -> ParseTree:
    """The tree whose noun phrases are each told of their own words; of those that compare colours alone if so asked."""
    children = tuple([_each_told(child, names, compared=compared) for child in tree.children])
    phrase = tree.phrase
    if phrase.kind is PhraseKind.NOUN and not (compared and not phrase.words and not phrase.look):
        own = _words(" ".join(filter(None, (*phrase.words, phrase.color))) if _is_told(phrase) else phrase.text)
        look = comparing_words([w for w in own if w in phrase.words]) if compared else _but_names(own, names)
        phrase = phrase if look == phrase.look else _judged(phrase, look, phrase.words)
    return _tree(tree, phrase, children)


def _tree(before: ParseTree, phrase: Phrase, children: tuple[ParseTree, ...]) -> ParseTree:
    """The tree of a phrase and children: the one before, where nothing has changed."""
    if phrase is before.phrase and all(map(operator.is_, children, before.children)):
        return before
    return ParseTree(phrase, children)


def _told(tree: ParseTree, look: tuple[str, ...], values: tuple[str, ...]) -> ParseTree:
    phrase = tree.phrase
    if phrase.kind is PhraseKind.NOUN:
        words = tuple(dict.fromkeys((*phrase.words, *values)))
        if words == phrase.words and not look:
            return tree
        return ParseTree(_judged(phrase, look or phrase.look, words), tree.children)
    return _tree(tree, phrase, (*(_told(c, look, values) for c in tree.children[:1]), *tree.children[1:]))


def _judged(phrase: Phrase, look: tuple[str, ...], words: tuple[str, ...]) -> Phrase:
    """A phrase whose colour is judged by its words: "blue/gray" and "dull green" are no names of a colour."""
    told = {name for word in look for name in (normalise(word), color_words().alike.get(normalise(word)))}
    others = told & color_words().basic & {*words, normalise(phrase.noun or "")} - {phrase.color}
    plain = not others and not is_shade(look) and " " not in (phrase.color or "")
    placed = not any(middle_shade(look[k:]) for k in range(len(look)))  # a middle shade may stand anywhere
    words = words if placed else tuple(word for word in words if word not in color_words().signs["middle"])
    return replace(phrase, look=look, words=words, color=phrase.color if plain else None)
