"""What the shipped model takes a command to mean: short ways for tests that only ask it."""

from __future__ import annotations

import functools
from collections.abc import Iterable

from dcg_torch.model import GroundingModel
from dcg_torch.model.pretrain import pretrained
from dcg_torch.types import Percept, Pose

HERE = Pose(0.0, 0.0)


@functools.cache
def shipped() -> GroundingModel:
    """The shipped model, shared by all tests: look, don't teach."""
    return pretrained()


def meant(text: str, things: Iterable[Percept], *, looked: bool = False) -> set[str]:
    """The ids of what a command means, for a robot that stands at the origin and looks along x.

    Args:
        looked: has the robot looked all round?
    """
    return {o.id for o in shipped().ground(text, shipped().world_model(things, HERE, looked=looked)).objects}
