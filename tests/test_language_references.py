"""Commands of several sentences, and phrases that say one thing in many ways; all written for this test."""

from __future__ import annotations

import pytest

from dcg_torch.interpretation.factor_tree import to_factor_tree
from dcg_torch.language import default_parser, target_phrase
from dcg_torch.types import Object, ParseTree, WorldModel

Relations = list[tuple[str, str | None]]


def described(text: str) -> tuple[str | None, tuple[str, ...], Relations]:
    """Noun, words and relations of the object meant, each landmark with its words, in the likeliest reading."""
    tree = default_parser().parse(text).tree
    assert tree is not None, text
    target = target_phrase(tree)
    return (
        target.phrase.noun,
        target.phrase.words,
        [(p.phrase.words[0], said(n)) for p in target.children for n in p.children],
    )


def said(tree: ParseTree) -> str:
    phrase = tree.phrase
    below = [f"{p.phrase.words[0]} {said(n)}" for p in tree.children for n in p.children]
    return " ".join(part for part in (*phrase.words, phrase.color, phrase.noun, *below) if part)


@pytest.mark.parametrize(
    ("text", "noun", "words", "relations"),
    [
        ("Find the lamp by the window. Bring me the cup next to that one.", "cup", (), [("next to", "lamp by window")]),
        ("I see a sofa near the bed. Walk to the chair beside it.", "chair", (), [("next to", "sofa near bed")]),
        ("There are two red boxes. Go to the cone behind those boxes.", "cone", (), [("behind", "red box")]),
        ("Find the stack of books. Take the pen next to this stack.", "pen", (), [("next to", "stack book")]),
        (
            "There is a blue car on the far left. Take the van behind it.",
            "van",
            (),
            [("behind", "blue car on far left")],
        ),
        ("Find the shelf. There is a red book on it. Bring me the book.", "book", (), [("on", "shelf")]),
        ("There are three cones in a row. Take the middle one.", "cone", ("middle",), [("in", "row of 3 cone")]),
        (
            "Bring me a mug. It is on the shelf and is next to the kettle.",
            "mug",
            (),
            [("on", "shelf"), ("next to", "kettle")],
        ),
        ("Take a face. It is the lower of the two faces on the left.", "face", ("lower", "of 2"), [("on", "left")]),
        ("Walk to the desk. Pick up the stapler.", "stapler", (), [("near", "desk")]),
        ("Walk to the desk by the door. Take the pen from the desk.", "pen", (), [("from", "desk by door")]),
    ],
)
def test_earlier_and_later_sentences_tell_what_is_meant(
    text: str, noun: str, words: tuple[str, ...], relations: Relations
) -> None:
    assert described(text) == (noun, words, relations)


@pytest.mark.parametrize(
    ("text", "noun", "words", "relations"),
    [
        ("take the crate of apples", "apple crate", (), []),
        ("pick up the skid of various parts by the door", "part skid", (), [("by", "door")]),
        ("search the garage for the blue ladder", "ladder", (), [("in", "garage")]),
        ("look in the hall for the umbrella", "umbrella", (), [("in", "hall")]),
        ("let go of the cone", "cone", (), []),
        ("turn off the lamp on the desk", "lamp", (), [("on", "desk")]),
        ("the lid of the living room table", "lid", (), [("of", "living room table")]),
        ("the cube to the right of the pair of cones", "cube", (), [("right of", "pair cone")]),
        ("the cube that is farthest to you", "cube", (), [("farthest from", "you")]),
        ("the cube furthest to the far left", "cube", (), [("farthest to", "far left")]),
        ("the cube furthest towards the door", "cube", (), [("farthest to", "door")]),
        ("take the cube that touches the sphere", "cube", (), [("touching", "sphere")]),
        ("the face touched by two other faces", "face", (), [("touching", "other face")]),
        ("the two dots side by side", "dot", (), [("next to", "each other dot")]),
        ("the dot above the two closely spaced dots", "dot", (), [("above", "dot next to each other dot")]),
        (
            "the four barrels in front of and to the left of the van",
            "barrel",
            (),
            [("in front of", "van"), ("left of", "van")],
        ),
        ("the second house on the left", "house", ("second", "from the left"), []),
        ("five cups in a row behind the robot", "cup", ("row", "of 5"), [("behind", "robot")]),
        ("Take the Red Chair next to two Blue Tables.", "chair", (), [("next to", "blue table")]),
    ],
)
def test_ways_to_say_it(text: str, noun: str, words: tuple[str, ...], relations: Relations) -> None:
    assert described(text) == (noun, words, relations)


