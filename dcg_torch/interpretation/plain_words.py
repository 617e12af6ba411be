"""What people say in many ways, in the words that the shipped weights are for: "smaller" of two is "smallest", the far
right is "closest to the right", the middle of a table that is no object of its own is the middle of the scene."""

from __future__ import annotations

from dataclasses import replace

from dcg_torch.interpretation.comparatives import compared_twice, compared_with
from dcg_torch.interpretation.converse_relations import lacking, seen_from_it
from dcg_torch.interpretation.plain_lines import line_of_all, read_along
from dcg_torch.interpretation.plain_places import (
    MIDDLES,
    at_a_place,
    closest,
    in_one_corner,
    is_of_all,
    near_side,
    over_and_beyond,
    picks_by_place,
    ranked_by_distance,
    side_with_a_middle,
    told_sides,
)
from dcg_torch.interpretation.plain_sets import middle_of_set, of_a_pair, one_of_those, together
from dcg_torch.interpretation.relative_nearness import nearer_of_two
from dcg_torch.interpretation.stacks import end_of_a_stack, from_the_ground, levels_of_stack
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import (
    BESIDE_WHOM,
    BY_COMPASS,
    COMPASS,
    FARTHEST,
    FLAT_SYNONYMS,
    GROUND_WORD,
    GROUP_WORDS,
    HOME,
    LATERAL,
    LIKE_RELATION,
    NEAREST,
    OF_BOTH,
    ORDINALS,
    PICKED_FROM,
    PLACE_WORDS,
    QUANTIFIERS,
    SAME_RELATION,
    SIDE_OF,
    SIDED,
    STOOD_ON,
    SYNONYMS,
    THAN,
    VIEWERS,
    WORKSPACE,
    counted,
    is_superlative,
)
from dcg_torch.names.weights import log_odds
from dcg_torch.types import NOT, ParseTree, Phrase, PhraseKind


def in_plain_words(tree: ParseTree, there: frozenset[str], *, flat: bool = False, upright: bool = False) -> ParseTree:
    """A parse tree in plain words.

    Args:
        there: the `heads` of the types of the objects that are there: a table that is there is meant itself.
        flat: does all stand on one level?
        upright: is that level a page or a wall, so that what is over a thing is beyond it as well?
    """
    for in_other_words in _FIRST:
        tree = in_other_words(tree)
    phrase = tree.phrase
    below = tuple(in_plain_words(child, there, flat=flat, upright=upright) for child in tree.children)
    children = tuple(said for child in below for said in _placed(child, there))
    if upright and phrase.kind is PhraseKind.NOUN:
        children = tuple(said for child in children for said in over_and_beyond(child))
    if phrase.kind is not PhraseKind.NOUN:
        return ParseTree(phrase, children)
    if phrase.noun in COMPASS:
        sides = COMPASS[phrase.noun]
        phrase = replace(phrase, noun=sides[-1], words=(*sides[:-1], *phrase.words))
    phrase, children = (told := compared_with(ParseTree(phrase, children))).phrase, told.children
    if any(child.phrase.words[:1] == (THAN,) for child in children):
        return told
    picks = tuple(word for child in below if (word := _picks(child)) is not None)
    words = levels_of_stack(read_along(_plain((*phrase.words, *picks)), children), children)
    words = tuple(FLAT_SYNONYMS.get(word, word) for word in words) if flat else words
    words = ranked_by_distance(words, phrase)
    words = tuple(word for word in words if word not in QUANTIFIERS)
    if not COMPASS.keys().isdisjoint(phrase.words):
        words = tuple(word for word in words if word != "most")  # "the most northern cube"
    apart = not (
        phrase.plural or any(in_group(at.phrase) or at.phrase.noun in SIDED for c in children for at in c.children)
    )
    middle = side_with_a_middle([w for w in words if picks_by_place(w)]) if apart else None
    if middle is not None:
        words = tuple(w for w in words if w not in {*MIDDLES, middle})
        children = (*children, closest(f"{middle} middle"))
    named = () if phrase.noun in PLACE_WORDS else told_sides(words, children)
    if named:
        words = tuple(word for word in words if word not in named)
        children = (*children, near_side(named))
    if not any(map(is_superlative, words)) and counted(words) is None:
        children = in_one_corner(children)
    return together(ParseTree(phrase if words == phrase.words else replace(phrase, words=words), children))


