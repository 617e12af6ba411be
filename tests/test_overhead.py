"""What is on, over and under things whose extents are known, and what is called by the room or the package it is in."""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch.names.weights import log_odds
from dcg_torch.types import Percept

Three = tuple[float, float, float]


def put(id_: str, type_: str, at: Three, size: Three, color: str | None = None) -> Percept:
    return Percept(id_, type_, color, at, size)


BOARD, TIN = (0.5, 2.0, 0.04), (0.1, 0.1, 0.16)


def tins(level: str, z: float, *places: float) -> list[Percept]:
    return [put(f"{level}{k}", "tin", (2.0 + 0.05 * (k % 2), y, z + 0.1), TIN) for k, y in enumerate(places)]


RACK = [  # three boards, tins on each of them
    *(put(f"board{k}", "shelf", (2.0, 0.0, 0.4 + 0.5 * k), BOARD) for k in range(3)),
    *tins("low", 0.4, 0.7, 0.1, -0.5),
    *tins("mid", 0.9, 0.5, -0.2),
    *tins("high", 1.4, 0.8, 0.2, -0.1, -0.8),
    put("bell", "bell", (2.03, 0.1, 0.98), TIN),
]
STUDIO = [  # two easels, one in the studio, with rooms as things
    put("studio", "studio", (2.0, 2.0, 1.2), (4.0, 4.0, 2.4)),
    put("garage", "garage", (8.0, 2.0, 1.2), (4.0, 4.0, 2.4)),
    put("fan1", "fan", (3.2, 1.0, 0.4), (0.4, 0.4, 0.8)),
    put("fan2", "fan", (9.0, 3.1, 0.4), (0.4, 0.4, 0.8)),
    put("bench", "bench", (8.0, 1.0, 0.4), (1.5, 0.5, 0.8)),
]
WALL = [  # what hangs over what: a clock over the stove's end, another far beside it
    put("stove", "stove", (4.0, 0.0, 0.45), (0.6, 0.6, 0.9)),
    put("near clock", "clock", (4.25, 0.1, 2.0), (0.1, 0.3, 0.3)),
    put("far clock", "clock", (4.0, 1.4, 1.2), (0.1, 0.3, 0.3)),
    put("low clock", "clock", (4.0, -0.9, 0.3), (0.1, 0.3, 0.3)),
    put("chair", "chair", (2.0, 1.0, 0.45), (0.5, 0.5, 0.9)),
]
PASSAGE = [  # a passage along x: niches on both sides, vials in colours on a cart
    *(put(f"left{k}", "niche", (2.0 + 2.0 * k, 1.2, 1.0), (0.5, 0.1, 1.0)) for k in range(3)),
    *(put(f"right{k}", "niche", (3.0 + 2.0 * k, -1.2, 1.0), (0.5, 0.1, 1.0)) for k in range(2)),
    put("left bell", "bell", (7.0, 1.1, 1.5), (0.2, 0.2, 0.2)),
    put("right bell", "bell", (1.5, -1.1, 1.5), (0.2, 0.2, 0.2)),
    *(put(f"{c} vial", "vial", (3.0 + 0.3 * k, 0.0, 0.9), (0.1, 0.1, 0.2), c) for k, c in enumerate(("green", "blue"))),
]
PILE = [  # trays on a trolley, two of them on one another, and bowls in two rows on a page before the viewer
    put("under", "tray", (1.0, 0.5, 0.81), (0.4, 0.3, 0.02)),
    put("upper", "tray", (1.02, 0.48, 0.835), (0.3, 0.3, 0.03)),
    put("alone", "tray", (1.3, -0.4, 0.81), (0.4, 0.3, 0.02)),
    put("trolley", "trolley", (1.2, 0.0, 0.4), (1.0, 1.6, 0.8)),
]
BOWLS = [
    *(put(f"front{k}", "bowl", (2.0, 0.9 - 0.6 * k, 0.4), (0.05, 0.4, 0.3)) for k in range(4)),
    *(put(f"rear{k}", "bowl", (2.0, 0.6 - 0.6 * k, 1.0), (0.05, 0.3, 0.2)) for k in range(3)),
    put("kettle", "kettle", (2.0, -1.2, 1.2), (0.05, 0.3, 0.5)),
]
JUGS = [put(f"jug{k}", "jug", (2.0, 1.2 - 0.6 * k, 0.1), (0.1, 0.1, 0.2)) for k in range(5)]


def meant(text: str, things: list[Percept]) -> tuple[list[str], float | None]:
    answer = grounded(text, things, looked=True)
    return [o.id for o in answer.objects], answer.probability


@pytest.mark.parametrize(
    ("text", "things", "ids"),
    [
        ("the second tin from the left on the top shelf", RACK, ["high1"]),
        ("the third tin from the left on the bottom shelf", RACK, ["low2"]),
        ("the leftmost tin on the middle shelf", RACK, ["mid0"]),
        ("the tin below the bell", RACK, ["low1"]),
        ("the tin right above the bell", RACK, ["high1"]),
        ("the clock above the stove", WALL, ["near clock"]),
        ("the bell on the left wall", PASSAGE, ["left bell"]),
        ("the bell on the right hand wall", PASSAGE, ["right bell"]),
        ("the vial with the blue liquid", PASSAGE, ["blue vial"]),
        ("the vial filled with green syrup", PASSAGE, ["green vial"]),
        ("the tray on top", PILE, ["upper"]),
        ("the top tray", PILE, ["upper"]),
        ("the garage fan", STUDIO, ["fan2"]),
        ("the jug next to the last one on the right", [*JUGS, *WALL], ["jug3"]),
    ],
)
def test_what_is_meant(text: str, things: list[Percept], ids: list[str]) -> None:
    found, probability = meant(text, things)
    assert found == ids
    assert (probability or 0.0) > 0.4


@pytest.mark.parametrize("words", ["in the back", "at the back", "at the top"])
def test_so_many_in_the_back_are_those_farthest_back(words: str) -> None:
    found, _ = meant(f"the three bowls {words}", BOWLS)
    assert sorted(found) == ["rear0", "rear1", "rear2"]


def test_what_is_on_one_board_is_not_on_the_next() -> None:
    answer = grounded("the tin on the top shelf", RACK, looked=True)
    others = max(p for id_, p in answer.probabilities.items() if id_.startswith(("low", "mid")))
    assert min(answer.probabilities[f"high{k}"] for k in range(4)) > 10.0 * others


@pytest.mark.parametrize(
    ("noun", "package", "other"),
    [
        ("paint", "red paint can", "red glue can"),
        ("pear juice", "Sunny pear juice carton", "Sunny plum juice carton"),
        ("oats", "Miller's oat box", "oat biscuit"),
        ("nails", "iron nail box", "iron nail file"),
    ],
)
def test_a_package_is_called_by_what_it_holds(noun: str, package: str, other: str) -> None:
    assert log_odds(noun, package) > max(2.0, log_odds(noun, other) + 2.0)


def test_what_is_called_so_itself_comes_before_its_package() -> None:
    assert log_odds("paint", "paint") > log_odds("paint", "red paint can") + 2.0
