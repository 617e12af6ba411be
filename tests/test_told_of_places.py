"""Places that are counted from a thing, rows and columns of a board, and statements about what stands by a thing.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import meant, shipped, standing

from dcg_torch.language import default_parser, target_phrase
from dcg_torch.types import Percept, Pose

HALL = (  # id, class, colour, x, y
    ("p0", "stool", None, 1.5, 2.4),
    ("p1", "stool", None, 2.1, 0.9),
    ("p2", "stool", None, 1.7, -0.8),
    ("p3", "stool", None, 2.2, -2.6),
    ("stove", "stove", None, 1.2, 3.1),
    ("easel", "easel", None, 2.9, -2.9),
)
_SHADES = ("red", "blue", "green", "white"), ("blue", "orange", "red", "green"), ("green", "red", "white", "blue")
BOARD = tuple(
    (f"{r}{c}", "tile", shade, 1.6 - 0.3 * r, 0.45 - 0.3 * c)
    for r, row in enumerate(_SHADES, 1)
    for c, shade in enumerate(row, 1)
)


def _meant(text: str, things: tuple[tuple[str, str, str | None, float, float], ...]) -> set[str]:
    return meant(text, standing(*things), looked=True)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the second stool from the stove", "p1"),
        ("the third stool from the easel", "p1"),
        ("counting from the stove, the third stool", "p2"),
        ("starting at the easel, take the second stool", "p2"),
        ("the second stool, counting from the easel", "p2"),
        ("a stool, as long as it's not the one near the stove", "p3"),
        ("could the easel go by the stove?", "easel"),
        ("any chance you could get the easel?", "easel"),
    ],
)
def test_what_is_counted_from_a_thing(text: str, meant: str) -> None:
    assert _meant(text, HALL) == {meant}


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("third tile from the left in the top row", "13"),
        ("left tile of the bottom row", "31"),
        ("the tile in the second row from the top, third from the left", "23"),
        ("the tile in the rightmost column, second from the top", "24"),
        ("bottom row, right tile", "34"),
        ("the green tile in the same row as the orange tile", "24"),
        ("the red tile in the same column as the orange tile", "32"),
        ("the white tile diagonally next to the orange tile", "33"),
        ("find the orange tile and go one right", "23"),
    ],
)
def test_cells_of_a_board(text: str, meant: str) -> None:
    assert _meant(text, BOARD) == {meant}


@pytest.mark.parametrize(
    ("text", "noun"),
    [
        ("this is a stool. the stove is near it.", "stool"),
        ("the stool is blue. the stove is behind it", "stool"),
        ("there is a stool by the easel. the stove is near it as well.", "stool"),
        ("the stool beside the stove is the one. it is old.", "stool"),
        ("find the stove. the stool beside it is the one.", "stool"),
        ("you know the stove? next to it is the stool i need.", "stool"),
        ("the stove has a stool on its left. take that stool.", "stool"),
    ],
)
def test_what_a_text_is_about_where_it_tells_what_stands_by_it(text: str, noun: str) -> None:
    assert default_parser().parse(text).noun == noun


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the second kite from the right", "k2"),
        ("3rd kite from left", "k2"),
        ("the second to last kite from the left", "k2"),
        ("the penultimate kite from the right", "k1"),
        ("second kite from the left", "k1"),
    ],
)
def test_places_in_a_picture_are_counted_along_it_however_high_things_are(text: str, meant: str) -> None:
    kites = [("k0", 0.7, 0.9, 0.1), ("k1", 0.3, -0.7, 0.3), ("k2", -0.1, 0.8, 0.05), ("k3", -0.6, -0.2, 0.2)]
    percepts = [Percept(id_, "kite", None, (2.0, y, z), size=(0.0, size, size)) for id_, y, z, size in kites]
    world = shipped().world_model(percepts, Pose(0.0, 0.0), looked=True)
    assert [o.id for o in shipped().ground(text, world).objects] == [meant]


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the gate straight ahead", "front"),
        ("go to the gate ahead", "front"),
        ("the gate right in front", "front"),
        ("the closer gate to the well", "side"),
        ("the gate away from the others", "alone"),
        ("go to the gate away from all the other gates", "alone"),
        ("take the gate farthest from everything else", "alone"),
        ("move towards the gate ahead", "front"),
        ("bring me the gate ahead", "front"),
    ],
)
def test_what_is_ahead_and_what_is_closer(text: str, meant: str) -> None:
    things = [("front", "gate", 4.0, 0.2), ("side", "gate", 2.9, -1.1), ("alone", "gate", 2.0, 5.5)]
    things += [("well", "well", 2.0, -1.9), ("cart", "cart", 4.6, 1.0)]
    percepts = [Percept(id_, kind, None, (x, y, 0.0)) for id_, kind, x, y in things]
    world = shipped().world_model(percepts, Pose(0.0, 0.0), looked=True)
    assert [o.id for o in shipped().ground(text, world).objects] == [meant]


@pytest.mark.parametrize("verb", ["move", "push", "relocate", "haul"])
def test_a_goal_away_from_others_describes_nothing(verb: str) -> None:
    tree = default_parser().parse(f"{verb} the cube away from the others").tree
    assert tree is not None
    thing = target_phrase(tree).phrase
    assert (thing.noun, thing.words) == ("cube", ())


def test_where_a_thing_is_moved_describes_nothing() -> None:
    tree = default_parser().parse("move the cube left").tree
    assert tree is not None
    assert target_phrase(tree).phrase.words == ()


@pytest.mark.parametrize("text", ["the chairs at the far end of the table", "the glass at the far end of the table"])
def test_the_far_end_is_one_of_two(text: str) -> None:
    tree = default_parser().parse(text).tree
    assert tree is not None
    assert "outermost" not in target_phrase(tree).phrase.words
