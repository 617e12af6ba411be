"""What a trial looked like: the poses and the looks of every command, as plain values."""

from __future__ import annotations

from dataclasses import dataclass, field

from dcg_torch.agent.command import Look
from dcg_torch.agent.robot import Robot
from dcg_torch.storage.records import Iteration
from dcg_torch.types import Pose
from dcg_torch.world.speaker import Command


@dataclass(frozen=True)
class Moment:
    """A pose, and how many looks there had been by then; `looking` while it stands and looks."""

    pose: Pose
    looks: int
    looking: bool = False


@dataclass(frozen=True)
class RecordedCommand:
    """One command from its start to its end.

    Attributes:
        looks: in their order; none if the command made no sense.
        moments: one for every look, about ten for every simulated second of motion, and a last one.
        row: the record of the command, with the words that were known when it was over.
    """

    command: Command
    looks: tuple[Look, ...]
    moments: tuple[Moment, ...]
    row: Iteration


@dataclass
class Recorder:
    """Takes down a trial: `look` is a watcher for `experiment.trial.run_trial`, `tick` an observer of a moving robot.

    Attributes:
        robot: that carries the commands out.
        commands: the commands that are over.
    """

    robot: Robot
    commands: list[RecordedCommand] = field(default_factory=list)
    _looks: list[Look] = field(default_factory=list)
    _moments: list[Moment] = field(default_factory=list)

    def look(self, command: Command, look: Look) -> None:
        """Once more the robot has looked, and grounded the command."""
        self._looks.append(look)
        self._moments.append(Moment(look.pose, len(self._looks), looking=True))

    def tick(self, pose: Pose) -> None:
        """The robot is on its way."""
        self._moments.append(Moment(pose, len(self._looks)))

    def end(self, command: Command, row: Iteration) -> None:
        """The command is over, and the robot stands where it ended."""
        self._moments.append(Moment(self.robot.pose, len(self._looks)))
        self.commands.append(RecordedCommand(command, tuple(self._looks), tuple(self._moments), row))
        self._looks, self._moments = [], []
