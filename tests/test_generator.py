import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_worlds import generate_worlds, share_out_of_view, write_worlds

from dcg_torch.world.files import RobotStart, World, WorldObject, load_worlds
from dcg_torch.world.generator import COLORS, HALF_WIDTH, TYPES, generate_world

MANY_TYPES = [f"thing {k}" for k in range(40)]
MANY_COLORS = [f"tint {k}" for k in range(10)]


def feet(world: World) -> np.ndarray:
    return np.array([o.position for o in world.objects])


def least_gaps(world: World) -> tuple[float, float]:
    """Between any two objects, and between the robot and any object."""
    places = feet(world)
    between = np.linalg.norm(places[:, None] - places[None], axis=2) + np.where(np.eye(len(places)), np.inf, 0.0)
    return float(between.min()), float(np.linalg.norm(places - [world.robot.x, world.robot.y], axis=1).min())


@given(st.integers(0, 2**32), st.floats(0.02, 1.0))
@settings(max_examples=60, deadline=None)
def test_objects_keep_their_distance_and_stay_inside(seed: int, probability: float) -> None:
    world = generate_world(np.random.default_rng(seed), "w", probability=probability)
    between, robot = least_gaps(world)
    assert between >= 1.1
    assert robot >= 1.2
    assert abs(feet(world)).max() <= HALF_WIDTH
    assert max(abs(world.robot.x), abs(world.robot.y)) <= HALF_WIDTH / 2
    assert all(abs(yaw) <= math.pi + 1e-3 for yaw in (world.robot.yaw, *(o.yaw for o in world.objects)))


@given(st.integers(0, 2**32))
@settings(max_examples=30, deadline=None)
def test_one_of_each_type_and_colour_at_most_and_speaking_ids(seed: int) -> None:
    world = generate_world(np.random.default_rng(seed), "w")
    kinds = [(o.type, o.color) for o in world.objects]
    assert len(set(kinds)) == len(kinds) >= 1
    assert all(type in TYPES and color in COLORS for type, color in kinds)
    assert all(o.id == f"{o.color}_{o.type.replace(' ', '_')}" for o in world.objects)


@given(st.integers(0, 2**32))
@settings(max_examples=20, deadline=None)
def test_same_seed_same_world(seed: int) -> None:
    first, again = (generate_world(np.random.default_rng(seed), "w") for _ in range(2))
    assert first == again
    assert first != generate_world(np.random.default_rng(seed + 1), "w")


def test_how_many_and_which_objects() -> None:
    """Each of 24 with probability 0.15, given that the world is not empty."""
    worlds = [generate_world(np.random.default_rng(seed), "w") for seed in range(1500)]
    not_empty = 1 - 0.85**24
    counts = np.array([len(w.objects) for w in worlds])
    expected, square = 24 * 0.15 / not_empty, (24 * 0.15 * 0.85 + (24 * 0.15) ** 2) / not_empty
    assert counts.mean() == pytest.approx(expected, abs=4 * math.sqrt((square - expected**2) / len(worlds)))
    for type in TYPES:
        share = sum(o.type == type for w in worlds for o in w.objects) / len(worlds)
        assert share == pytest.approx(3 * 0.15 / not_empty, abs=4 * math.sqrt(3 * 0.15 * 0.85 / len(worlds)))


def test_a_view_of_57_degrees_misses_what_geometry_says() -> None:
    worlds = [generate_world(np.random.default_rng(seed), "w") for seed in range(1500)]
    objects = sum(len(w.objects) for w in worlds)
    # objects of one world are not independent; twice the binomial spread covers that
    spread = 2 * math.sqrt(0.842 * 0.158 / objects)
    assert share_out_of_view(worlds) == pytest.approx(1 - 57 / 360, abs=3 * spread)


def test_share_out_of_view_counts_by_bearing() -> None:
    def at(name: str, x: float, y: float) -> WorldObject:
        return WorldObject(id=name, type="cube", color="red", position=(x, y))

    ahead, edge, left, behind = at("a", -1, 0), at("b", -2, 1), at("c", 0, 3), at("d", 5, 0)
    world = World(name="w", robot=RobotStart(yaw=math.pi), objects=(ahead, edge, left, behind))
    assert share_out_of_view([world]) == 0.5  # the edge is 26.6 degrees from the middle
    assert share_out_of_view([world], view=math.radians(40)) == 0.75
    assert share_out_of_view([world], view=math.tau) == 0.0
    # seen from 3 m, a disc of radius 1.5 m reaches 30 degrees to either side
    assert share_out_of_view([world], view=math.radians(119)) == 0.5
    assert share_out_of_view([world], view=math.radians(119), radius=1.5) == 0.5
    assert share_out_of_view([world], view=math.radians(121), radius=1.5) == 0.25


@pytest.mark.parametrize("seed", range(20))
def test_all_24_objects_fit(seed: int) -> None:
    world = generate_world(np.random.default_rng(seed), "w", probability=1.0)
    assert len(world.objects) == 24
    assert abs(feet(world)).max() <= HALF_WIDTH


@pytest.mark.parametrize("probability", [0.15, 1.0])
def test_the_square_grows_for_many_types(probability: float) -> None:
    rng = np.random.default_rng(3)
    world = generate_world(rng, "w", types=MANY_TYPES, colors=MANY_COLORS, probability=probability)
    between, robot = least_gaps(world)
    assert between >= 1.1
    assert robot >= 1.2
    assert abs(feet(world)).max() > HALF_WIDTH


def test_what_does_not_fit_is_said() -> None:
    with pytest.raises(ValueError, match=r"24 objects .* half_width 1\.5 m") as caught:
        generate_world(np.random.default_rng(0), "w", probability=1.0, half_width=1.5)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"probability": 0.0}, "probability"),
        ({"probability": 1.5}, "probability"),
        ({"probability": float("nan")}, "probability"),
        ({"probability": 1e-9}, "no object at all"),
        ({"types": ()}, "at least one type"),
        ({"colors": ()}, "at least one type and one colour"),
        ({"half_width": 0.0}, "half_width"),
        ({"spacing": -1.0}, "spacing"),
        ({"types": ("cube", "cube")}, "more than once"),
    ],
)
def test_wrong_arguments(wrong: dict[str, object], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        generate_world(np.random.default_rng(0), "w", **wrong)  # type: ignore[arg-type]


def test_written_worlds_read_back_and_are_not_overwritten(tmp_path: Path) -> None:
    paths = write_worlds(tmp_path / "new", seed=5, count=3)
    assert [path.name for path in paths] == ["world_00.yaml", "world_01.yaml", "world_02.yaml"]
    assert load_worlds(tmp_path / "new") == generate_worlds(5, 3)
    assert "seed=5, count=3" in paths[0].read_text()
    paths[1].unlink()
    with pytest.raises(FileExistsError):
        write_worlds(tmp_path / "new", seed=6, count=3)
    assert load_worlds(tmp_path / "new")[0] == generate_worlds(5, 1)[0]
