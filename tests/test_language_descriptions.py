"""Everything that a sentence says of the object meant, and what must not change it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from language_descriptions import DEVELOPMENT, FRESH, HELD_OUT, Description

from dcg_torch.bench.__main__ import hostile
from dcg_torch.language import Parser, target_phrase
from dcg_torch.types import ParseTree, Phrase, PhraseKind

KNOWN = ("cube", "sphere", "cylinder")
FIELDS = ("noun", "color", "relations", "words", "count", "plural", "also")


def tree_of(parser: Parser, text: str) -> ParseTree:
    parse = parser.parse(text, KNOWN)
    assert parse.tree is not None, parse.problem
    return parse.tree


def target(parser: Parser, text: str) -> Phrase:
    return target_phrase(tree_of(parser, text)).phrase


def read(parser: Parser, text: str) -> Description | None:
    """What the parser finds, in the form in which the sentences are written down."""
    tree = parser.parse(text, KNOWN).tree
    if tree is None:
        return None
    meant = target_phrase(tree)
    first = tree.children[0]
    together = tree.children if first.phrase.kind is PhraseKind.NOUN else first.children
    return Description(
        text,
        meant.phrase.noun,
        meant.phrase.color,
        tuple((place.phrase.words[0], child.phrase.noun) for place in meant.children for child in place.children),
        meant.phrase.words,
        meant.phrase.count,
        meant.phrase.plural,
        tuple(child.phrase.noun for child in together[1:] if child.phrase.kind is PhraseKind.NOUN),
    )


@pytest.mark.parametrize("said", DEVELOPMENT, ids=lambda said: said.text)
def test_description(parser: Parser, said: Description) -> None:
    assert read(parser, said.text) == said


@pytest.mark.parametrize(("sentences", "share"), [(HELD_OUT, 0.93), (FRESH, 0.82)], ids=["held out", "fresh"])
def test_held_out_descriptions(parser: Parser, sentences: tuple[Description, ...], share: float) -> None:
    found = [read(parser, said.text) for said in sentences]
    for field in FIELDS:
        right = sum(
            have is not None and getattr(have, field) == getattr(said, field)
            for have, said in zip(found, sentences, strict=True)
        )
        assert right / len(sentences) >= 0.9, field
    assert sum(have == said for have, said in zip(found, sentences, strict=True)) / len(sentences) >= share


@pytest.mark.parametrize(
    "change",
    [
        str.upper,
        str.capitalize,
        lambda text: text.replace(" ", "  "),
        lambda text: f"{text}.",
        lambda text: f"{text}!",
        lambda text: f"um, {text}",
        lambda text: f"ok {text}",
        lambda text: f"robot, {text}",
        lambda text: f"{text} please",
    ],
    ids=["upper", "capital", "spaces", "full stop", "exclamation", "filler", "opening", "address", "politeness"],
)
def test_what_says_nothing_changes_nothing(parser: Parser, change: Callable[[str], str]) -> None:
    changed = {said.text: read(parser, change(said.text)) for said in DEVELOPMENT}
    for text, found in changed.items():
        plain = read(parser, text)
        assert found is not None, text
        assert plain is not None
        assert [getattr(found, field) for field in FIELDS] == [getattr(plain, field) for field in FIELDS], text


@pytest.mark.parametrize(
    ("text", "nouns"),
    [
        ("the red chair and the blue sofa", ["chair", "sofa"]),
        ("find the chair, the sofa and the fan", ["chair", "sofa", "fan"]),
        ("the chair on the left and the sofa", ["chair", "sofa"]),
    ],
)
def test_objects_named_together_stand_below_the_root(parser: Parser, text: str, nouns: list[str]) -> None:
    children = tree_of(parser, text).children
    assert [child.phrase.kind for child in children] == [PhraseKind.NOUN] * len(nouns)
    assert [child.phrase.noun for child in children] == nouns


def test_goals_named_together_stand_below_their_preposition(parser: Parser) -> None:
    (to,) = tree_of(parser, "go to the drill, the barrel and the red cone").children
    assert to.phrase.words == ("to",)
    assert [(child.phrase.noun, child.phrase.color) for child in to.children] == [
        ("drill", None), ("barrel", None), ("cone", "red"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    "unit", ["row", "line", "column", "stack", "pile", "group", "bunch", "cluster", "set", "circle"]
)
@pytest.mark.parametrize(("number", "words"), [("", ()), ("five ", ("of 5",)), ("12 ", ("of 12",))])
def test_a_group_is_its_members(parser: Parser, unit: str, number: str, words: tuple[str, ...]) -> None:
    phrase = target(parser, f"go to the {unit} of {number}red cubes")
    assert (phrase.noun, phrase.color, phrase.plural, phrase.count) == ("cube", "red", True, None)
    assert phrase.words == (unit, *words)


def test_a_group_that_something_is_in_keeps_its_number(parser: Parser) -> None:
    meant = target_phrase(tree_of(parser, "the second cone from the left in the row of five cones"))
    ((group,),) = [place.children for place in meant.children]
    assert (group.phrase.noun, group.phrase.words, group.phrase.plural) == ("cone", ("row", "of 5"), True)


@pytest.mark.parametrize("unit", ["row", "group", "line", "stack"])
@pytest.mark.parametrize("joint", ["in", "of"])
def test_a_bare_group_is_a_landmark(parser: Parser, unit: str, joint: str) -> None:
    meant = target_phrase(tree_of(parser, f"the last one {joint} the {unit}"))
    assert (meant.phrase.noun, meant.phrase.words) == (None, ("last",))
    ((preposition, landmark),) = [(place.phrase.words[0], place.children[0].phrase.noun) for place in meant.children]
    assert (preposition, landmark) == (joint, unit)


@pytest.mark.parametrize(
    ("text", "words", "prepositions"),
    [
        ("the cube not on the table", (), ("not on",)),
        ("the cube that is not behind the cone", (), ("not behind",)),
        ("the cube not touching the cone", (), ("not touching",)),
        ("the cube that isn't red", ("not red",), ()),
        ("the not red cube", ("not red",), ()),
        ("the non-red cube", ("not red",), ()),
        ("the cube that is not small", ("not small",), ()),
        ("the cube that is neither red nor blue", ("not red", "not blue"), ()),
        ("the cube that is not facing left", ("not facing left",), ()),
        ("the cube you are not holding", ("not held",), ()),
        ("the cube without a cone on top", (), ("without",)),
        ("the cube with no cone on it", (), ("without",)),
        ("the cube that doesn't have a cone on it", (), ("without",)),
        ("the cube with nothing on it", ("nothing on",), ()),
        ("the cube that has nothing on top of it", ("nothing on",), ()),
        ("the cube without anything behind it", ("nothing behind",), ()),
    ],
)  # fmt: skip
def test_denials(parser: Parser, text: str, words: tuple[str, ...], prepositions: tuple[str, ...]) -> None:
    meant = target_phrase(tree_of(parser, text))
    assert (meant.phrase.noun, meant.phrase.color, meant.phrase.words) == ("cube", None, words)
    assert tuple(place.phrase.words[0] for place in meant.children) == prepositions


@pytest.mark.parametrize(
    "text", ["go to the cone, not the cube", "go to the cone but not the cube", "go not to the cube but to the cone"]
)
def test_what_is_ruled_out_is_not_in_the_tree(parser: Parser, text: str) -> None:
    tree = tree_of(parser, text)
    assert {node.phrase.noun for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN} == {"cone"}
    assert "not" not in tree.phrase.words


@pytest.mark.parametrize(
    "text",
    [
        "the chair facing left", "the chair that is facing to the left", "the left facing chair", "left-facing chair",
        "chair pointing left", "the chair turned to the left", "the chair which faces left",
    ],
)  # fmt: skip
def test_how_a_thing_stands_is_a_word(parser: Parser, text: str) -> None:
    assert (target(parser, text).noun, target(parser, text).words) == ("chair", ("facing left",))


@pytest.mark.parametrize(
    ("text", "preposition", "landmark", "words"),
    [
        ("the cone on your left", "on", "left", ("your",)),
        ("the cone to my right", "on", "right", ("my",)),
        ("the cone on my right hand side", "on", "right", ("my",)),
        ("the cone to the robot's left", "on", "left", ("your",)),
        ("the cone on the left from my point of view", "on", "left", ("my",)),
        ("the cone on the left side of you", "left of", "you", ()),
        ("the cone in front of me", "in front of", "me", ()),
        ("the cone nearest you", "closest to", "you", ()),
        ("the closest cone to me", "closest to", "me", ()),
        ("on your left there is a cone", "on", "left", ("your",)),
    ],
)
def test_places_beside_people(
    parser: Parser, text: str, preposition: str, landmark: str, words: tuple[str, ...]
) -> None:
    meant = target_phrase(tree_of(parser, text))
    assert (meant.phrase.noun, meant.phrase.words) == ("cone", ())
    ((name, child),) = [(place.phrase.words[0], place.children[0].phrase) for place in meant.children]
    assert (name, child.noun, child.words) == (preposition, landmark, words)


@pytest.mark.parametrize("text", ["closest to me", "nearest you", "my left", "in the corner"])
def test_a_place_alone_is_of_a_thing_unnamed(parser: Parser, text: str) -> None:
    meant = target_phrase(tree_of(parser, text))
    assert (meant.phrase.noun, meant.phrase.color, len(meant.children)) == (None, None, 1)


@pytest.mark.parametrize(
    ("text", "preposition", "number"),
    [
        ("there are three cones on your right, go to the middle one", "on", ("of 3",)),
        ("in the row of five cones, go to the middle one", "in", ()),  # the row is of five
        ("out of the three cones near the wall pick the middle one", "near", ("of 3",)),
    ],
)
def test_one_of_several_that_were_named_before(
    parser: Parser, text: str, preposition: str, number: tuple[str, ...]
) -> None:
    meant = target_phrase(tree_of(parser, text))
    assert (meant.phrase.noun, meant.phrase.words) == ("cone", ("middle", *number))
    assert [place.phrase.words for place in meant.children] == [(preposition,)]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("the bigger of the two cubes", ("bigger", "of 2")), ("the largest of the cubes", ("largest",)),
        ("the smallest of all the cubes", ("smallest",)), ("the middle of the two cubes", ("middle", "of 2")),
        ("the third of the five cubes", ("third", "of 5")), ("the last of those cubes", ("last",)),
    ],
)  # fmt: skip
def test_picks(parser: Parser, text: str, words: tuple[str, ...]) -> None:
    phrase = target(parser, text)
    assert (phrase.noun, phrase.words, phrase.count, phrase.plural) == ("cube", words, 1, False)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("there are two cones next to each other, take the left one", ("left", "of 2")),
        ("take the darker of the pair of cones", ("darker", "pair", "of 2")),
        ("two cones are close together. Take the higher one.", ("higher", "of 2")),
    ],
)
def test_a_singular_picks_one_of_several(parser: Parser, text: str, words: tuple[str, ...]) -> None:
    phrase = target(parser, text)
    assert (phrase.noun, set(phrase.words), phrase.plural) == ("cone", set(words), False)


@pytest.mark.parametrize("text", ["the two cones that almost touch", "the two cones that nearly touch each other"])
def test_what_touches_is_next_to_another_such_thing(parser: Parser, text: str) -> None:
    meant = target_phrase(tree_of(parser, text))
    assert meant.phrase.count == 2
    assert [(c.phrase.words, c.children[0].phrase.words) for c in meant.children] == [(("touching",), ("each other",))]


def test_strings_that_nobody_would_say_have_an_outcome(parser: Parser) -> None:
    rng = np.random.default_rng(2)
    for text in (hostile(rng) for _ in range(500)):
        parse = parser.parse(text, KNOWN)
        assert (parse.tree is None) != (parse.problem is None)
        if parse.tree is not None:
            assert target_phrase(parse.tree).phrase.kind is PhraseKind.NOUN