def test_a_pallet_of_tires_has_both_readings() -> None:
    nouns = {
        target_phrase(reading.tree).phrase.noun for reading in default_parser().parse("the pallet of tires").readings
    }
    assert nouns == {"tire pallet", "pallet"}


def plain(text: str, *types: str) -> list[tuple[str, str | None, tuple[str, ...]]]:
    """Modifiers of the object meant as the factors read them, where objects of some types are there."""
    tree = default_parser().parse(text).tree
    assert tree is not None
    world = WorldModel(tuple(Object(name, name, known=True, position=(1.0, 0.0, 0.0)) for name in ("cone", *types)))
    noun = target_phrase(to_factor_tree(tree, world))
    return [(m.phrase.words[0], m.children[0].phrase.noun, m.children[0].phrase.words) for m in noun.children]


@pytest.mark.parametrize(
    ("text", "modifiers"),
    [
        ("the cone on the left side of the table", [("on", "left", ())]),
        ("the cone in the center of the picture", [("closest to", "middle", ())]),
        ("the cone on the far right", [("closest to", "right", ())]),
        ("the upper left cone", [("closest to", "corner", ("top", "left"))]),
        ("the cone on the bottom right", [("closest to", "corner", ("bottom", "right"))]),
        ("the cone in the southwest", [("closest to", "corner", ("bottom", "left"))]),
        ("the cone at the left end of the row", [("in", "row", ())]),
    ],
)
def test_sides_and_the_workspace_in_plain_words(
    text: str, modifiers: list[tuple[str, str | None, tuple[str, ...]]]
) -> None:
    assert plain(text) == modifiers


def test_a_table_that_is_there_is_meant_itself() -> None:
    assert plain("the cone on the left side of the table", "coffee table") == [("left of", "table", ())]


@pytest.mark.parametrize(
    ("text", "noun", "relations"),
    [
        ("walk until you see the window and then it's the plant closest to it", "plant", (("closest to", "window"),)),
        ("could you check whether the oven is off? the stove, by the sink.", "stove", (("by", "sink"),)),
        (
            "find a small cube; to the left of it there is a cylinder. that cylinder.",
            "cylinder",
            (("left of", "cube"),),
        ),
        ("pick up the cube. it is the red one", "cube", ()),
        ("man, glasses, no beard", "man", (("with", "glass"), ("without", "beard"))),
        ("lower right", None, (("on", "right"),)),
        ("center", None, (("in", "center"),)),
        ("right side", None, (("on", "right"),)),
        ("the left one of the chairs by the wall", "chair", (("by", "wall"),)),
    ],
)
def test_what_a_text_is_about(text: str, noun: str | None, relations: tuple[tuple[str, str], ...]) -> None:
    tree = default_parser().parse(text).tree
    assert tree is not None
    meant = target_phrase(tree)
    assert meant.phrase.noun == noun
    assert tuple((p.phrase.words[0], c.phrase.noun) for p in meant.children for c in p.children) == relations


def test_what_names_a_landmark_again_says_more_of_it() -> None:
    tree = default_parser().parse("the laptop on the desk. the desk near the door").tree
    assert tree is not None
    (place,) = target_phrase(tree).children
    (desk,) = place.children
    assert [child.phrase.words for child in desk.children] == [("near",)]
