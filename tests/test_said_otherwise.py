"""The same thing said in other words: distances, the other one, what is counted, taken back, left out, or no order.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import meant

from dcg_torch.language import default_parser
from dcg_torch.types import Percept

ROOM = (  # id, class, x, y, size
    ("j0", "jug", 1.4, 2.6, 0.3),
    ("j1", "jug", 3.0, 1.0, 0.5),
    ("j2", "jug", 3.2, -2.6, 0.2),
    ("pan", "pan", 3.0, 3.3, 0.4),
    ("tin", "tin", 3.0, -1.2, 0.25),
)
TWO = (("far", "jug", 4.0, -2.0, 0.3), ("near", "jug", 2.0, 1.9, 0.3), ("pan", "pan", 2.0, 2.9, 0.3))


def _meant(text: str, things: tuple[tuple[str, str, float, float, float], ...]) -> set[str]:
    percepts = [Percept(id_, kind, None, (x, y, 0.0), size=(size,) * 3) for id_, kind, x, y, size in things]
    return meant(text, percepts, looked=True)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("take the jug with the shortest distance to the pan", {"j0"}),
        ("the jug that has the longest distance from the pan", {"j2"}),
        ("whichever is nearer to the pan of the jugs", {"j0"}),
        ("if you count the jugs from the left, the second one", {"j1"}),
        ("between the pan and the tin there is a jug, take it", {"j1"}),
        ("the jug with the pan on one side and the tin on the other", {"j1"}),
        ("the pan plus the tin", {"pan", "tin"}),
        ("all but the biggest jug", {"j0", "j2"}),
        ("take all but the smallest jug", {"j0", "j1"}),
        ("leave the leftmost jug, take all the other jugs", {"j1", "j2"}),
        ("all jugs excluding the jug farthest to the right", {"j0", "j1"}),
        ("all the jugs except for the one on the far left", {"j1", "j2"}),
        ("go to jug number 2 from the right", {"j1"}),
        ("the jug number three from the left", {"j2"}),
        ("all but the pan", {"j0", "j1", "j2", "tin"}),
        ("the pan, or no, rather the tin", {"tin"}),
    ],
)
def test_in_a_room(text: str, meant: set[str]) -> None:
    assert _meant(text, ROOM) == meant


@pytest.mark.parametrize(
    "text",
    [
        "do not touch the jug next to the pan, take the other one",
        "there are two jugs. one of them is next to the pan. take the other one",
        "one of the jugs is beside the pan; I want the other",
        "the jug next to the pan is cracked, so bring me the other one",
    ],
)
def test_the_other_one(text: str) -> None:
    assert _meant(text, TWO) == {"far"}


@pytest.mark.parametrize(
    "text", ["that's the jug, isn't it?", "the jug is very nice", "the pan looks lovely", "I had a hard week at work"]
)
def test_what_orders_nothing(text: str) -> None:
    assert default_parser().parse(text).refused is not None


def test_what_is_left_out_is_one_of_those_that_are_meant() -> None:
    """Of "all red pegs except the leftmost" the leftmost red peg is left out, and not the leftmost of all."""
    pegs = [("0", "blue"), ("1", "red"), ("2", "red"), ("3", "green"), ("4", "red")]
    percepts = [Percept(id_, "peg", color, (3.0, 2.0 - int(id_), 0.0)) for id_, color in pegs]
    for text, ids in (
        ("all red pegs except the leftmost", {"2", "4"}),
        ("the red pegs other than the leftmost one", {"2", "4"}),
        ("every red peg but the rightmost one", {"1", "2"}),
    ):
        assert meant(text, percepts, looked=True) == ids