def _plain(words: tuple[str, ...]) -> tuple[str, ...]:
    """Words in those that are used for several of one meaning, each once; those of a map are sides."""
    plain = (said for word in words for said in COMPASS.get(word, (SYNONYMS.get(word, word),)))
    return tuple(dict.fromkeys(plain))


def _farthest_to_a_side(tree: ParseTree) -> ParseTree:
    """ "The second farthest cube to the left" is the second from the left; without an ordinal, the leftmost."""
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN:
        return tree
    ends = [c for c in tree.children if c.phrase.words[:1] == ("farthest to",) and len(c.children) == 1]
    sides = [c.children[0] for c in ends if c.children[0].phrase.noun in LATERAL]
    if len(sides) != 1 or sides[0].phrase.words or not all(map(_of_you, sides[0].children)):
        return tree
    side = sides[0].phrase.noun
    word = f"from the {side}" if not ORDINALS.keys().isdisjoint(phrase.words) else f"{side}most"
    kept = tuple(c for c in tree.children if c.children != (sides[0],))
    return ParseTree(replace(phrase, words=(*phrase.words, word)), kept)


def _of_you(place: ParseTree) -> bool:
    """ "Farthest to the left of you": as you see it."""
    return place.phrase.words[:1] == ("of",) and [c.phrase.noun for c in place.children] == ["you"]


def _counted_from_a_side(tree: ParseTree) -> ParseTree:
    """ "From the left, the third cube", "the second cube to the left": the third and the second from the left."""
    phrase = tree.phrase
    if phrase.kind is not PhraseKind.NOUN or not (ORDINALS.keys() | _NTH.keys() | {"last"}) & {*phrase.words}:
        return tree
    if not _NTH.keys().isdisjoint(phrase.words):  # "cube number 2 from the left"
        counted = any(c.phrase.words[:1] == ("from",) and c.children[0].phrase.noun in SIDED for c in tree.children)
        words = tuple(_NTH.get(word, word) for word in phrase.words)
        return _counted_from_a_side(replace(tree, phrase=replace(phrase, words=words))) if counted else tree
    if ends := [word for word in phrase.words if word in _ENDS]:  # "second farthest to the left"
        words = tuple(_ENDS.get(word, word) for word in phrase.words)
        return tree if len(ends) > 1 else replace(tree, phrase=replace(phrase, words=words))
    if any(is_superlative(word) or word.startswith("from ") for word in phrase.words):
        return tree
    for k, place in enumerate(tree.children):
        side = place.children[0] if len(place.children) == 1 else tree
        if place.phrase.words[:1] and place.phrase.words[0] in COUNTED_FROM and side.phrase.noun not in PLACE_WORDS:
            # "The second one to the right of the cup" is the second that one comes to.
            return replace(tree, phrase=replace(phrase, words=(*phrase.words, COUNTED_FROM[place.phrase.words[0]])))
        if place.phrase.words[:1] == ("from",) and (end := _end_of_its_kind(phrase, side)) is not None:
            return replace(
                tree,
                phrase=replace(phrase, words=(*phrase.words, end)),
                children=(*tree.children[:k], *tree.children[k + 1 :]),
            )
        if place.phrase.words[:1] in {("from",), ("away from",)} and _is_a_thing(side):
            # "The second chair from the door", and the last and the second to last from there.
            end = FARTHEST if "last" in phrase.words else NEAREST
            ranked = replace(place, phrase=replace(place.phrase, words=(end, *place.phrase.words[1:])))
            words = tuple(word for word in phrase.words if word != "last")
            children = (*tree.children[:k], ranked, *tree.children[k + 1 :])
            return replace(tree, phrase=replace(phrase, words=words), children=children)
        beside = place.phrase.words[:1] == ("from",) or place.phrase.text.split()[:1] == ["to"]
        if beside and side.phrase.noun in SIDED and not (side.children or {*side.phrase.words} - {"your", "my"}):
            word = f"from the {side.phrase.noun}"
            return ParseTree(
                replace(phrase, words=(*phrase.words, word)), (*tree.children[:k], *tree.children[k + 1 :])
            )
    return tree


