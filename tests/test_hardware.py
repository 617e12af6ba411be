"""The paper's laboratory demonstration (Section IV-D), in physics and through the camera."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import pytest
from hydra import compose, initialize_config_dir

from dcg_torch.cli.config import register, settings_of
from dcg_torch.experiment.plan import trial_commands, trial_generators
from dcg_torch.experiment.recording.recorder import Recorder
from dcg_torch.experiment.trial import run_trial
from dcg_torch.language import Parser
from dcg_torch.model import GroundingModel, TrainingSet, Variant
from dcg_torch.settings import Settings
from dcg_torch.simulator import SimulatedRobot
from dcg_torch.storage.records import Iteration
from dcg_torch.storage.resources import resource
from dcg_torch.types import Object


@pytest.fixture(scope="module")
def settings() -> Settings:
    register()
    with initialize_config_dir(str(resource("conf")), version_base="1.3"):
        return settings_of(compose("config", overrides=["experiment=hardware"]))


@dataclass
class Demonstration:
    """The rows of the three commands, and what each look took the command to mean."""

    rows: list[Iteration]
    meant: list[list[Object]]

    def kinds(self, command: int) -> list[tuple[bool, bool]]:
        """(known, hypothetical) of what was meant, without repetitions."""
        return list(dict.fromkeys((thing.known, thing.hypothetical) for thing in self.meant[command]))


def demonstrate(settings: Settings, model: GroundingModel, parser: Parser, *, watched: bool = True) -> Demonstration:
    commands = trial_commands(settings, 0)
    with SimulatedRobot() as robot:
        recorder = Recorder(robot)
        robot.on_tick = recorder.tick if watched else None
        rows = run_trial(
            0,
            commands,
            model,
            parser.parse,
            robot,
            trial_generators(settings.seed, 0)[2],
            spin_step=math.radians(settings.simulator.spin_step),
            watch=recorder.look if watched else None,
        )
        for command, (row, _) in zip(commands, rows, strict=True):
            recorder.end(command, row)
    objects = [[look.solution.object for look in episode.looks] for episode in recorder.commands]
    return Demonstration([e.row for e in recorder.commands], [[o for o in of if o is not None] for of in objects])


@pytest.fixture(scope="module")
def shown(settings: Settings, training: TrainingSet, parser: Parser) -> Demonstration:
    return demonstrate(settings, GroundingModel.trained(training), parser)


def bearing(row: Iteration, id_: str) -> float:
    """From the robot's heading at the start to an object, in [0, 2 pi): how far it lies in a turn to the left."""
    (there,) = [o.position for o in row.objects if o.id == id_]
    return (math.atan2(there[1] - row.robot.y, there[0] - row.robot.x) - row.robot.yaw) % math.tau


def test_the_commands_are_the_papers_in_its_order(shown: Demonstration) -> None:
    said = [row.command for row in shown.rows]
    assert said == ["move towards the cone", "move towards the cube", "move towards the crate"]


def test_the_robot_faces_the_cone_and_the_others_are_behind_it(shown: Demonstration) -> None:
    for row in shown.rows:
        assert row.in_view == ("cone",)
        assert all(math.pi / 2 < bearing(row, id_) < 3 * math.pi / 2 for id_ in ("cube", "crate"))
    assert "cube" in shown.rows[0].known_types
    assert not {"traffic cone", "crate"} & set(shown.rows[0].known_types)


def test_every_command_ends_at_the_object_meant(shown: Demonstration) -> None:
    assert [row.grounded for row in shown.rows] == ["cone", "cube", "crate"]
    assert [row.target for row in shown.rows] == ["cone", "cube", "crate"]
    assert all(row.correct and row.arrived and row.collisions == 0 for row in shown.rows)


def test_the_cone_is_an_unknown_word_for_an_unknown_thing_in_view_and_needs_no_turning(shown: Demonstration) -> None:
    row = shown.rows[0]
    assert row.kind == "unknown"
    assert shown.kinds(0) == [(False, False)]
    assert len(shown.meant[0]) == 1
    assert row.turned < math.radians(20.0)  # it steers, but does not look round
    assert row.symbols == {"cone": "traffic cone"}


def test_the_cube_is_a_known_thing_unseen_and_then_seen(shown: Demonstration) -> None:
    row = shown.rows[1]
    assert row.kind == "known"
    assert shown.kinds(1) == [(True, True), (True, False)]
    assert shown.meant[1][0].type == "cube"
    assert row.turned > bearing(row, "cube") - math.radians(57.0) / 2 - math.radians(10.0)
    assert row.symbols == shown.rows[0].symbols


def test_the_crate_is_an_unknown_thing_unseen_and_then_seen_and_not_the_cone(shown: Demonstration) -> None:
    row = shown.rows[2]
    assert row.kind == "unknown"
    assert shown.kinds(2) == [(False, True), (False, False)]
    assert "cone" not in {thing.id for thing in shown.meant[2]}
    assert row.turned > bearing(row, "crate") - math.radians(57.0) / 2 - math.radians(10.0)
    assert row.turned > shown.rows[1].turned
    assert row.symbols == {"cone": "traffic cone", "crate": "crate"}


def test_a_robot_that_does_not_learn_takes_the_cone_for_the_crate(
    settings: Settings, training: TrainingSet, parser: Parser
) -> None:
    # so it was the learning that kept the crate from being grounded to the cone, as the paper argues
    forgetful = GroundingModel.trained(training, replace(Variant(), learns=False))
    assert [row.grounded for row in demonstrate(settings, forgetful, parser).rows] == ["cone", "cube", "cone"]


def test_watching_changes_nothing(
    settings: Settings, training: TrainingSet, parser: Parser, shown: Demonstration
) -> None:
    unwatched = demonstrate(settings, GroundingModel.trained(training), parser, watched=False)
    assert unwatched.rows == shown.rows
    assert unwatched.meant == [[], [], []]


def test_the_configuration_animates_it(settings: Settings) -> None:
    assert settings.animate == [0]
    assert Path(settings.worlds) == resource("worlds") / "hardware"
