"""Algorithm 1's loop over a robot of pure geometry: what it does, and what it leaves on record."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from making import KNOWN, Read, SpyRobot, read, world_file

from dcg_torch.agent.command import Look, Stopwatch, carry_out
from dcg_torch.experiment.folder import ITERATIONS
from dcg_torch.experiment.runner import run
from dcg_torch.experiment.trial import run_trial
from dcg_torch.language import Parser
from dcg_torch.model import GroundingModel
from dcg_torch.settings import RobotKind, Settings, SimulatorSettings, Speaker
from dcg_torch.simulator import FakeRobot
from dcg_torch.simulator.limits import ARRIVED
from dcg_torch.storage.records import Iteration, Timing
from dcg_torch.types import DriveResult, Pose
from dcg_torch.types.geometry import FIELD_OF_VIEW
from dcg_torch.world.files import RobotStart, World
from dcg_torch.world.speaker import Command

Pupil = Callable[[], GroundingModel]

# A red cube two metres ahead, a blue drill two metres behind, a green cube three metres to the left.
WORLD = world_file(("blue drill", -2.0, 0.0), ("red cube", 2.0, 0.0), ("green cube", 0.0, 3.0))
CONTRACT = """
    trial iteration world command noun color robot objects in_view known_types target grounded correct kind
    probability asked symbols path_length turned
    """


def trial(
    model: GroundingModel, parser: Parser, *commands: tuple[str, str, str], world: World = WORLD
) -> list[tuple[Iteration, Timing]]:
    """The rows of (text, noun, target) commands in one world."""
    given = [
        Command(world, text, noun, None, target, away=text.startswith("stay away")) for text, noun, target in commands
    ]
    return list(run_trial(7, given, model, parser.parse, FakeRobot(), np.random.default_rng(0)))


@pytest.fixture(scope="module")
def day(pupil: Pupil, parser: Parser) -> list[tuple[Iteration, Timing]]:
    return trial(
        pupil(),
        parser,
        ("go to the red cube", "cube", "red_cube"),
        ("find the drill", "drill", "blue_drill"),
        ("please go to the drill", "drill", "blue_drill"),
        ("go to the cube", "cube", "green_cube"),
        ("go to the sphere", "sphere", "red_cube"),
        ("turn around", "cube", "red_cube"),
        ("stay away from the red cube", "cube", "red_cube"),
    )


@pytest.fixture(scope="module")
def rows(day: list[tuple[Iteration, Timing]]) -> list[Iteration]:
    return [row for row, _ in day]


class TestRow:
    """Every field of a line of iterations.jsonl, on worlds whose answers are plain."""

    def test_known_and_in_view(self, rows: list[Iteration]) -> None:
        row = rows[0].model_dump(mode="json")
        probability = row.pop("probability")
        assert 0.5 < probability < 1.0
        assert row == {
            "trial": 7,
            "iteration": 0,
            "world": "made",
            "command": "go to the red cube",
            "noun": "cube",
            "color": None,
            "robot": {"x": 0.0, "y": 0.0, "yaw": 0.0},
            "objects": [
                {"id": "blue_drill", "type": "drill", "color": "blue", "position": [-2.0, 0.0]},
                {"id": "red_cube", "type": "cube", "color": "red", "position": [2.0, 0.0]},
                {"id": "green_cube", "type": "cube", "color": "green", "position": [0.0, 3.0]},
            ],
            "in_view": ["red_cube"],
            "known_types": list(KNOWN),
            "target": "red_cube",
            "grounded": "red_cube",
            "correct": True,
            "kind": "known",
            "asked": 0,
            "symbols": {},
            "path_length": 1.5,
            "turned": 0.0,
            "parsed": {"noun": "cube", "color": "red"},
            "seen": ["red_cube"],
            "chosen": "red_cube",
            "arrived": True,
            "collisions": 0,
            "expected_symbols": 3.0,
        }
        assert set(CONTRACT.split()) <= set(rows[0].model_dump())

    def test_unknown_and_behind(self, rows: list[Iteration]) -> None:
        """It turns left by 20 degrees at a time, and sees the drill when it looks along 160 degrees."""
        row = rows[1]
        assert (row.kind, row.grounded, row.chosen, row.correct) == ("unknown", "blue_drill", "blue_drill", True)
        assert row.turned == pytest.approx(math.pi)
        assert row.path_length == pytest.approx(1.5)
        assert row.in_view == ("red_cube",)
        assert row.seen == ("red_cube", "green_cube", "blue_drill")
        assert row.symbols == {"drill": "drill"}
        assert row.expected_symbols == 4.0
        assert row.known_types == KNOWN

    def test_learned(self, rows: list[Iteration]) -> None:
        row = rows[2]
        assert (row.kind, row.grounded, row.symbols) == ("learned", "blue_drill", {"drill": "drill"})
        assert row.expected_symbols == 4.0
        assert row.known_types == KNOWN

    def test_not_the_one_meant(self, rows: list[Iteration]) -> None:
        row = rows[3]
        assert (row.target, row.grounded, row.correct, row.arrived) == ("green_cube", "red_cube", False, True)

    def test_not_there(self, rows: list[Iteration]) -> None:
        """A full circle, then it stays where it is: a hypothetical grounding is not acted on."""
        row = rows[4]
        assert row.turned == pytest.approx(math.tau)
        assert row.path_length == 0.0
        assert (row.grounded, row.chosen, row.arrived, row.probability, row.correct) == (None, None, None, None, False)
        assert set(row.seen) == {"red_cube", "green_cube", "blue_drill"}

    def test_no_object_phrase(self, rows: list[Iteration]) -> None:
        before, row = rows[4:6]
        assert row.parsed is None
        assert (row.grounded, row.chosen, row.arrived, row.probability) == (None, None, None, None)
        assert (row.path_length, row.turned, row.correct) == (0.0, 0.0, False)
        assert row.symbols == before.symbols

    def test_keeping_away_is_not_going_there_and_is_right(self, rows: list[Iteration]) -> None:
        row = rows[6]
        assert (row.chosen, row.grounded, row.arrived, row.correct) == ("red_cube", None, True, True)
        assert row.path_length == pytest.approx(2.0)

    @pytest.mark.parametrize(
        ("text", "away", "correct"),
        [
            ("stay away from the red cube", True, True),
            ("stay away from the red cube", False, False),
            ("go to the red cube", True, False),
            ("go to the red cube", False, True),
        ],
    )
    def test_keeping_away_is_right_where_it_was_ordered(
        self, pupil: Pupil, parser: Parser, text: str, away: bool, correct: bool
    ) -> None:
        command = Command(WORLD, text, "cube", "red", "red_cube", away)
        ((row, _),) = run_trial(0, [command], pupil(), parser.parse, FakeRobot(), np.random.default_rng(0))
        assert (row.chosen, row.arrived, row.correct) == ("red_cube", True, correct)

    def test_counted_from_zero(self, rows: list[Iteration]) -> None:
        assert [(r.trial, r.iteration) for r in rows] == [(7, k) for k in range(7)]

    def test_a_row_is_read_back_as_it_was(self, rows: list[Iteration]) -> None:
        for row in rows:
            assert Iteration.model_validate_json(row.model_dump_json()) == row


class TestTiming:
    def test_what_took_time(self, day: list[tuple[Iteration, Timing]]) -> None:
        timings = [timing for _, timing in day]
        assert [(t.trial, t.iteration) for t in timings] == [(7, k) for k in range(7)]
        # Once where all is in view, again where a look shows something new, never where nothing is read.
        assert [min(t.groundings, 2) for t in timings] == [1, 2, 2, 1, 2, 0, 1]
        assert all(t.parse > 0 and t.perceive > 0 for t in timings)
        assert all(t.explore > 0 for t in timings if t.groundings > 1)
        assert all((t.drive > 0) == (row.arrived is not None) for row, t in day)
        assert all((t.ground > 0) == (t.groundings > 0) for t in timings)

    def test_what_was_trained(self, day: list[tuple[Iteration, Timing]]) -> None:
        columns = [(t.language_columns, t.grounding_columns) for _, t in day]
        assert columns[0] == (columns[1][0] - 1, columns[1][1] - 1)  # the word and the type of the drill
        assert len(set(columns[1:])) == 1
        rows = [t.train_rows for _, t in day]
        assert rows == sorted(rows)
        assert all(t.train_steps > 0 and t.train_loss > 0 and t.train > 0 for _, t in day[:5])

    def test_a_stopwatch_adds_up(self) -> None:
        clock = Stopwatch()
        for _ in range(3):
            with clock("look"):
                pass
        with pytest.raises(RuntimeError), clock("fail"):
            raise RuntimeError
        assert clock.counts == {"look": 3, "fail": 1}
        assert all(s > 0 for s in clock.seconds.values())


class TestCarryOut:
    def robot(self, world: World = WORLD) -> SpyRobot:
        robot = SpyRobot()
        robot.load(world)
        return robot

    @pytest.mark.parametrize("step", [10.0, 20.0, 45.0, 57.0, -20.0])
    def test_turning_ends_after_a_full_circle(self, trained: GroundingModel, step: float) -> None:
        robot = self.robot()
        outcome = carry_out("sphere", trained, robot, parse=read, spin_step=math.radians(step))
        assert robot.turned == pytest.approx(math.tau)
        assert robot.told == ["spin"] * math.ceil(360 / abs(step) - 1e-9)
        assert outcome.arrived is None
        assert outcome.solution is not None
        assert outcome.solution.object is not None
        assert outcome.solution.object.hypothetical

    def test_positive_steps_turn_left(self, trained: GroundingModel) -> None:
        world = world_file(("red cube", 0.0, 2.0), ("green cube", 0.0, -2.0))
        for step, name in ((20.0, "red_cube"), (-20.0, "green_cube")):
            robot = self.robot(world)
            carry_out("cube", trained, robot, parse=read, spin_step=math.radians(step))
            assert robot.told[-1] == f"drive to {name}"

    def test_the_first_one_seen_is_meant(self, trained: GroundingModel) -> None:
        """Between two unknown things, that which is nearer to the middle of the view."""
        world = world_file(("red mailbox", 2.0, 0.6), ("red drill", 2.0, 0.3))
        robot = self.robot(world)
        assert carry_out("gizmo", trained, robot, parse=read).in_view == ("red_drill", "red_mailbox")
        assert robot.told == ["drive to red_drill"]

    def test_what_was_seen_stays_known(self, trained: GroundingModel) -> None:
        """Turning away from a thing does not make it unseen."""
        robot = self.robot()
        outcome = carry_out("drill", trained, robot, parse=read)
        assert [p.id for p in outcome.percepts] == ["red_cube", "green_cube", "blue_drill"]
        assert outcome.solution is not None
        assert [o.id for o in outcome.solution.world.objects][:3] == ["red_cube", "green_cube", "blue_drill"]

    def test_the_watcher_sees_every_look(self, trained: GroundingModel) -> None:
        looks: list[Look] = []
        carry_out("drill", trained, self.robot(), parse=read, watch=looks.append)
        assert [round(math.degrees(look.pose.yaw)) % 360 for look in looks] == list(range(0, 161, 20))
        hypothetical = [o.hypothetical for look in looks if (o := look.solution.object) is not None]
        assert hypothetical == [True] * 8 + [False]
        sizes = [len(look.percepts) for look in looks]
        assert sizes == sorted(sizes)

    def test_no_tree_no_motion(self, trained: GroundingModel) -> None:
        robot = self.robot()
        outcome = carry_out("?", trained, robot, parse=lambda text, vocabulary: Read(None, "no object phrase found"))
        assert robot.told == []
        assert (outcome.solution, outcome.arrived) == (None, None)
        assert outcome.parse.problem == "no object phrase found"
        assert outcome.in_view == ("red_cube",)

    def test_a_drive_that_fails_is_no_grounding(self, pupil: Pupil) -> None:
        class Stuck(FakeRobot):
            def drive_to(self, *_: Any, **__: Any) -> DriveResult:
                return DriveResult.BLOCKED

        command = Command(WORLD, "red, cube", "cube", "red", "red_cube")
        ((row, _),) = run_trial(0, [command], pupil(), read, Stuck(), np.random.default_rng(0))
        assert (row.chosen, row.grounded, row.arrived, row.correct) == ("red_cube", None, False, False)


class TestFakeRobot:
    @given(
        x=st.floats(-4, 4),
        y=st.floats(-4, 4),
        yaw=st.floats(-math.pi, math.pi),
        ox=st.floats(-4, 4),
        oy=st.floats(-4, 4),
    )
    def test_it_ends_within_reach(self, x: float, y: float, yaw: float, ox: float, oy: float) -> None:
        world = world_file(("red cube", ox, oy)).model_copy(update={"robot": RobotStart(x=x, y=y, yaw=yaw)})
        robot = FakeRobot()
        robot.load(world)
        distance = math.dist((x, y), (ox, oy))
        seen = []
        for _ in range(36):
            seen += robot.perceive()
            robot.spin(math.radians(10))
        if distance > 1e-6:
            assert {p.id for p in seen} == {"red_cube"}
            assert robot.drive_to("red_cube", seen)
            assert math.dist((robot.pose.x, robot.pose.y), (ox, oy)) <= ARRIVED + 1e-9
            assert robot.path_length == pytest.approx(max(0.0, distance - ARRIVED))

    @given(bearing=st.floats(-math.pi, math.pi))
    def test_it_sees_57_degrees(self, bearing: float) -> None:
        robot = FakeRobot()
        robot.load(world_file(("red cube", 2 * math.cos(bearing), 2 * math.sin(bearing))))
        if abs(abs(bearing) - FIELD_OF_VIEW / 2) > 1e-9:
            assert bool(robot.perceive()) is (abs(bearing) < FIELD_OF_VIEW / 2)

    def test_loading_starts_anew(self) -> None:
        robot = FakeRobot()
        robot.load(WORLD)
        robot.spin(1.0)
        robot.spin(-1.0)
        robot.drive_to("red_cube", robot.perceive())
        robot.load(WORLD)
        assert (robot.pose, robot.turned, robot.path_length, robot.collisions) == (Pose(0, 0, 0), 0.0, 0.0, 0)

    def test_away_is_farther(self) -> None:
        robot = FakeRobot()
        robot.load(WORLD)
        assert robot.drive_away("red_cube", robot.perceive())
        assert math.dist((robot.pose.x, robot.pose.y), (2.0, 0.0)) == pytest.approx(4.0)

    def test_nowhere_yet(self) -> None:
        with pytest.raises(RuntimeError, match="load one first"):
            FakeRobot().perceive()


class TestSameSeedSameBytes:
    SETTINGS = Settings(
        simulator=SimulatorSettings(kind=RobotKind.fake),
        seed=3,
        trials=2,
        iterations=3,
        worlds="generated",
        speaker=Speaker.canonical,
        figures=False,
        tensorboard=False,
    )

    def bytes_of(self, directory: Path, **changes: Any) -> bytes:
        rows: list[Iteration] = []
        run(Settings(**{**vars(self.SETTINGS), **changes}), directory, rows.extend)
        text = (directory / ITERATIONS).read_bytes()
        assert [(r.trial, r.iteration) for r in rows] == [(t, k) for t in range(2) for k in range(3)]
        assert [json.loads(line) for line in text.splitlines()] == [r.model_dump(mode="json") for r in rows]
        return text

    @pytest.mark.slow
    def test_for_any_number_of_workers(self, tmp_path: Path) -> None:
        one = self.bytes_of(tmp_path / "one", workers=1)
        assert self.bytes_of(tmp_path / "again", workers=1) == one
        assert self.bytes_of(tmp_path / "two", workers=2) == one
        assert self.bytes_of(tmp_path / "other", workers=1, seed=4) != one

    def test_trials_differ(self, tmp_path: Path) -> None:
        lines = [json.loads(line) for line in self.bytes_of(tmp_path, workers=1).splitlines()]
        assert [r["objects"] for r in lines[:3]] != [r["objects"] for r in lines[3:]]
