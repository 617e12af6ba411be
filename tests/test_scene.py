"""Geometry as features: hand-placed scenes, and invariances over random ones."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch import scene
from dcg_torch.scene.workspace import with_places
from dcg_torch.types import Object, Pose, WorldModel

Point = tuple[float, float, float]


def thing(name: str, position: Point, kind: str = "cube", color: str = "red") -> Object:
    return Object(name, kind, known=True, color=color, position=position)


def values(
    objects: Sequence[Object], landmark: int, robot: Pose | None = None, among: str = "all"
) -> list[dict[str, str]]:
    """For every object, the relation families that fire and their values."""
    return fired(WorldModel(tuple(objects), robot), [landmark], among)


def fired(world: WorldModel, landmarks: Sequence[int], among: str = "all") -> list[dict[str, str]]:
    """For every thing, relation family -> value."""
    bag = scene.Relations(scene.layout(world)).to([landmarks], among)[:, 0].T
    names = [[scene.RELATION_NAMES[k].removeprefix("relation: ") for k in row if k >= 0] for row in bag]
    return [dict(name.split(", ") for name in row) for row in names]


def ranked(world: WorldModel, compared: Sequence[int] | None = None, **counted: int) -> list[set[str]]:
    """For every thing, the rank features that fire; `compared`: the numbers of those it is compared with."""
    members = None
    if compared is not None:
        members = np.isin(np.arange(len(world.things)), compared)
    bag = scene.ranks(scene.layout(world), members, **counted)
    return [{scene.RANKS[k].removeprefix("rank: ") for k in row if k >= 0} for row in bag]


def test_a_block_on_another_covers_it() -> None:
    low, high, aside = thing("low", (0, 0, 0)), thing("high", (0, 0, 1)), thing("aside", (3, 0, 0))
    states = scene.states(scene.layout(WorldModel((low, high, aside))))
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
    of_all, of_kind = values(objects, 0, among="all"), values(objects, 0, among="kind")
    assert [of_all[j]["closest"] for j in (1, 2)] == ["closest 1", "closest 2"]
    assert [of_kind[j]["closest"] for j in (1, 2, 3)] == ["closest 1", "closest 1", "closest 2"]
    assert [of_kind[j]["farthest"] for j in (2, 3)] == ["farthest 2", "farthest 1"]


def test_between_two_landmarks() -> None:
    objects = (thing("a", (0, 0, 0)), thing("b", (4, 0, 0)), thing("in", (2, 0.2, 0)), thing("out", (2, 3, 0)))
    found = [values.get("between") for values in fired(WorldModel(objects), [0, 1])]
    assert found == [None, None, "between", "not between"]


def test_ranks_name_the_leftmost_and_the_nearest() -> None:
    objects = (thing("left", (2, 1, 0)), thing("right", (1, -1, 0)), thing("blue", (3, 3, 0), color="blue"))
    world = WorldModel(objects, Pose(0, 0, 0))
    of_red = ranked(world, [0, 1])
    assert "left 1" in of_red[0]
    assert of_red[2] == set()  # what is not compared has no rank
    of_all = ranked(world)
    assert "left 2" in of_all[0]
    assert {"near 1", "robot 1"} <= of_all[1]
    assert "left 1" in of_all[2]


def test_ranks_count_as_far_as_the_phrase_does() -> None:
    world = WorldModel(tuple(thing(str(y), (2, y, 0)) for y in (5, 4, 3, 2, 1)), Pose(0, 0, 0))
    fourth = ranked(world, ordinal=4)
    assert [j for j, names in enumerate(fourth) if "left nth" in names] == [3]
    assert [j for j, names in enumerate(fourth) if "right nth" in names] == [1]
    two = ranked(world, count=2)
    assert [j for j, names in enumerate(two) if "right 1" in names] == [3, 4]
    assert [j for j, names in enumerate(two) if "right 2" in names] == [2]


def test_big_and_tall_are_measured() -> None:
    sizes = {"wide": (2.0, 2.0, 0.5), "tall": (0.5, 0.5, 3.0), "small": (0.5, 0.5, 0.5)}
    objects = tuple(Object(n, "cube", True, position=(2, k, 0), size=s) for k, (n, s) in enumerate(sizes.items()))
    wide, tall, small = ranked(WorldModel(objects, Pose(0, 0, 0)))
    assert "big 1" in wide
    assert "tall 1" in tall
    assert {"small 1", "short 1"} <= small
    assert "big 1" not in tall | small


def test_the_second_corner_of_a_workspace() -> None:
    found = {o.id: o for o in scene.places((0.0, 8.0, -4.0, 4.0), Pose(0, 0, 0), Pose(1, 1))}
    assert found["place: far side left side corner"].position == (8.0, 4.0, 0.0)
    assert found["place: near side right side corner"].attributes == {"near side", "right side"}
    assert found["place: middle"].position == (4.0, 0.0, 0.0)
    assert {"place: robot", "place: speaker", "place: ground"} <= set(found)
    assert sum(o.type == "direction" for o in found.values()) == 2 * 4
    assert [o.id for o in scene.places(None, None, None)] == ["place: ground"]


def test_an_edge_is_as_near_as_its_nearest_point() -> None:
    block = thing("block", (8.0, 3.0, 0))
    world = WorldModel((block,), Pose(0, 0), None, scene.places((0.0, 8.0, -4.0, 4.0), Pose(0, 0), None))
    found = fired(world, [number(world, "place: far side edge")])[0]
    assert found["place distance"] == "to 0.6"
    assert found["part"] == "in another part"  # the only block is the middle of all


def number(world: WorldModel, name: str) -> int:
    return next(j for j, o in enumerate(world.things) if o.id == name)


@pytest.mark.parametrize(
    ("side", "mine"),
    [("left", (2, 3, 0)), ("right", (2, -3, 0)), ("far", (5, 0, 0)), ("near", (-4, 0, 0))],
)
def test_whose_left_it_is(side: str, mine: Point) -> None:
    """Robot and speaker face each other over the objects: the left of one is the right of the other."""
    objects = (thing("mine", mine), thing("other", (4 - mine[0], -mine[1], 0)))
    robot, speaker = Pose(0, 0, 0), Pose(4, 0)
    world = WorldModel(objects, robot, speaker, scene.places(None, robot, speaker))
    yours = fired(world, [number(world, f"place: {side} side of robot direction")])
    assert yours[0]["direction"] in ("along", "rather along")
    assert yours[0]["closest"] == "closest 1"
    assert yours[1]["direction"] in ("aslant", "against")
    speakers = fired(world, [number(world, f"place: {side} side of speaker direction")])
    assert speakers[1]["closest"] == "closest 1"
    assert speakers[1]["direction"] in ("along", "rather along")


def test_on_the_floor_is_a_relation_to_the_ground() -> None:
    world = WorldModel((thing("low", (1, 1, 0)), thing("high", (1, 1, 1))), places=scene.places(None, None, None))
    low, high, _ = fired(world, [number(world, "place: ground")])
    assert (low["vertical"], high["vertical"]) == ("on top", "higher over")


def test_rows_stacks_and_clusters() -> None:
    row = [thing(f"row {k}", (3 + 0.5 * k, 2 * k, 0), "barrel") for k in range(4)]
    stack = [thing(f"stack {k}", (9, 0, k), color="blue" if k else "red") for k in range(3)]
    heap = [thing(f"heap {k}", (15 + x, y, 0), "cone") for k, (x, y) in enumerate([(0, 0), (1, 0.3), (0.4, 1.1)])]
    found = scene.groups([*row, *stack, *heap])
    by_members = {(next(iter(g.attributes & {"row", "stack", "cluster"})), frozenset(g.members)): g for g in found}
    barrels = by_members["row", frozenset(o.id for o in row)]
    assert barrels.attributes == {"row", "of 4", "lies across"}
    assert (barrels.type, barrels.color) == ("barrel", "red")
    tower = by_members["stack", frozenset(o.id for o in stack)]
    assert tower.attributes == {"stack", "of 3"}
    assert tower.color is None
    assert ("cluster", frozenset(o.id for o in heap)) in by_members


def test_a_row_is_one_step_apart_and_straight() -> None:
    assert not scene.groups([thing("a", (0, 0, 0)), thing("b", (0, 2, 0)), thing("c", (0, 7, 0))])
    bent = scene.groups([thing("a", (0, 0, 0)), thing("b", (0, 2, 0)), thing("c", (2, 2.5, 0))])
    assert all("row" not in g.attributes for g in bent)


def test_steps_of_a_row_may_be_uneven_and_it_lies_across_or_along() -> None:
    steps = (0.0, 1.0, 2.6, 3.5, 5.3)
    for axis, lies in ((1, "lies across"), (0, "lies along")):
        points = [(y, 0.05 * k, 0.0) if axis == 0 else (0.05 * k, y, 0.0) for k, y in enumerate(steps)]
        found = scene.groups([thing(str(k), p) for k, p in enumerate(points)], robot=Pose(-3.0, 0.0))
        rows = [g for g in found if "row" in g.attributes and len(g.members) == 5]
        assert [g.attributes for g in rows] == [{"row", "of 5", lies}]


def test_what_stands_apart_is_no_member() -> None:
    near = [
        thing(f"near {k}", (3.0 + x, y, 0.0)) for k, (x, y) in enumerate([(0, 0), (1, 0.2), (0.5, 0.9), (1.4, 1.1)])
    ]
    found = scene.groups([*near, thing("apart", (9.0, 5.0, 0.0))])
    assert {frozenset(g.members) for g in found if "cluster" in g.attributes} == {frozenset(o.id for o in near)}


def test_members_of_a_row_are_ranked_within_it() -> None:
    row = [thing(f"row {k}", (3, 2.0 * k, 0), "cone") for k in range(3)]
    objects = (*row, thing("apart", (3, 20, 0), "cone"))
    groups = scene.groups(row)
    world = WorldModel(objects, Pose(0, 0, 0), groups=groups)
    in_row, of_all = ranked(world, [0, 1, 2], ordinal=2), ranked(world, ordinal=2)
    assert [j for j, names in enumerate(in_row) if "left nth" in names] == [1]
    assert next(j for j, names in enumerate(of_all) if "left nth" in names) == 2  # of all cones it is another
    inside = fired(world, [len(objects)])
    assert [v.get("member") for v in inside[:4]] == ["member"] * 3 + ["no member"]
    assert [v.get("member place") for v in inside[:3]] == ["end member", "middle member", "end member"]


def test_lengths_are_measured_in_the_units_of_the_world() -> None:
    """A scene ten times as large with a unit ten times as long is the same scene."""
    points = [(1.0, 0.5), (2.0, -1.0), (1.5, 1.2)]
    small = WorldModel(tuple(thing(str(k), (x, y, 0)) for k, (x, y) in enumerate(points)))
    large = WorldModel(tuple(thing(str(k), (10 * x, 10 * y, 0)) for k, (x, y) in enumerate(points)), unit=10.0)
    assert fired(small, [0]) == fired(large, [0])
    assert scene.states(scene.layout(small)) == scene.states(scene.layout(large))


def test_where_things_stand_close_their_distance_is_the_unit() -> None:
    """On a table top "next to" is no metre; in a room that a robot drives about in it is what it was taught."""
    grid = [(1.0 + x, float(y), 0.0) for x in range(3) for y in range(3)]
    for apart, unit in ((0.05, 0.05), (0.45, 0.45), (0.6, 1.0), (2.0, 1.0)):
        objects = tuple(thing(str(k), (apart * x, apart * y, 0)) for k, (x, y, _) in enumerate(grid))
        assert with_places(WorldModel(objects, Pose(0, 0))).unit == pytest.approx(unit)
    for objects in ((), (thing("a", (1, 0, 0)),), (thing("a", (1, 0, 0)), thing("b", (1, 0, 0)))):
        assert with_places(WorldModel(objects, Pose(0, 0))).unit == 1.0  # nothing says how far they are apart


coordinate = st.floats(-5, 5, allow_nan=False).map(lambda v: round(v, 2))
cubes_at = st.lists(
    st.tuples(coordinate, coordinate, st.sampled_from(["cube", "cone"]), st.sampled_from(["red", "blue"])),
    min_size=2,
    max_size=6,
    unique_by=lambda t: t[:2],
)


@given(cubes_at, st.integers(0, 3))
def test_turning_and_moving_the_whole_world_changes_nothing(
    rows: list[tuple[float, float, str, str]], quarter: int
) -> None:
    """Quarter turns, so that no rounding puts an offset on the other side of a bound."""
    c, s = round(math.cos(quarter * math.pi / 2)), round(math.sin(quarter * math.pi / 2))
    here = [thing(str(k), (x, y, 0), t, col) for k, (x, y, t, col) in enumerate(rows)]
    there = [thing(str(k), (c * x - s * y, s * x + c * y, 0), t, col) for k, (x, y, t, col) in enumerate(rows)]
    a = scene.layout(WorldModel(tuple(here), Pose(-7, 0, 0)))
    b = scene.layout(WorldModel(tuple(there), Pose(-7 * c, -7 * s, quarter * math.pi / 2)))
    np.testing.assert_allclose(a.position, b.position, atol=1e-9)
    assert scene.states(a) == scene.states(b)


@given(cubes_at)
def test_every_family_fires_at_most_one_value_and_never_for_the_landmark(
    rows: list[tuple[float, float, str, str]],
) -> None:
    objects = tuple(thing(str(k), (x, y, 0), t, col) for k, (x, y, t, col) in enumerate(rows))
    bag = scene.Relations(scene.layout(WorldModel(objects))).to([[0]], "all").transpose(1, 2, 0)
    assert bag.shape == (1, len(objects), len(scene.RELATIONS))
    assert [scene.RELATION_NAMES[k] for k in bag[0, 0] if k >= 0] == ["relation: itself, itself"]
    for table, names in zip(bag[0].T, scene.RELATIONS.values(), strict=True):
        assert {scene.RELATION_NAMES[k] for k in table if k >= 0} <= set(names)


def test_a_hypothetical_object_fires_nothing() -> None:
    unseen = Object("unseen", "cube", known=True, hypothetical=True)
    objects = (thing("landmark", (0, 0, 0)), unseen)
    world = WorldModel(objects)
    assert list(scene.states(scene.layout(world))[1]) == []
    assert ranked(world)[1] == set()
    assert values(objects, 0)[1] == {}
