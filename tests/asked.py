"""What the shipped model takes a command to mean: short ways for tests that only ask it."""

from __future__ import annotations

import functools
from collections.abc import Iterable

from dcg_torch.grounding.solution import Solution
from dcg_torch.model import GroundingModel
from dcg_torch.model.pretrain import pretrained
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

HERE = Pose(0.0, 0.0)


@functools.cache
def shipped() -> GroundingModel:
    """The shipped model, shared by all tests: look, don't teach."""
    return pretrained()


def grounded(
    text: str,
    things: Iterable[Percept],
    robot: Pose | None = HERE,
    *,
    looked: bool = False,
    workspace: Workspace | None = None,
) -> Solution:
    """What a command comes to among things, for a robot that stands at the origin and looks along x.

    Args:
        robot: where it stands otherwise; None: nobody knows.
        looked: has it looked all round?
    """
    return shipped().ground(text, shipped().world_model(things, robot, looked=looked, workspace=workspace))


def standing(*things: tuple[str, str, str | None, float, float]) -> list[Percept]:
    """Percepts of an id, a class and a colour, so many metres ahead and to the left of where the robot starts."""
    return [Percept(id_, type_, color, (x, y, 0.0)) for id_, type_, color, x, y in things]


def seen(solution: Solution) -> set[str]:
    """The ids of the things that are meant, without those that are only supposed to be somewhere."""
    return {o.id for o in solution.objects if not o.hypothetical}


def meant(
    text: str,
    things: Iterable[Percept],
    robot: Pose | None = HERE,
    *,
    looked: bool = False,
    workspace: Workspace | None = None,
) -> set[str]:
    """The ids of what a command means; see `grounded`."""
    return seen(grounded(text, things, robot, looked=looked, workspace=workspace))
