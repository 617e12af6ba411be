"""The simulated robot in PyBullet: bodies, camera to percepts, turn, drive. The only room that imports pybullet."""

from dcg_torch.simulator import quiet  # noqa: F401  (before all that import pybullet)
from dcg_torch.simulator.base import add_robot
from dcg_torch.simulator.camera import Camera, Recogniser
from dcg_torch.simulator.client import Client, SimulatorError
from dcg_torch.simulator.robot import SimulatedRobot

__all__ = ["Camera", "Client", "Recogniser", "SimulatedRobot", "SimulatorError", "add_robot"]
