"""Recording, wording and drawing of a trial."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from dcg_torch.agent.command import Look
from dcg_torch.experiment.folder import ITERATIONS, animation_of
from dcg_torch.experiment.outcome import begin_drawing
from dcg_torch.experiment.recording import paint
from dcg_torch.experiment.recording.animation import SIZE, animate, frames, schedule
from dcg_torch.experiment.recording.floor import FloorPanel
from dcg_torch.experiment.recording.recorder import Moment, RecordedCommand, Recorder
from dcg_torch.experiment.recording.wording import bars, doing, label, meant, name_of, words
from dcg_torch.experiment.runner import run
from dcg_torch.grounding.hypotheses import Hypothesis
from dcg_torch.grounding.solution import Solution
from dcg_torch.settings import ModelSettings, Order, RobotKind, Settings, SettingsError, SimulatorSettings, check
from dcg_torch.simulator import Camera, FakeRobot, SimulatedRobot
from dcg_torch.simulator.stage import Stage
from dcg_torch.storage.records import Iteration, ObjectRecord, PoseRecord
from dcg_torch.storage.resources import resource
from dcg_torch.types import (
    Child,
    Correspondence,
    Grounding,
    GroundingKind,
    Object,
    ParseTree,
    Percept,
    Phrase,
    PhraseKind,
    Pose,
    WorldModel,
)
from dcg_torch.types.arrays import Bools
from dcg_torch.world.files import World, WorldObject
from dcg_torch.world.speaker import Command

THERE = World(
    name="there",
    objects=(
        WorldObject(id="cube", type="cube", color="red", position=(2.0, 0.0)),
        WorldObject(id="cone", type="traffic cone", color="green", position=(-2.0, 0.5)),
    ),
)
CUBE = Object("cube", "cube", known=True, color="red", position=(2.0, 0.0, 0.0))
CONE = Object("cone", "traffic cone", known=False, color="green", position=(-2.0, 0.5, 0.0))
UNSEEN_CUBE = Object("hypothetical cube", "cube", known=True, hypothetical=True)
UNSEEN = Object("hypothetical unknown", None, known=False, hypothetical=True)


def solution(chosen: Object | None, probabilities: dict[Object, float], inverted: bool = False) -> Solution:
    tree = ParseTree(Phrase(PhraseKind.VERB, "go", ("go",)))
    phi = Correspondence.INVERTED if inverted else Correspondence.ACTIVE
    best = Hypothesis(tree, Child(Grounding(GroundingKind.ACTION, chosen), phi), (), 0.0) if chosen else None
    return Solution(tree, WorldModel(tuple(probabilities)), best, {o.id: p for o, p in probabilities.items()})


def look(pose: Pose, seen: Sequence[Object], of: Solution) -> Look:
    percepts = [Percept(o.id, str(o.type), o.color, o.position or (0.0, 0.0, 0.0)) for o in seen]
    return Look(pose, tuple(percepts), of)


def record(**changes: object) -> Iteration:
    fields: dict[str, object] = {
        "trial": 0,
        "iteration": 0,
        "world": THERE.name,
        "command": "go to the cube",
        "noun": "cube",
        "color": None,
        "robot": PoseRecord(x=0.0, y=0.0, yaw=0.0),
        "objects": tuple(ObjectRecord(id=o.id, type=o.type, color=o.color, position=o.position) for o in THERE.objects),
        "in_view": ("cube",),
        "known_types": ("cube",),
        "target": "cube",
        "grounded": "cube",
        "correct": True,
        "kind": "known",
        "probability": 0.9,
        "asked": 0,
        "symbols": {},
        "path_length": 1.5,
        "turned": 0.0,
        "parsed": None,
        "seen": ("cube",),
        "chosen": "cube",
        "arrived": True,
        "collisions": 0,
        "expected_symbols": 1.0,
    }
    return Iteration.model_validate(fields | changes)


def recorded(looks: Sequence[Look], moments: Sequence[Moment], **changes: object) -> RecordedCommand:
    return RecordedCommand(
        Command(THERE, "go to the cube", "cube", None, "cube"), tuple(looks), tuple(moments), record(**changes)
    )


def found(**changes: object) -> RecordedCommand:
    """It looks for a cube behind it, turns, sees it, and drives there."""
    start, turned, there = Pose(0.0, 0.0, 3.0), Pose(0.0, 0.0, 0.1), Pose(1.5, 0.0, 0.0)
    looks = [
        look(start, [CONE], solution(UNSEEN_CUBE, {CONE: 0.1, UNSEEN_CUBE: 0.7, UNSEEN: 0.2})),
        look(turned, [CONE, CUBE], solution(CUBE, {CUBE: 0.9, CONE: 0.0, UNSEEN_CUBE: 0.1, UNSEEN: 0.0})),
    ]
    moments = [
        Moment(start, 1, looking=True),
        Moment(Pose(0.0, 0.0, 1.5), 1),
        Moment(turned, 2, looking=True),
        Moment(Pose(0.7, 0.0, 0.0), 2),
        Moment(there, 2),
    ]
    return recorded(looks, moments, **changes)


# wording


def test_things_are_named_as_the_robot_knows_them() -> None:
    assert name_of(CUBE) == "red cube"
    assert name_of(CONE) == "green traffic cone (unknown)"
    assert name_of(UNSEEN_CUBE) == "unseen cube"
    assert name_of(UNSEEN) == "unseen unknown thing"
    assert meant(solution(CUBE, {CUBE: 0.9, UNSEEN: 0.1})) == "red cube (90 %)"
    assert meant(solution(None, {})) == "nothing here"


def test_an_object_is_labelled_by_what_is_known_of_it_by_then() -> None:
    first, second = found().looks
    cube, cone = THERE.objects
    assert label(cube, None) == label(cube, first) == ("red cube\n(not seen yet)", False)
    assert label(cube, second) == ("red cube", True)
    assert label(cone, second) == ("green traffic cone\n(unknown)", True)


def test_what_goes_on_is_said_from_the_look_before() -> None:
    told = [doing(found(), at, {}) for at in range(5)]
    assert told[0] == told[1] == "It takes the command to mean a cube it has not seen yet, and turns to look for one."
    assert told[2] == told[3] == "It takes the command to mean the red cube, and drives there."
    assert told[4] == "It has arrived at the right object."


def test_it_looks_on_while_it_looks_on() -> None:
    """The word may mean what is in view, and the robot wants to see the rest first."""
    start, turned = Pose(0.0, 0.0, 0.0), Pose(0.0, 0.0, 1.0)
    sure = solution(CUBE, {CUBE: 0.8, UNSEEN: 0.2})
    looks = [look(start, [CUBE], sure), look(turned, [CUBE], sure)]
    moments = [Moment(start, 1, looking=True), Moment(turned, 1), Moment(turned, 2, looking=True), Moment(turned, 2)]
    them = recorded(looks, moments)
    told = [doing(them, at, {}) for at in range(3)]
    assert told[0] == told[1] == "It takes the command to mean the red cube, and looks on to be sure."
    assert told[2] == "It takes the command to mean the red cube, and drives there."


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"correct": False, "target": "cone"}, "another object was meant"),
        ({"chosen": None, "grounded": None, "arrived": None, "correct": False}, "full circle"),
        ({"arrived": False, "grounded": None, "correct": False}, "no way"),
        ({"symbols": {"block": "cube"}}, "now knows that “block” means cube"),
    ],
)
def test_how_it_ended_is_said(changes: dict[str, object], expected: str) -> None:
    assert expected in doing(found(**changes), 4, {})


def test_a_lesson_is_told_once() -> None:
    assert "block" not in doing(found(symbols={"block": "cube"}), 4, {"block": "cube"})


def test_a_command_without_sense_and_one_to_keep_away_are_said() -> None:
    nothing = recorded([], [Moment(Pose(0.0, 0.0), 0)], chosen=None, correct=False)
    assert "can't make sense" in doing(nothing, 0, {})
    away = look(Pose(0.0, 0.0), [CUBE], solution(CUBE, {CUBE: 1.0}, inverted=True))
    left = recorded([away], [Moment(away.pose, 1, looking=True), Moment(Pose(-1.0, 0.0), 1)], correct=False)
    assert "keeps away" in doing(left, 0, {})
    assert "left" in doing(left, 1, {})


def test_a_word_is_explained_where_it_is_not_the_type() -> None:
    assert words({"cone": "traffic cone", "drill": "drill"}) == ["“cone” = traffic cone", "“drill”"]


@given(st.lists(st.lists(st.floats(0.001, 1.0), min_size=12, max_size=12), min_size=1, max_size=4), st.integers(2, 15))
def test_the_chart_keeps_its_places_and_loses_no_probability(weights: list[list[float]], most: int) -> None:
    things = [Object(f"o{k}", f"type {k}", known=k % 2 == 0, hypothetical=k >= 7) for k in range(12)]
    looks = []
    for k, row in enumerate(weights):
        seen = {t: w for t, w in zip(things, row, strict=True) if t.hypothetical or t.id <= f"o{k}"}
        total = sum(seen.values())
        best = max(seen, key=lambda t: seen[t])
        looks.append(look(Pose(0.0, 0.0), [], solution(best, {t: w / total for t, w in seen.items()})))
    them = recorded(looks, [Moment(Pose(0.0, 0.0), 0)])
    charts = [bars(them, n, most) for n in range(len(looks) + 1)]
    assert len({tuple(bar.name for bar in chart) for chart in charts}) == 1
    assert len(charts[0]) <= most
    assert all(bar.probability is None for bar in charts[0])
    for n, chart in enumerate(charts[1:]):
        assert sum(bar.probability or 0.0 for bar in chart) == pytest.approx(1.0)
        chosen = looks[n].solution.object
        assert [bar.name for bar in chart if bar.chosen] in ([name_of(chosen)] if chosen else [], [])


# frames


@given(st.lists(st.booleans(), max_size=60))
def test_every_look_and_the_end_are_shown_in_order(looking: list[bool]) -> None:
    pose, moments, count = Pose(0.0, 0.0), [], 0
    for looks_now in [True, *looking]:
        count += looks_now
        moments.append(Moment(pose, count, looking=looks_now))
    moments.append(Moment(pose, count))
    one = look(pose, [], solution(UNSEEN, {UNSEEN: 1.0}))
    shots = schedule(3, recorded([one] * count, moments))
    at = [shot.moment for shot in shots]
    assert at == sorted(set(at))
    assert {k for k, moment in enumerate(moments) if moment.looking} | {len(moments) - 1} <= set(at)
    assert max(np.diff([0, *at])) <= 3
    assert {shot.command for shot in shots} == {3}
    assert all(shot.hold >= 100 for shot in shots)


def near(image: Image.Image, color: paint.RGB) -> Bools:
    difference = np.asarray(image, dtype=int) - np.array(color)
    return np.asarray(abs(difference).max(axis=2) < 12)


def test_the_fan_on_the_floor_is_where_the_robot_looks() -> None:
    turning = [Pose(0.0, 0.0, yaw) for yaw in (1.57, -1.57, 0.0)]
    one = look(turning[0], [], solution(UNSEEN, {UNSEEN: 1.0}))
    them = recorded([one], [Moment(pose, 1) for pose in turning])
    with Stage(THERE) as stage:
        panel = FloorPanel(stage, them, Camera(), (300, 240))
        pictures = [np.asarray(panel.draw(at), dtype=int) for at in range(3)]
    columns, rows = [], []
    for picture in pictures:
        blue = picture[:, :, 2] - picture[:, :, 0] > 25
        y, x = np.nonzero(blue)
        columns.append(x.mean())
        rows.append(y.mean())
    assert columns[0] < columns[2] - 20  # left is left of ahead
    assert columns[1] > columns[2] + 20
    assert rows[2] < min(rows[0], rows[1]) - 20  # ahead is up


def test_the_ring_is_on_the_chosen_object_and_tells_right_from_wrong() -> None:
    for changes, color in (({}, paint.RIGHT), ({"correct": False, "target": "cone"}, paint.WRONG)):
        them = found(**changes)
        with Stage(THERE) as stage:
            panel = FloorPanel(stage, them, Camera(), (300, 240))
            before, during, after = (panel.draw(at) for at in (1, 3, 4))
        # 40 pixels of the legend's colours could only come from a ring; the robot's own mark is smaller
        assert near(before, color).sum() < 40
        assert near(during, paint.CHOICE).sum() > 40 + near(after, paint.CHOICE).sum()
        assert near(after, color).sum() > 40


def test_a_part_of_a_view_is_cut_out_of_the_whole() -> None:
    with Stage(THERE) as stage:
        view = stage.overview((160, 120), 0.8)
        whole, bodies = view.render(stage.client)
        part, some = view.render(stage.client, (50, 30, 110, 100))
    assert part.shape == (70, 60, 3)
    assert (some == bodies[30:100, 50:110]).mean() > 0.995  # edges may fall on either side
    assert (abs(part.astype(int) - whole[30:100, 50:110]).max(axis=2) < 10).mean() > 0.98


def test_the_camera_shown_is_the_one_that_perceives() -> None:
    with SimulatedRobot() as robot, Stage(THERE) as stage:
        robot.load(THERE)
        for _ in range(9):
            view = robot.camera.view(robot.pose)
            stage.put(robot.pose)
            _, mask = view.render(stage.client)
            drawn = {id_: int((mask == body).sum()) for id_, body in stage.bodies.items()}
            counts = robot.camera.pixels(robot.client, robot.pose)
            for id_, body in robot.bodies.items():
                assert drawn[id_] == pytest.approx(counts.get(body, 0), abs=8)
            assert stage.robot not in mask
            robot.spin(0.7)


def test_every_shot_is_a_frame_of_one_size(tmp_path: Path) -> None:
    them = [found(), found(symbols={"block": "cube"})]
    shots = [shot for number, one in enumerate(them) for shot in schedule(number, one)]
    pictures = list(frames(them, shots, Camera()))
    assert {picture.size for picture in pictures} == {SIZE}
    path = animate(them, tmp_path / "new" / "a.gif")
    with Image.open(path) as image:
        assert image.size == SIZE
        assert getattr(image, "n_frames") == len(shots)  # noqa: B009  (only some formats have it)
        assert image.info["duration"] == shots[0].hold
        assert image.info["loop"] == 0
    assert [p.name for p in path.parent.iterdir()] == ["a.gif"]


def test_nothing_to_animate_is_said(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="nothing to animate"):
        animate([], tmp_path / "a.gif")


# recording


def test_the_recorder_keeps_the_commands_apart() -> None:
    robot = FakeRobot()
    robot.load(THERE)
    recorder = Recorder(robot)
    command = Command(THERE, "go to the cube", "cube", None, "cube")
    first, second = found().looks
    recorder.look(command, first)
    recorder.tick(Pose(0.0, 0.0, 2.0))
    recorder.end(command, record())
    recorder.look(command, second)
    recorder.end(command, record(iteration=1))
    one, two = recorder.commands
    assert one.looks == (first,)
    assert one.moments == (Moment(first.pose, 1, looking=True), Moment(Pose(0.0, 0.0, 2.0), 1), Moment(robot.pose, 1))
    assert two.looks == (second,)
    assert [moment.looks for moment in two.moments] == [1, 1]


def laboratory(**changes: object) -> Settings:
    settings = Settings(
        trials=1, iterations=1, worlds=str(resource("worlds") / "hardware"), order=Order.file, workers=1
    )
    for key, value in changes.items():
        setattr(settings, key, value)
    return settings


def test_watching_changes_no_byte_of_a_trial_and_can_be_asked_for_later(tmp_path: Path) -> None:
    run(laboratory(), tmp_path, lambda _: None)
    unwatched = (tmp_path / ITERATIONS).read_bytes()
    assert unwatched.count(b"\n") == 1
    assert not animation_of(tmp_path, 0).exists()
    run(laboratory(animate=[0]), tmp_path, lambda _: None)
    assert (tmp_path / ITERATIONS).read_bytes() == unwatched
    written = animation_of(tmp_path, 0).stat()
    assert 20_000 < written.st_size < 1_000_000
    run(laboratory(animate=[0]), tmp_path, lambda _: None)  # nothing is left to do
    assert animation_of(tmp_path, 0).stat().st_mtime_ns == written.st_mtime_ns


@pytest.mark.parametrize("changes", [{"animate": [0]}, {"simulator": {"gui": True}}])
def test_the_fake_robot_has_nothing_to_show(changes: dict[str, object]) -> None:
    shown = changes.get("simulator", {})
    simulator = SimulatorSettings(kind=RobotKind.fake, gui=bool(shown))
    settings = Settings(model=ModelSettings(), simulator=simulator, animate=[0] if "animate" in changes else [])
    with pytest.raises(SettingsError, match="fake robot has nothing to show") as error:
        check(settings)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("workers", [1, 2])
def test_a_picture_for_every_pair_needs_no_trial(tmp_path: Path, workers: int) -> None:
    settings = laboratory(trials=2, workers=workers, screenshots=True, figures=False)
    for _ in begin_drawing(settings, tmp_path):
        pass
    paths = {path.name: path for path in (tmp_path / "screenshots").iterdir()}
    assert paths.keys() == {f"laboratory-{id_}.png" for id_ in ("cone", "cube", "crate")}
    for path in paths.values():
        with Image.open(path) as image:
            assert image.size == (640, 480)
