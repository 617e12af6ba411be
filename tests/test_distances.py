"""Distances in numbers: "within a meter of the door", "about two metres away". Written for this project."""

from __future__ import annotations

import math

import numpy as np
import pytest
from asked import meant

from dcg_torch.interpretation.distances import said_apart
from dcg_torch.types import Percept, Phrase, PhraseKind, Pose

AWAY = (0.5, 1.6, 3.2, 6.0)
"""Metres from the landmark, or the robot, of the things n0, n1, ..."""


def around(x: float, y: float, seed: int) -> list[Percept]:
    """A thing at each of the distances from a point, in a random direction of the half plane that is ahead."""
    rng = np.random.default_rng(seed)
    turns = rng.uniform(-1.2, 1.2, len(AWAY))
    at = [(x + r * math.cos(t), y + r * math.sin(t), 0.0) for r, t in zip(AWAY, turns, strict=True)]
    return [Percept(f"n{k}", "crate", None, place, (0.02,) * 3) for k, place in enumerate(at)]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    ("said", "which"),
    [
        *(
            (f"the crate {far} the barrel", ["n0"])
            for far in ("half a meter from", "within 1 m of", "closer than a metre to")
        ),
        *(
            (f"take the crate {far} the barrel", ["n1"])
            for far in ("about one and a half meters from", "160 cm away from")
        ),
        *(
            (f"the crate {far} the barrel", ["n2"])
            for far in ("roughly three meters from", "between two and four metres from")
        ),
        *((f"get the crate {far} the barrel", ["n3"]) for far in ("more than 5 meters away from", "over 15 feet from")),
        ("all crates within two meters of the barrel", ["n0", "n1"]),
        ("the crates that are not within two meters of the barrel", ["n2", "n3"]),
        ("the crates no more than 4 m from the barrel", ["n0", "n1", "n2"]),
    ],
)
def test_a_distance_in_numbers_tells_things_apart(said: str, which: list[str], seed: int) -> None:
    barrel = Percept("barrel", "barrel", None, (4.0, 1.0, 0.0), (0.02,) * 3)
    assert meant(said, [barrel, *around(4.0, 1.0, seed)], Pose(-1.0, -2.0)) == set(which)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    ("said", "which"),
    [
        ("the crate three meters away", ["n2"]),
        ("go to the crate half a meter in front of you", ["n0"]),
        ("the crate about 1.5 meters ahead", ["n1"]),
        ("the crates within two metres", ["n0", "n1"]),
        ("the crate more than four meters away.", ["n3"]),
    ],
)
def test_so_far_is_from_the_robot_where_no_landmark_is_named(said: str, which: list[str], seed: int) -> None:
    assert meant(said, around(0.0, 0.0, seed), Pose(0.0, 0.0)) == set(which)


def test_how_far_something_reaches_is_measured_from_its_edge() -> None:
    """A table of four metres has a thing beside its end two metres from its middle."""
    table = Percept("t", "table", None, (3.0, 0.0, 0.0), (1.0, 4.0, 0.7))
    near, far = (Percept(f"c{k}", "crate", None, (3.0, 2.2 + 2.0 * k, 0.0), (0.02,) * 3) for k in range(2))
    assert meant("the crate within half a meter of the table", [table, near, far], Pose(0.0, 0.0)) == {"c0"}
    assert meant("the crate two meters from the table", [table, near, far], Pose(0.0, 0.0)) == {"c1"}


@pytest.mark.parametrize("text", ["next to", "near", "two spaces left of", "from", "within", "one of"])
def test_what_states_no_length_is_no_distance(text: str) -> None:
    assert said_apart(Phrase(PhraseKind.PREPOSITION, text, ("near",))) is None


@pytest.mark.parametrize("yaw", [0.0, 1.0, -2.5])
@pytest.mark.parametrize(
    ("said", "hour"),
    [
        ("at your two o'clock", 2),
        ("at your 11 o'clock", 11),
        ("in the ten o'clock direction", 10),
        ("to your twelve o'clock", 12),
    ],
)
def test_an_hour_of_the_clock_is_a_direction_from_the_robot(said: str, hour: int, yaw: float) -> None:
    turned = {h: yaw - h * math.pi / 6.0 for h in (10, 11, 12, 1, 2, 3)}
    things = [
        Percept(f"h{h}", "crate", None, (1.0 + r * math.cos(t), 2.0 + r * math.sin(t), 0.0))
        for h, (t, r) in zip(turned, zip(turned.values(), (2.0, 3.0, 2.5, 3.5, 2.2, 3.1), strict=True), strict=True)
    ]
    assert meant(f"take the crate {said}", things, Pose(1.0, 2.0, yaw)) == {f"h{hour}"}
