"""What the simulated robot sees, and the mistakes of its recogniser, in physics."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from physics import HALF_VIEW, seen, world

from dcg_torch.agent.robot import SimulationRobot
from dcg_torch.simulator import Camera, Recogniser, SimulatedRobot
from dcg_torch.simulator.bodies import extent, footprint
from dcg_torch.types import Percept
from dcg_torch.world.generator import TYPES


def test_it_is_the_robot_that_algorithm_1_asks_for(shared: SimulatedRobot) -> None:
    robot: SimulationRobot = shared  # the type checker's half of the test
    shared.load(world(("a", "cube", 2.0, 0.0)))
    assert robot.perceive() == [Percept("a", "cube", "red", (2.0, 0.0, 0.0), extent("cube"))]


@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.5])
def test_behind_the_robot_nothing_is_perceived(shared: SimulatedRobot, yaw: float) -> None:
    ahead, behind = (
        ("ahead", "cube", 2.0 * math.cos(yaw), 2.0 * math.sin(yaw)),
        ("behind", "cube", -2.0 * math.cos(yaw), -2.0 * math.sin(yaw)),
    )
    assert seen(shared, world(ahead, behind, start=(0.0, 0.0, yaw))) == ["ahead"]


def test_behind_a_bigger_object_nothing_is_perceived(shared: SimulatedRobot) -> None:
    small, big = ("small", "drill", 4.0, 0.0), ("big", "sphere", 1.0, 0.0)
    assert seen(shared, world(small, big)) == ["big"]
    assert seen(shared, world(small)) == ["small"]


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("metres", [1.5, 4.0])
def test_the_view_ends_at_half_of_57_degrees(shared: SimulatedRobot, side: float, metres: float) -> None:
    # an object of radius r is cut by the edge of the view between these two bearings
    half_width = math.asin(footprint("sphere") / metres)
    for off, expected in ((-half_width, ["s"]), (half_width + math.radians(1.0), [])):
        angle = side * (HALF_VIEW + off)
        where = ("s", "sphere", metres * math.cos(angle), metres * math.sin(angle))
        assert seen(shared, world(where)) == expected


def test_a_small_object_is_seen_eight_metres_away(shared: SimulatedRobot) -> None:
    assert max(extent("cube")) == pytest.approx(0.3, abs=0.02)
    assert seen(shared, world(("c", "cube", 8.0, 0.0))) == ["c"]
    shared.recogniser = Recogniser(min_pixels=2000)
    try:
        assert seen(shared, world(("c", "cube", 8.0, 0.0))) == []
    finally:
        shared.recogniser = Recogniser()


def test_every_type_is_seen_near_and_far(shared: SimulatedRobot) -> None:
    for type_ in TYPES:
        for metres in (0.5, 1.2, 6.0):
            assert seen(shared, world(("o", type_, metres, 0.0))) == ["o"], (type_, metres)


def test_percepts_come_from_the_middle_of_the_view_outwards(shared: SimulatedRobot) -> None:
    there = world(("left", "cube", 3.0, 1.2), ("middle", "cube", 5.0, 0.1), ("right", "cube", 3.0, -0.8))
    assert seen(shared, there) == ["middle", "right", "left"]


def test_what_is_not_in_reach_shows_nothing_and_hides_nothing(shared: SimulatedRobot) -> None:
    rng, skipped = np.random.default_rng(0), 0
    for _ in range(40):
        kinds = rng.choice(TYPES, 6, replace=False).tolist()
        places = rng.uniform(-4.0, 4.0, (6, 2))
        places *= np.maximum(1.0, 1.2 / np.hypot(*places.T))[:, None]
        things = [
            (str(k), kind, float(x), float(y)) for k, (kind, (x, y)) in enumerate(zip(kinds, places, strict=True))
        ]
        shared.load(world(*things, start=(0.0, 0.0, float(rng.uniform(-3.1, 3.1)))))
        camera, pose, bodies = shared.camera, shared.pose, shared.bodies
        away = [bodies[id_] for id_, kind, *at in things if not camera.in_reach(pose, (at[0], at[1]), footprint(kind))]
        picture, mask = camera.view(pose).render(shared.client)
        shown = {body: int((mask == body).sum()) for body in bodies.values() if (mask == body).any()}
        assert camera.pixels(shared.client, pose) == camera.pixels(shared.client, pose, away) == shown
        assert (camera.view(pose).render(shared.client)[0] == picture).all()  # what was hidden is there again
        skipped += len(away)
    assert skipped > 100  # of 240


def test_a_drive_among_known_objects_takes_no_look(shared: SimulatedRobot, monkeypatch: pytest.MonkeyPatch) -> None:
    there = world(("goal", "cube", 2.0, 0.0), ("aside", "sphere", 2.0, 1.0), ("behind", "drill", -2.0, 0.0))
    shared.load(there)
    looks: list[object] = []
    pixels = Camera.pixels

    def counted(camera: Camera, *arguments: Any) -> dict[int, int]:
        looks.append(arguments)
        return pixels(camera, *arguments)

    monkeypatch.setattr(Camera, "pixels", counted)
    ahead = shared.perceive()
    assert [p.id for p in ahead] == ["goal", "aside"]
    assert shared.drive_to("goal", ahead)
    assert len(looks) == 1  # the perceiving: only what stands behind is not known
    shared.spin(math.pi)
    assert [p.id for p in shared.perceive()] == ["behind"]


def test_the_robot_is_not_in_its_own_picture(shared: SimulatedRobot) -> None:
    shared.load(world(("far", "cube", -3.0, 0.0)))
    for camera in (shared.camera, Camera(width=320, rows=180)):
        assert camera.pixels(shared.client, shared.pose) == {}


def test_pictures_show_the_object_on_its_side(shared: SimulatedRobot) -> None:
    shared.load(world(("left", "cube", 2.0, 0.5)))
    picture = shared.picture(width=200, height=100).astype(int)
    red = picture[:, :, 0] - picture[:, :, 1] > 60
    assert picture.shape == (100, 200, 3)
    assert red[:, :100].any()
    assert not red[:, 100:].any()


# mistakes of the recogniser


def test_mistakes_last_as_long_as_the_world() -> None:
    there = world(*((f"o{k}", "cube", 3.0 + k % 3, (k - 4) * 0.4) for k in range(9)))
    noisy = Recogniser(wrong_class=0.5, missed=0.2, types=("cube", "sphere", "drill"))
    with SimulatedRobot(recogniser=noisy, rng=np.random.default_rng(4)) as robot:
        robot.load(there)
        first = robot.perceive()
        robot.spin(0.2)
        robot.spin(-0.2)
        again = {percept.id: percept.type for percept in robot.perceive()}
        for percept in first:
            assert again.get(percept.id, percept.type) == percept.type
        assert {percept.type for percept in first} > {"cube"}
        assert len(first) < 9
        visits = {tuple(again.items())}
        for _ in range(5):
            robot.load(there)
            visits.add(tuple((percept.id, percept.type) for percept in robot.perceive()))
        assert len(visits) > 1


def test_mistakes_are_as_frequent_as_asked_and_even_over_the_other_types() -> None:
    types = ("cube", "sphere", "drill", "mailbox")
    labels = Recogniser(wrong_class=0.3, missed=0.1, types=types).labels(["cube"] * 4000, np.random.default_rng(0))
    share = {label: labels.count(label) / 4000 for label in (None, *types)}
    # within four standard errors (0.03 at most)
    assert share[None] == pytest.approx(0.1, abs=0.03)
    assert share["cube"] == pytest.approx(0.9 * 0.7, abs=0.03)
    for other in types[1:]:
        assert share[other] == pytest.approx(0.9 * 0.3 / 3, abs=0.03)


def test_the_perfect_recogniser_makes_no_mistakes() -> None:
    assert Recogniser().labels(["cube", "drill"], np.random.default_rng(0)) == ["cube", "drill"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"wrong_class": 1.5, "types": ("a", "b")}, "wrong_class is 1.5"),
        ({"missed": -0.1}, "missed is -0.1"),
        ({"wrong_class": 0.1}, "no wrong type"),
        ({"min_pixels": 0}, "min_pixels is 0"),
    ],
)
def test_impossible_recognisers_are_refused(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Recogniser(**arguments)  # type: ignore[arg-type]


def test_mistakes_need_a_generator() -> None:
    with pytest.raises(ValueError, match="rng"):
        SimulatedRobot(recogniser=Recogniser(missed=0.1))
