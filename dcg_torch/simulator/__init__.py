"""Simulated robots: one in PyBullet (bodies, camera to percepts, turn, drive), and `fake_robot`, one of pure geometry.

Only this room imports pybullet, and it does so when a name that needs it is first used: without PyBullet the fake robot
and the recogniser still work.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from dcg_torch.simulator.errors import SimulatorError
from dcg_torch.simulator.fake_robot import FakeRobot
from dcg_torch.simulator.recogniser import Recogniser

if TYPE_CHECKING:
    from dcg_torch.simulator.camera import Camera
    from dcg_torch.simulator.client import Client
    from dcg_torch.simulator.robot import SimulatedRobot

__all__ = ["Camera", "Client", "FakeRobot", "Recogniser", "SimulatedRobot", "SimulatorError"]

_PHYSICS = {"Camera": "camera", "Client": "client", "SimulatedRobot": "robot"}


def __getattr__(name: str) -> Any:
    """Load a name that needs PyBullet."""
    if name not in _PHYSICS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_PHYSICS[name]}"), name)