_ENDS = {f"{side}most": f"from the {side}" for side in LATERAL}


def _end_of_its_kind(phrase: Phrase, landmark: ParseTree) -> str | None:
    """ "The second cube from the leftmost one": the first is that one, as in "the second from the left"."""
    first = landmark.phrase
    alike = first.noun in (phrase.noun, None) and first.color in (phrase.color, None)
    end = _ENDS.get(first.words[0]) if len(first.words) == 1 else None
    return end if alike and not (first.plural or landmark.children) else None


def _is_a_thing(landmark: ParseTree) -> bool:
    """Is it no side, place or group, nor what lies at one of them?"""
    phrase = landmark.phrase
    return (
        phrase.kind is PhraseKind.NOUN
        and phrase.noun is not None
        and not phrase.plural
        and not (phrase.noun in PLACE_WORDS or phrase.noun in SIDED or phrase.noun in WORKSPACE or in_group(phrase))
    )


_NTH = {str(number): word for word, number in ORDINALS.items()}
COUNTED_FROM = {"left of": "from the right", "right of": "from the left"}
"""Side of a landmark -> from where what stands there is counted: its nearest is the first."""


def _sided(tree: ParseTree) -> ParseTree:
    """ "Your side of the table" is where you are; what has a lamp on it is under the lamp; rows are lines of all."""
    if tree.phrase.kind is not PhraseKind.PREPOSITION or len(tree.children) != 1:
        return tree
    landmark = tree.children[0]
    phrase, name = landmark.phrase, tree.phrase.words[0]
    whose = tree.phrase.text == phrase.text  # "the mug whose spoon is on the right"
    from_it = seen_from_it(landmark.children[0], whose=whose) if len(landmark.children) == 1 else None
    if name in ("with", "without") and from_it is not None:
        words = (from_it if name == "with" else f"{NOT} {from_it}", *tree.phrase.words[1:])
        return ParseTree(replace(tree.phrase, words=words), (replace(landmark, children=()),))
    line = line_of_all(phrase)
    if line is not None and not landmark.children and (name in _WITHIN or name in PICKED_FROM):
        words = ("in" if name in _WITHIN else name, *tree.phrase.words[1:])
        return ParseTree(replace(tree.phrase, words=words), (ParseTree(line),))
    owner = whose_side(phrase)
    if owner is None or name not in _AT_SIDE:
        return tree
    who = ParseTree(replace(phrase, noun=owner, words=()))
    return ParseTree(replace(tree.phrase, words=(NEAREST, *tree.phrase.words[1:])), (who,))


def whose_side(phrase: Phrase) -> str | None:
    """Where the one is whose side of a thing a phrase names: "my side of the table", and not "my left side"."""
    if phrase.noun not in ("side", "end", "edge") or not {*phrase.words}.isdisjoint(SIDED | SYNONYMS.keys()):
        return None
    return next((OWNED_BY[word] for word in phrase.words if word in OWNED_BY), None)


_FIRST = (
    nearer_of_two,
    lacking,
    compared_twice,
    from_the_ground,
    end_of_a_stack,
    _sided,
    one_of_those,
    of_a_pair,
    middle_of_set,
    _farthest_to_a_side,
    _counted_from_a_side,
)


_ANYWHERE = listed("anywhere in")
_WITHIN = listed("at a side")
_AT_SIDE = (*_WITHIN, *SAME_RELATION, NEAREST, "near")
OWNED_BY = {"your": "you", "my": "me"}


def _names_one(noun: str, there: frozenset[str]) -> bool:
    """Is it a name of something that is there? "Picture" may be said of anything, and is then no name of it."""
    return any(log_odds(noun, head) > 0.0 for head in there)


