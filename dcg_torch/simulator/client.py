"""One physics server, owned by one object: connect, empty, step, close."""

from __future__ import annotations

import contextlib
import ctypes
import ctypes.util
import os
import sys
import time
from collections.abc import Iterable, Iterator
from typing import Protocol, Self

from dcg_torch.simulator.engine import pybullet
from dcg_torch.simulator.errors import SimulatorError
from dcg_torch.types import Pose

STEP = 1.0 / 60.0
"""Seconds of simulated time in one physics step."""

_PACE = 3.0  # times faster than real time that it may run with a window
_FLOOR_HALF = 25.0  # metres
_FLOOR_COLOR = (0.80, 0.79, 0.76)
Color = tuple[float, float, float, float]
"""Red, green, blue and opacity, each from 0 to 1."""


class Closing(Protocol):
    """What lets go of something: by `close`, or at the end of a `with` statement."""

    def close(self) -> None:
        """Let go; a second call does nothing."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Client(Closing):
    """A physics server of its own, so that several may live in one process without knowing each other.

    It is empty at first; `empty` lays a floor.

    Args:
        gui: open PyBullet's window (needs a screen); otherwise nothing is shown.
        options: of the window, as PyBullet takes them.

    Raises:
        SimulatorError: `gui` was asked for and there is no display.
    """

    def __init__(self, *, gui: bool = False, options: str = "") -> None:
        if gui:
            require_display()
        self.gui = gui
        self.id: int = pybullet.connect(pybullet.GUI, options=options) if gui else pybullet.connect(pybullet.DIRECT)
        if self.id < 0:
            raise SimulatorError("the physics server did not start; try again with simulator.gui=false")
        self.floor = -1
        self._looks: dict[int, list[tuple[int, Color]]] = {}

    def close(self) -> None:
        """Disconnect; a second call does nothing."""
        if self.id >= 0 and pybullet.isConnected(physicsClientId=self.id):
            pybullet.disconnect(physicsClientId=self.id)
        self.id = -1

    def empty(self) -> None:
        """Throw everything away and lay a new floor at z = 0.

        The whole simulation is made anew, not just its bodies removed: contact caches and body numbers would
        outlive their bodies, and a world's poses would depend on the worlds visited before it.
        """
        pybullet.resetSimulation(physicsClientId=self.id)
        self._looks = {}
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=STEP,
            numSubSteps=1,
            numSolverIterations=12,  # enough for wheels with the inertia that theirs have, see robot.urdf
            enableConeFriction=0,  # a pyramid takes a third of a step's time less
            deterministicOverlappingPairs=1,
            physicsClientId=self.id,
        )
        pybullet.setGravity(0.0, 0.0, -9.81, physicsClientId=self.id)
        thickness = 0.01
        self.floor = pybullet.createMultiBody(
            baseMass=0.0,
            baseCollisionShapeIndex=pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=self.id),
            baseVisualShapeIndex=pybullet.createVisualShape(
                pybullet.GEOM_BOX,
                halfExtents=[_FLOOR_HALF, _FLOOR_HALF, thickness],
                visualFramePosition=[0.0, 0.0, -thickness],
                rgbaColor=[*_FLOOR_COLOR, 1.0],
                specularColor=[0.0, 0.0, 0.0],
                physicsClientId=self.id,
            ),
            physicsClientId=self.id,
        )
        pybullet.changeDynamics(self.floor, -1, lateralFriction=1.0, physicsClientId=self.id)

    @contextlib.contextmanager
    def hidden(self, bodies: Iterable[int]) -> Iterator[None]:
        """Draw none of these, which saves most of a small picture's time; the physics doesn't notice."""
        if self.gui:  # it would flicker
            yield
            return
        colors = [(body, link, color) for body in bodies for link, color in self._colors(body)]
        self._paint((body, link, (*color[:3], 0.0)) for body, link, color in colors)
        try:
            yield
        finally:
            self._paint(colors)

    def _colors(self, body: int) -> list[tuple[int, Color]]:
        """What the parts of a body look like: (link, colour) of each."""
        if body not in self._looks:
            shapes = pybullet.getVisualShapeData(body, physicsClientId=self.id)
            self._looks[body] = [(shape[1], shape[7]) for shape in shapes]
        return self._looks[body]

    def _paint(self, colors: Iterable[tuple[int, int, Color]]) -> None:
        for body, link, color in colors:
            pybullet.changeVisualShape(body, link, rgbaColor=color, physicsClientId=self.id)

    def step(self, count: int = 1) -> None:
        """Advance the physics by `count` steps of `STEP` seconds."""
        for _ in range(count):
            pybullet.stepSimulation(physicsClientId=self.id)
        if self.gui:
            time.sleep(count * STEP / _PACE)

    def pose(self, body: int) -> Pose:
        """Where `body` stands on the floor, and its heading in (-pi, pi]."""
        position, orientation = pybullet.getBasePositionAndOrientation(body, physicsClientId=self.id)
        return Pose(position[0], position[1], pybullet.getEulerFromQuaternion(orientation)[2])

    def touching(self, body: int) -> set[int]:
        """The bodies in contact with `body`, the floor left out."""
        contacts = pybullet.getContactPoints(bodyA=body, physicsClientId=self.id)
        return {contact[2] for contact in contacts} - {self.floor, body}


def require_display() -> None:
    """See that there is a screen: PyBullet ends the whole process where it can't open its window.

    Raises:
        SimulatorError: there is none.
    """
    if not sys.platform.startswith("linux"):
        return
    advice = "run with simulator.gui=false, or on a machine with a screen (or under xvfb-run)"
    if not os.environ.get("DISPLAY"):
        raise SimulatorError(f"simulator.gui=true needs a screen, and DISPLAY is not set: {advice}")
    library = ctypes.util.find_library("X11")
    if library is None:
        raise SimulatorError(f"simulator.gui=true needs the X11 library, which is not installed: {advice}")
    x11 = ctypes.CDLL(library)
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XOpenDisplay.argtypes = [ctypes.c_char_p]
    x11.XCloseDisplay.argtypes = [ctypes.c_void_p]
    display = x11.XOpenDisplay(None)
    if not display:
        raise SimulatorError(f"simulator.gui=true can't open the display {os.environ['DISPLAY']!r}: {advice}")
    x11.XCloseDisplay(display)
