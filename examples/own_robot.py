"""A robot of one's own takes commands and learns a word: no simulator, no world file, no ground truth.

Run it with `python examples/own_robot.py`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import dcg_torch
from dcg_torch.agent.command import carry_out
from dcg_torch.types import DriveResult, Percept, Pose

SHELF = (
    Percept("box-1", "cube", "red", (2.0, 0.5, 0.0)),
    Percept("ball-1", "sphere", "blue", (1.5, -0.4, 0.0)),
    Percept("pallet-7", "euro pallet", "brown", (-2.0, 0.3, 0.0)),  # behind it, and of a type it was never taught
)


class MyRobot:
    """Six members; they print what a real robot would do. It sees 90 degrees ahead."""

    def __init__(self) -> None:
        self.pose = Pose(0.0, 0.0, 0.0)

    def perceive(self) -> list[Percept]:
        """What is in view; a real robot asks its recogniser."""
        return [p for p in SHELF if abs(self._bearing(*p.position[:2])) < math.pi / 4]

    def spin(self, angle: float) -> None:
        """Turn left in place."""
        self.pose = Pose(self.pose.x, self.pose.y, self.pose.yaw + angle)

    def drive_to(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """To an object; a real robot stops before it, and goes round the others."""
        x, y = next(p.position[:2] for p in percepts if p.id == target)
        return self.go_to(x, y, percepts)

    def drive_away(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        """As far off again, the other way."""
        x, y = next(p.position[:2] for p in percepts if p.id == target)
        return self.go_to(2 * self.pose.x - x, 2 * self.pose.y - y, percepts)

    def go_to(self, x: float, y: float, percepts: Sequence[Percept]) -> DriveResult:
        """To a place."""
        print(f"  drives to ({x:.1f}, {y:.1f})")
        self.pose = Pose(x, y, self.pose.yaw + self._bearing(x, y))
        return DriveResult.ARRIVED

    def _bearing(self, x: float, y: float) -> float:
        return math.remainder(math.atan2(y - self.pose.y, x - self.pose.x) - self.pose.yaw, math.tau)


def main() -> None:
    """Three commands; the third uses a word that the second taught."""
    model = dcg_torch.GroundingModel.trained(dcg_torch.initial_training())
    for text in ("go to the red cube", "drive to the brown pallet", "go to the pallet"):
        robot = MyRobot()
        print(text)
        outcome = carry_out(text, model, robot, watch=lambda look: print(f"  looks from {look.pose.yaw:.2f} rad"))
        if outcome.solution is None or outcome.solution.object is None:
            print(f"  {outcome.parse.problem or 'nothing here is meant'}")
            continue
        print(f"  means {outcome.solution.object.id} with {outcome.solution.probability:.0%}")
        learned = model.learn(outcome.solution, outcome.experience(text))
        if learned.symbol is not None:
            print(f"  learns that {learned.symbol.word!r} names a {learned.symbol.type}")
        else:
            print(f"  nothing new: {learned.reason}")


if __name__ == "__main__":
    main()