def _picks(tree: ParseTree) -> str | None:
    """The rank that a place in a group is: "on the right side of the row" is the rightmost in it."""
    if len(tree.children) != 1 or not in_group(tree.children[0].phrase):
        return None
    name, beside = tree.phrase.words[0], tree.phrase.text.startswith(("to ", "left of", "right of", "behind"))
    return None if beside else PICKED_FROM.get(name)


def in_group(phrase: Phrase) -> bool:
    """Does a noun phrase speak of a group of objects?"""
    return phrase.kind is PhraseKind.NOUN and not GROUP_WORDS.keys().isdisjoint((phrase.noun, *phrase.words))


def _of_all(tree: ParseTree) -> ParseTree:
    """ "The corner of the board" is the corner: of all that is there."""
    if tree.phrase.noun not in PLACE_WORDS:
        return tree
    kept = [c for c in tree.children if not (c.phrase.words[0] in _WITHIN and is_of_all(c))]
    return replace(tree, children=tuple(kept))


_ROOM = listed("whole of a room")


def _placed(tree: ParseTree, there: frozenset[str]) -> tuple[ParseTree, ...]:
    """What a preposition and its landmark say: sides of the workspace, degrees, two sides at once."""
    if tree.phrase.kind is not PhraseKind.PREPOSITION or not tree.children:
        return (tree,)
    if len(tree.children) > 1:  # "with the lamp and the plant" is with each of them
        whole = tree.phrase.words[0].removeprefix(f"{NOT} ") in OF_BOTH
        each = (replace(tree, children=(child,)) for child in tree.children)
        return (tree,) if whole else tuple(said for one in each for said in _placed(one, there))
    landmark, name = _of_all(tree.children[0]), tree.phrase.words[0]
    if name in BY_COMPASS:
        words = BY_COMPASS[name]
        return tuple(replace(tree, phrase=replace(tree.phrase, words=(word, *tree.phrase.words[1:]))) for word in words)
    phrase = landmark.phrase
    home = phrase.noun in HOME or (phrase.noun in _ROOM and not (phrase.words or landmark.children))
    if home and name in _WITHIN and not any(head.startswith(phrase.noun or "") for head in there):
        return ()
    if phrase.noun in VIEWERS and not _names_one(phrase.noun, there):
        phrase = replace(phrase, noun="you")
    owner = next((word for word, who in OWNED_BY.items() if who == phrase.noun), None)
    if owner is not None and name in BESIDE_WHOM:  # "left of you" is not beside you alone
        name, phrase = "on", replace(phrase, noun=BESIDE_WHOM[name], words=(owner,))
    if name in SIDE_OF and phrase.noun in _ROOM and not (phrase.words or landmark.children or phrase.noun in there):
        name, phrase = "on", replace(phrase, noun=SIDE_OF[name])  # "on the left side of the room"
    if phrase.noun in WORKSPACE and not (
        any(head.startswith(phrase.noun) for head in there) or _names_one(phrase.noun, there)
    ):
        anywhere = name in _ANYWHERE and not (name == "on" and phrase.noun in STOOD_ON)
        if anywhere and NOT not in tree.phrase.words and not (landmark.children or phrase.words):
            return ()  # all that is there is in the picture
        if name in SIDE_OF:
            name, phrase = "on", replace(phrase, noun=SIDE_OF[name], words=())
        elif phrase.noun not in PLACE_WORDS:
            phrase = replace(phrase, noun=GROUND_WORD)
    if _picks(tree) is not None or (name == "of" and in_group(phrase)):
        name = "in"  # "the middle one of the stack"
    name, phrase = at_a_place(name, phrase, landmark, tree.phrase.text)
    name = SAME_RELATION.get(name, name)
    like = (LIKE_RELATION[name],) if name in LIKE_RELATION else ()
    words = (name, *like, *tree.phrase.words[1:])
    return (ParseTree(replace(tree.phrase, words=words), (replace(landmark, phrase=phrase),)),)
