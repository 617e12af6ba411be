"""What people say of scenes that nobody had in mind: names of rooms, states that are colours, absent landmarks.

Scenes and commands are ours.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

import pytest
from asked import grounded

from dcg_torch.grounding.solution import Solution
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept


def _ground(text: str, things: Sequence[Percept]) -> Solution:
    return grounded(text, things, looked=True, workspace=Workspace.of(things))


def _told(text: str, things: list[Percept]) -> list[str]:
    return [o.id for o in grounded(text, things).objects]


def _percept(id_: str, type_: str, color: str | None, x: float, y: float, *attributes: str, z: float = 0.0) -> Percept:
    return Percept(id_, type_, color, (x, y, z), attributes=frozenset(attributes))


@pytest.mark.parametrize("text", ["the opened zimlo crate", "bring me the zimlo crate"])
def test_a_word_of_a_class_name_is_no_strange_mark(text: str) -> None:
    things = [
        _percept("s1", "zimlo crate", None, 1.0, 0.5, "state: sealed"),
        _percept("s2", "zimlo crate", None, 1.0, 0.0, "state: opened"),
        _percept("j1", "jar", None, 1.2, -0.3, "filling: lentils"),
    ]
    found = grounded(text, things).tree
    assert found is not None
    assert not any("zimlo" in word for node in found.walk() for word in node.phrase.words)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("go to room 12", ["lab"]),
        ("drive to room 14", ["office"]),
        ("the stool in room 12", ["s1"]),
        ("go to room Turing", ["meeting"]),
    ],
)
def test_a_room_is_known_by_its_number(text: str, meant: list[str]) -> None:
    things = [
        _percept("lab", "laboratory", None, 5.0, 4.0, "number: 12"),
        _percept("office", "office", None, 5.0, -4.0, "number: 14"),
        _percept("meeting", "meeting room", None, 12.0, 4.0, "name: Turing"),
        _percept("other", "meeting room", None, 12.0, -4.0, "name: Hopper"),
        _percept("s1", "stool", "black", 5.3, 4.4),
        _percept("s2", "stool", "black", 11.8, 3.9),
    ]
    assert _told(text, things) == meant


@pytest.mark.parametrize(
    ("text", "meant"),
    [("press the amber button lamp", ["b1"]), ("the green signal", ["s2"]), ("the red wagon", ["w"])],
)
def test_a_colour_may_be_the_state_of_what_has_no_colour(text: str, meant: list[str]) -> None:
    things = [
        _percept("s1", "signal", None, 9.0, 2.0, "state: red"),
        _percept("s2", "signal", None, 9.0, -2.0, "state: green"),
        _percept("b1", "button lamp", None, 2.0, 1.0, "state: amber"),
        _percept("b2", "button lamp", None, 2.0, -1.0, "state: green"),
        _percept("w", "wagon", "red", 5.0, 0.0),
        _percept("w2", "wagon", "green", 5.0, 3.0),
    ]
    assert _told(text, things) == meant


def _strewn(seed: int) -> list[Percept]:
    """Four bolts close together and six strewn about them, on a table."""
    rng = random.Random(seed)
    middle, spots = (rng.uniform(0.6, 1.0), rng.uniform(-0.4, 0.4)), list[tuple[float, float]]()
    while len(spots) < 4:
        x, y = middle[0] + rng.uniform(-0.1, 0.1), middle[1] + rng.uniform(-0.1, 0.1)
        if all(math.dist((x, y), spot) > 0.06 for spot in spots):
            spots.append((x, y))
    while len(spots) < 10:
        x, y = rng.uniform(0.2, 1.6), rng.uniform(-1.0, 1.0)
        if all(math.dist((x, y), spot) > 0.25 for spot in spots):
            spots.append((x, y))
    return [_percept(f"{'near' if k < 4 else 'far'}{k}", "bolt", "black", x, y) for k, (x, y) in enumerate(spots)]


@pytest.mark.parametrize(
    "text", ["the group of four bolts", "take the cluster of four", "the bunch of four black bolts"]
)
def test_a_group_of_so_many_is_the_closest_so_many(text: str) -> None:
    right = 0
    for seed in range(12):
        things = _strewn(seed)
        meant = {o.id for o in _ground(text, things).objects}
        right += meant == {"near0", "near1", "near2", "near3"}
    assert right == 12


def _rack() -> list[Percept]:
    """Things on three shelves that are none themselves, before who looks."""
    rows = {
        1.6: ["vase", "drum", "candle"],
        1.0: ["clock", "candle", "radio", "vase"],
        0.4: ["basket", "drum", "radio"],
    }
    return [
        _percept(f"{kind}{int(10 * z)}", kind, None, 2.0, 0.8 - 0.5 * k - 0.1 * (z < 0.5), z=z)
        for z, kinds in rows.items()
        for k, kind in enumerate(kinds)
    ]


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("everything on the top shelf", {"vase16", "drum16", "candle16"}),
        ("the radio on the bottom shelf", {"radio4"}),
        ("the second thing from the left on the middle shelf", {"candle10"}),
        ("everything that is on the lowest tier", {"basket4", "drum4", "radio4"}),
    ],
)
def test_what_stands_at_heights_stands_on_shelves(text: str, meant: set[str]) -> None:
    assert {o.id for o in _ground(text, _rack()).objects} == meant


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the basket on the top shelf of the left cupboard", ["b2"]),
        ("the basket on the bottom shelf of the left cupboard", ["b1"]),
    ],
)
def test_a_shelf_of_a_thing_is_a_height_on_it(text: str, meant: list[str]) -> None:
    things = [
        Percept("left", "cupboard", None, (3.0, 2.0, 0.0), (0.6, 1.2, 2.0)),
        Percept("right", "cupboard", None, (3.0, -2.0, 0.0), (0.6, 1.2, 2.0)),
        _percept("b1", "basket", None, 3.0, 2.0, z=0.5),
        _percept("b2", "basket", None, 3.0, 2.0, z=1.5),
        _percept("b3", "basket", None, 3.0, -2.0, z=1.5),
        _percept("t", "trunk", None, 1.0, 0.0),
    ]
    assert _told(text, things) == meant


def _racks() -> list[Percept]:
    """Two racks with three shelves, which are no things; a jar in the middle of one."""
    things = [Percept(f"{side} rack", "rack", None, (3.0, y, 0.0), (0.5, 1.4, 1.9)) for side, y in _SIDES.items()]
    for side, y in _SIDES.items():
        for level, z in enumerate((0.1, 0.75, 1.4), 1):
            shift = 0.02 * level
            for color, at in (("red", (2.9 + shift, y + 0.4, z)), ("blue", (2.9 - shift, y - 0.4, z + 0.01))):
                things.append(Percept(f"{side} {color} {level}", "box", color, at, (0.3, 0.3, 0.25)))
    return [*things, Percept("jar", "jar", "green", (2.9, 1.2, 0.75), (0.15, 0.15, 0.2))]


_SIDES = {"left": 1.2, "right": -1.2}


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the red box on the top shelf of the left rack", {"left red 3"}),
        ("the boxes on the top shelf of the right rack", {"right red 3", "right blue 3"}),
        ("all red boxes on the middle shelf", {"left red 2", "right red 2"}),
        ("the red box on the second shelf from the bottom of the right rack", {"right red 2"}),
        ("the jar on the second shelf", {"jar"}),
        ("all blue boxes on the lowest shelf", {"left blue 1", "right blue 1"}),
        ("the top blue box on the right rack", {"right blue 3"}),
        ("the lower red box on the left rack", {"left red 1"}),
    ],
)
def test_shelves_are_heights_where_the_rack_is_there(text: str, meant: set[str]) -> None:
    assert {o.id for o in _ground(text, _racks()).objects} == meant


def test_in_the_middle_of_a_few_in_a_line_is_their_middle_one() -> None:
    things = [_percept(f"p{k}", "pot", "red", 1.2, 0.9 - 0.2 * k) for k in range(3)]
    things += [_percept(f"s{k}", "spade", "blue", 1.5, -0.2 - 0.3 * k) for k in range(4)]
    things += [_percept("q", "pot", "green", 0.9, -0.1)]
    assert [o.id for o in _ground("the red pot in the middle", things).objects] == ["p1"]
    assert [o.id for o in _ground("the pot in the middle", things[1:]).objects] != ["p0"]


@pytest.mark.parametrize(
    ("text", "meant"), [("the plate whose fork is on the left", "a"), ("the plate whose fork is on the right", "b")]
)
def test_whose_side_is_its_own(text: str, meant: str) -> None:
    things = [_percept("a", "plate", None, 1.0, -0.5), _percept("fa", "fork", None, 1.0, -0.3)]
    things += [_percept("b", "plate", None, 1.0, 0.5), _percept("fb", "fork", None, 1.0, 0.3)]
    assert _told(text, things) == [meant]


def _places(seed: int) -> list[Percept]:
    """Two desks apart, a stool at each, and one stool far from both."""
    rng = random.Random(seed)
    turn = rng.uniform(-0.6, 0.6)

    def at(id_: str, type_: str, x: float, y: float) -> Percept:
        spot = complex(x, y) * complex(math.cos(turn), math.sin(turn))
        return _percept(id_, type_, None, 4.0 + spot.real, spot.imag)

    stools = [at("one", "stool", -0.2, 2.8), at("two", "stool", 0.75, -2.0), at("alone", "stool", 0.3, 0.3)]
    return [at("d1", "desk", 0.0, 2.0), at("d2", "desk", 0.0, -2.0), *stools, at("p", "plant", 2.0, 1.0)]


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the stool that isn't near a desk", {"alone"}),
        ("take the stool that is not at a desk", {"alone"}),
        ("the stool away from the desks", {"alone"}),
        ("the stool far from a desk", {"alone"}),
        ("all stools at a desk", {"one", "two"}),
        ("the stools near the desks", {"one", "two"}),
    ],
)
def test_what_is_near_and_what_is_not_is_told_by_distance(text: str, meant: set[str]) -> None:
    right = 0
    for seed in range(8):
        right += set(_told(text, _places(seed))) == meant
    assert right == 8


def _beside(side: complex, seed: int) -> list[Percept]:
    """A clock, two tins on one side of it, one near and one farther off, and one on the other side."""
    rng = random.Random(seed)
    clock = complex(rng.uniform(0.9, 1.3), rng.uniform(-0.3, 0.3))

    def off(distance: float) -> complex:
        angle = rng.uniform(-0.25, 0.25)
        return clock + distance * side * complex(math.cos(angle), math.sin(angle))

    spots = {"near": off(0.22), "far": off(0.55), "other": off(-0.2)}
    tins = [_percept(name, "tin", None, spot.real, spot.imag) for name, spot in spots.items()]
    return [*tins, _percept("clock", "clock", None, clock.real, clock.imag), _percept("m", "map", None, 0.4, 0.9)]


@pytest.mark.parametrize(
    ("text", "side"),
    [("the tin left of the clock", 1j), ("the tin to the right of the clock", -1j), ("the tin behind the clock", 1)],
)
def test_the_nearest_on_a_side_of_a_thing_is_meant(text: str, side: complex) -> None:
    right = sum(_told(text, _beside(side, seed)) == ["near"] for seed in range(12))
    assert right >= 11


def test_the_farthest_on_a_side_is_one_of_all_that_are_there() -> None:
    right = sum(_told("take the farthest tin behind the clock", _beside(1, seed)) == ["far"] for seed in range(12))
    assert right >= 11


@pytest.mark.parametrize(
    ("text", "meant"), [("all but the red tins", {"t2"}), ("all but the red things", {"t2", "b2"})]
)
def test_what_is_left_out_by_its_colour_leaves_the_other_colours(text: str, meant: set[str]) -> None:
    spots = {
        "t0": ("tin", "red"),
        "t1": ("tin", "red"),
        "t2": ("tin", "blue"),
        "b1": ("bag", "red"),
        "b2": ("bag", "white"),
    }
    things = [_percept(id_, *of, 1.0 + 0.1 * k, 0.6 - 0.3 * k) for k, (id_, of) in enumerate(spots.items())]
    assert {o.id for o in _ground(text, things).objects} == meant
