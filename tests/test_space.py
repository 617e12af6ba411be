"""Geometry as features: hand-placed scenes, and invariances over random ones."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch import space
from dcg_torch.symbols import Object, Pose, WorldModel

Point = tuple[float, float, float]


def thing(name: str, position: Point, kind: str = "cube", color: str = "red") -> Object:
    return Object(name, kind, known=True, color=color, position=position)


def values(objects: Sequence[Object], landmark: int, robot: Pose | None = None) -> list[dict[str, str]]:
    """For every object, the relation families that fire and their values."""
    found = space.relations(space.layout(WorldModel(tuple(objects), robot)), [[landmark]])
    out: list[dict[str, str]] = [{} for _ in objects]
    for family, table in found.items():
        for j, value in enumerate(table[0]):
            if value >= 0:
                out[j][family] = space.RELATIONS[family][value].split(", ")[1]
    return out


def test_a_block_on_another_covers_it() -> None:
    low, high, aside = thing("low", (0, 0, 0)), thing("high", (0, 0, 1)), thing("aside", (3, 0, 0))
    where = space.layout(WorldModel((low, high, aside)))
    states = space.states((low, high, aside), where)
    assert "state: covered" in states[0]
    assert "state: clear" in states[1]
    assert "state: on something" in states[1]
    assert {"state: clear", "state: on the floor", "state: alone"} <= set(states[2])
    assert values((low, high, aside), 0)[1]["vertical"] == "on top"
    assert values((low, high, aside), 1)[0]["vertical"] == "right under"


@pytest.mark.parametrize(
    ("position", "sector"),
    [
        ((2, 0, 0), "ahead"),
        ((0, 2, 0), "left"),
        ((-2, 0, 0), "behind"),
        ((0, -2, 0), "right"),
        ((2, 2, 0), "ahead left"),
    ],
)
def test_sides_are_the_robots(position: Point, sector: str) -> None:
    objects = (thing("landmark", (0, 0, 0)), thing("other", position))
    assert values(objects, 0, Pose(-5, 0, 0))[1]["side"] == f"side {sector}"


def test_behind_is_beyond_the_landmark_as_the_robot_sees_it() -> None:
    landmark, behind, before = thing("l", (3, 3, 0)), thing("b", (4, 4, 0)), thing("f", (2, 2, 0))
    found = values((landmark, behind, before), 0, Pose(0, 0, 0))
    assert found[1]["side seen"] == "side seen ahead"
    assert found[2]["side seen"] == "side seen behind"


def test_the_closest_of_its_kind_need_not_be_the_closest_of_all() -> None:
    objects = (
        thing("landmark", (0, 0, 0), "sphere"),
        thing("cone", (1, 0, 0), "cone"),
        thing("near", (2, 0, 0)),
        thing("far", (3, 0, 0)),
    )
    found = values(objects, 0)
    assert found[1]["closest of all"] == "closest 1 of all"
    assert found[2]["closest of all"] == "closest 2 of all"
    assert found[2]["closest of kind"] == "closest 1 of kind"
    assert found[3]["closest of kind"] == "closest 2 of kind"


def test_between_two_landmarks() -> None:
    objects = (thing("a", (0, 0, 0)), thing("b", (4, 0, 0)), thing("in", (2, 0.2, 0)), thing("out", (2, 3, 0)))
    found = space.relations(space.layout(WorldModel(objects)), [[0, 1]])["between"][0]
    assert found.tolist() == [-1, -1, 0, 1]


def test_ranks_name_the_leftmost_and_the_nearest() -> None:
    objects = (thing("left", (2, 1, 0)), thing("right", (1, -1, 0)), thing("blue", (3, 3, 0), color="blue"))
    names = space.ranks(objects, space.layout(WorldModel(objects, Pose(0, 0, 0))))
    assert "rank: left 1 of kind" in names[0]
    assert "rank: left 2 of type" in names[0]
    assert "rank: near 1 of all" in names[1]
    assert "rank: left 1 of all" in names[2]


def test_the_second_corner_of_a_workspace() -> None:
    found = {o.id: o for o in space.places((0.0, 8.0, -4.0, 4.0), Pose(0, 0, 0), Pose(1, 1))}
    assert found["place: far left corner"].position == (8.0, 4.0, 0.0)
    assert found["place: near right corner"].attributes == {"near side", "right side"}
    assert found["place: middle"].position == (4.0, 0.0, 0.0)
    assert {"place: robot", "place: speaker"} <= set(found)
    assert len(found) == 4 + 4 + 1 + 2
    assert space.places(None, None, None) == ()


def test_an_edge_is_as_near_as_its_nearest_point() -> None:
    block = thing("block", (8.0, 3.0, 0))
    world = WorldModel((block,), Pose(0, 0), None, space.places((0.0, 8.0, -4.0, 4.0), Pose(0, 0), None))
    far = next(j for j, o in enumerate(world.things) if o.id == "place: far edge")
    value = space.relations(space.layout(world), [[far]])["place distance"][0, 0]
    assert space.RELATIONS["place distance"][value].endswith(f"to {space.DISTANCES[0]:g} m")


coordinate = st.floats(-5, 5, allow_nan=False).map(lambda v: round(v, 2))
scene = st.lists(
    st.tuples(coordinate, coordinate, st.sampled_from(["cube", "cone"]), st.sampled_from(["red", "blue"])),
    min_size=2,
    max_size=6,
    unique_by=lambda t: t[:2],
)


@given(scene, st.integers(0, 3))
def test_turning_and_moving_the_whole_world_changes_nothing(
    rows: list[tuple[float, float, str, str]], quarter: int
) -> None:
    """Quarter turns, so that no rounding puts an offset on the other side of a bound."""
    c, s = round(math.cos(quarter * math.pi / 2)), round(math.sin(quarter * math.pi / 2))
    here = [thing(str(k), (x, y, 0), t, col) for k, (x, y, t, col) in enumerate(rows)]
    there = [thing(str(k), (c * x - s * y, s * x + c * y, 0), t, col) for k, (x, y, t, col) in enumerate(rows)]
    a = space.layout(WorldModel(tuple(here), Pose(-7, 0, 0)))
    b = space.layout(WorldModel(tuple(there), Pose(-7 * c, -7 * s, quarter * math.pi / 2)))
    np.testing.assert_allclose(a.position, b.position, atol=1e-9)
    assert space.states(here, a) == space.states(there, b)


@given(scene)
def test_every_family_fires_at_most_one_value_and_never_for_the_landmark(
    rows: list[tuple[float, float, str, str]],
) -> None:
    objects = tuple(thing(str(k), (x, y, 0), t, col) for k, (x, y, t, col) in enumerate(rows))
    for family, table in space.relations(space.layout(WorldModel(objects)), [[0]]).items():
        assert table.shape == (1, len(objects))
        assert table[0, 0] == -1
        assert table.max() < len(space.RELATIONS[family])


def test_a_hypothetical_object_fires_nothing() -> None:
    unseen = Object("unseen", "cube", known=True, hypothetical=True)
    objects = (thing("landmark", (0, 0, 0)), unseen)
    where = space.layout(WorldModel(objects))
    assert space.states(objects, where)[1] == []
    assert space.ranks(objects, where)[1] == []
    assert values(objects, 0)[1] == {}
