"""A robot that is far away, for the tests of the ROS node's parts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from dcg_torch.apps.ros.options import Options
from dcg_torch.apps.ros.senses import Senses
from dcg_torch.types import DriveResult, Percept, Pose

CONE = Percept("cone", "traffic cone", "orange", (2.0, 0.0, 0.0))
CUBE = Percept("cube", "cube", "blue", (2.0, 1.5, 0.0))
SOON = Options(look_timeout=60.0, drive_timeout=0.3, resend=0.03, answer_timeout=0.3)


@dataclass
class Far:
    """A robot at the other end of a bad radio: it heeds each goal once, from the `heeds`-th sending on."""

    senses: Senses
    world: tuple[Percept, ...] = (CONE, CUBE)
    heeds: int = 1
    says: DriveResult | None = None
    sent: list[tuple[Pose, int]] = field(default_factory=list)
    on_goal: Callable[[], None] = lambda: None

    @classmethod
    def at_the_origin(cls) -> Far:
        """One that has just been seen there."""
        robot = cls(Senses())
        robot.stand_at(Pose(0.0, 0.0))
        return robot

    def send(self, goal: Pose, stamp: int) -> None:
        self.sent.append((goal, stamp))
        self.on_goal()
        if [s for _, s in self.sent].count(stamp) != self.heeds:
            return
        if self.says is not None:
            self.senses.put_result(stamp, self.says)
        else:
            self.stand_at(goal)

    def stand_at(self, pose: Pose) -> None:
        self.senses.put_pose(pose, 0)
        self.senses.put_look(self.world, 0)

    @property
    def goals(self) -> int:
        return len({stamp for _, stamp in self.sent})
