"""The node's parameters: what they mean, and between which bounds they lie."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


def _option(
    default: Any, text: str, low: float | None = None, high: float | None = None, *, fixed: bool = False
) -> Any:
    return field(default=default, metadata={"help": text, "low": low, "high": high, "fixed": fixed})


@dataclass(frozen=True)
class Options:
    """Parameters of the node; those that are not `fixed` in their metadata may be set while it runs."""

    model: str = _option("shipped", "shipped, paper, or the folder of a saved model", fixed=True)
    state: str = _option("", "folder to save into after every lesson, and to go on from; empty: none", fixed=True)
    frame: str = _option("map", "world frame: of the pose, the goals and the percepts", fixed=True)
    robot_frame: str = _option("base_link", "frame of percepts that are relative to the robot", fixed=True)
    learn: bool = _option(True, "learn from the outcome of commands")
    ask: bool = _option(True, "ask back when unsure; the paper's model never asks")
    ask_below: float = _option(0.75, "ask if the best object is less probable", 0.0, 1.0)
    look_above: float = _option(0.03, "look on while types out of view have more than this share of belief", 0.0, 1.0)
    views: int = _option(2, "places driven to for a look behind things, at the most", 0, 100)
    spin_step: float = _option(20.0, "degrees between two looks of the paper's model, left positive", -57.0, 57.0)
    standoff: float = _option(0.6, "metres from an object's middle at which a drive to it ends", 0.1, 10.0)
    near: float = _option(0.15, "metres from a goal within which the robot has arrived", 0.01, 5.0)
    near_angle: float = _option(0.1, "radians from a goal's heading within which the robot has arrived", 0.01, 3.0)
    drive_timeout: float = _option(60.0, "seconds after which a drive is given up", 0.1, 3_600.0)
    look_timeout: float = _option(3.0, "seconds to wait for a pose or a look", 0.1, 600.0)
    answer_timeout: float = _option(30.0, "seconds to wait for the answer to a question", 0.1, 3_600.0)
    resend: float = _option(1.0, "seconds after which an unheeded goal or question is sent again", 0.02, 60.0)
    queue: int = _option(20, "commands and lessons that may wait", 1, 100_000)
    most_objects: int = _option(200, "objects of one look; the rest, which are less in view, are left out", 1, 10_000)
