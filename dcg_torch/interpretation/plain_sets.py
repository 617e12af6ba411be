"""What picks from several, in plain words: "the middle one of the five", "the darker of the pair", "close together"."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.names.normal_form import heads, singular
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import BUILT_OF, GROUP_WORDS, INSIDE, MUTUAL, TOGETHER, counted
from dcg_torch.types import ParseTree, Phrase, PhraseKind, WorldModel

_EACH_OTHER, _PAIR = "each other", "pair"
_TWOSOMES = listed("two together")
_GROUP, _BETWEEN = "group", "between"
_MIDDLE_OF = "in the middle of"
_CLUSTERS = frozenset(word for word, kinds in GROUP_WORDS.items() if kinds == ("cluster",))


def middle_of_set(tree: ParseTree) -> ParseTree:
    """ "The cube in the middle of the five cubes on the left" is the middle one of those on the left."""
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN:
        return tree
    for k, place in enumerate(tree.children):
        name, landmark = place.phrase.words[0], place.children[0].phrase if len(place.children) == 1 else phrase
        loose = _CLUSTERS & {*landmark.words}
        inside = name == _MIDDLE_OF or (bool(loose) and name in INSIDE and "middle" in phrase.words)
        if not inside or landmark is phrase or not (landmark.plural and _may_be_one_of(phrase, landmark)):
            continue
        others = {w for w in landmark.words if w not in loose and not w.startswith("of ")} - {"other"}
        number = counted(landmark.words) or landmark.count
        if others or number == 2 or phrase.plural:
            continue
        one = _one_of(phrase, landmark, number, "middle")
        return ParseTree(one, (*tree.children[:k], *place.children[0].children, *tree.children[k + 1 :]))
    return tree


def _one_of(phrase: Phrase, several: Phrase, number: int | None, *more: str) -> Phrase:
    """A phrase of one that also says what those are called that it is one of, how many they are, and more words."""
    few = () if number is None else (f"of {number}",)
    words = tuple(dict.fromkeys((*phrase.words, *more, *few)))
    return replace(phrase, noun=phrase.noun or several.noun, color=phrase.color or several.color, words=words)


def _may_be_one_of(phrase: Phrase, several: Phrase) -> bool:
    nouns, colors = {phrase.noun, several.noun} - {None}, {phrase.color, several.color} - {None}
    return len(nouns) == 1 and len(colors) <= 1


def one_of_those(tree: ParseTree) -> ParseTree:
    """ "The left one of the two cubes" is a cube, also where its name is left to what it is one of, or said twice."""
    phrase = tree.phrase
    of = next((c for c in tree.children if c.phrase.words[:1] == ("of",) and len(c.children) == 1), None)
    if phrase.kind is not PhraseKind.NOUN or phrase.plural or of is None:
        return tree
    those = of.children[0].phrase
    if not those.plural or those.words or not GROUP_WORDS.keys().isdisjoint({those.noun}):
        return tree
    if those.noun is None or not _may_be_one_of(phrase, those):
        return tree
    one = _one_of(phrase, those, those.count)
    return ParseTree(one, (*(c for c in tree.children if c is not of), *of.children[0].children))


def by_members(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """A tree in which "the three-block line" is the line of three blocks, "the block tower" the tower of blocks.

    Args:
        said: the words of the tree.
        world: a "tower" that is there is meant itself.
    """
    if not any(set(noun.split(" ")) & _NAMED_BY_MEMBERS for noun in said.nouns):
        return tree
    return _by_members(tree, heads(world.classes))


_NAMED_BY_MEMBERS = GROUP_WORDS.keys() | BUILT_OF.keys()


def _by_members(tree: ParseTree, there: frozenset[str]) -> ParseTree:
    children = tuple(_by_members(child, there) for child in tree.children)
    return ParseTree(of_its_members(tree.phrase, there), children)


def of_its_members(phrase: Phrase, there: frozenset[str]) -> Phrase:
    """A noun phrase, where it is "the three-block line", as that of a group.

    Args:
        there: the last words of the names of classes.
    """
    words = (phrase.noun or "").split(" ")
    kind = next((w for w in words if w in GROUP_WORDS or w in BUILT_OF), None)
    number = phrase.count if phrase.count is not None and phrase.count > 1 else counted(phrase.words)
    if phrase.kind is not PhraseKind.NOUN or kind is None or not there.isdisjoint({words[-1], kind}):
        return phrase
    several = words[-1] != phrase.text.split(" ")[-1]  # "the two block towers" are two
    member = words[: words.index(kind)]
    if several or not ((number and (member or kind in BUILT_OF)) or (member and member[-1] in there)):
        return phrase
    few = () if number is None else (f"of {number}",)
    said = tuple(dict.fromkeys((*phrase.words, BUILT_OF.get(kind, kind), *few)))
    noun = " ".join(member) or None
    return replace(phrase, noun=noun, words=said, plural=noun is not None, count=None)


def of_a_pair(tree: ParseTree) -> ParseTree:
    """ "The darker one of the pair of dots" is one of two that stand together."""
    phrase = tree.phrase
    places = [c for c in tree.children if c.children and c.phrase.words[:1] and c.phrase.words[0] in INSIDE]
    of = next((c.children[0] for c in places if _PAIR in c.children[0].phrase.words), None)
    if phrase.kind is not PhraseKind.NOUN or of is None or phrase.plural:
        return tree
    one = _one_of(phrase, of.phrase, 2, *of.phrase.words)
    kept = tuple(c for c in tree.children if c.children[:1] != (of,) and c not in of.children)
    return ParseTree(one, (*kept, *of.children))


def together(tree: ParseTree) -> ParseTree:
    """ "The two cubes next to each other", "the left one of the pair": those that are nearest to one another."""
    phrase = tree.phrase
    places = [c for c in tree.children if c.children and c.phrase.words[:1] and c.phrase.words[0] in MUTUAL]
    close = [c for c in places if _EACH_OTHER in c.children[0].phrase.words]
    several = counted(phrase.words) or max(2, phrase.count or 0)
    if phrase.kind is not PhraseKind.NOUN or not (close or _PAIR in phrase.words):
        return tree
    words = (*(word for word in phrase.words if word != _PAIR), f"{TOGETHER}{several}")
    return ParseTree(replace(phrase, words=words), tuple(c for c in tree.children if c not in close))


def few_together(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """ "The group of three blocks", by nothing else, is the three blocks that stand closest together.

    Args:
        said: the words of the tree.
        world: is not looked at: where there are many, some always form a looser group by chance.
    """
    return tree if said.words.isdisjoint(_CLUSTERS) else _few_together(tree)


def _few_together(tree: ParseTree) -> ParseTree:
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN:
        return replace(tree, children=(*map(_few_together, tree.children[:1]), *tree.children[1:]))
    number = counted(phrase.words)
    others = {*phrase.words} - _CLUSTERS - {f"of {number}"}
    if number is None or others or tree.children or _CLUSTERS.isdisjoint(phrase.words):
        return tree
    return ParseTree(replace(phrase, words=(f"{TOGETHER}{number}",), plural=True, count=number))


def several_pairs(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """ "Between two pairs of cubes" is between two groups that are of two each.

    Args:
        said: the words of the tree.
        world: is not looked at.
    """
    return tree if said.words.isdisjoint(_TWOSOMES) else _several_pairs(tree)


def _several_pairs(tree: ParseTree) -> ParseTree:
    phrase, children = tree.phrase, tuple(map(_several_pairs, tree.children))
    pairs = _TWOSOMES & {*phrase.words}
    if phrase.plural and pairs and any(f"{word}s" in phrase.text.split(" ") for word in pairs):
        words = dict.fromkeys((_GROUP, "of 2", *(word for word in phrase.words if word not in _TWOSOMES)))
        phrase = replace(phrase, words=tuple(words))
    if phrase.words[:1] == (_MIDDLE_OF,) and children != tree.children:
        phrase = replace(phrase, words=(_BETWEEN, *phrase.words[1:]))
    return ParseTree(phrase, children)


def one_pair(tree: ParseTree, said: Words, world: WorldModel) -> ParseTree:
    """ "The pair of shoes" is one thing where a recogniser calls one thing "shoes".

    Args:
        said: the words of the tree.
    """
    if _PAIR not in said.words:
        return tree
    plural = {singular(last) for type_ in world.classes if (last := type_.lower().split(" ")[-1]) != singular(last)}
    return _of_pairs(tree, plural) if plural else tree


def _of_pairs(tree: ParseTree, plural: Collection[str]) -> ParseTree:
    phrase = tree.phrase
    if _PAIR in phrase.words and phrase.noun is not None and singular(phrase.noun) in plural and phrase.count == 2:
        words = tuple(word for word in phrase.words if word != _PAIR)
        phrase = replace(phrase, words=words, plural=False, count=None)
    return ParseTree(phrase, tuple(_of_pairs(child, plural) for child in tree.children))
