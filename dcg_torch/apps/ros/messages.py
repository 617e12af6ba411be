"""ROS messages to values and back. What makes no sense in a message is left out, and said.

A marker is one object: `text` is its class, `ns` and `id` name it, `pose` is its middle, `scale` its extents in metres,
and `color` what it looks like; without a colour if its alpha is 0.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Sequence

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import PoseStamped, Quaternion
from visualization_msgs.msg import Marker, MarkerArray

from dcg_torch.learning.lexicon import Entry
from dcg_torch.names.palette import color_log_likelihood
from dcg_torch.storage.untrusted_files import plain, shown
from dcg_torch.types import Percept, Pose
from dcg_torch.types.geometry import from_robot_frame
from dcg_torch.world.files import REACH_OF_A_WORLD

# The basic colour terms of English (Berlin and Kay 1969): finer ones are not what people say of things.
BASIC = ("black", "white", "red", "green", "yellow", "blue", "brown", "purple", "pink", "orange", "gray")
_LONGEST = 100  # characters of a class
_SECOND = 1_000_000_000


def to_stamp(time: Time) -> int:
    """A message's time as nanoseconds."""
    return int(time.sec) * _SECOND + int(time.nanosec)


def to_time(stamp: int) -> Time:
    """A stamp in nanoseconds as a message's time."""
    return Time(sec=stamp // _SECOND, nanosec=stamp % _SECOND)


def read_pose(message: PoseMessage) -> Pose:
    """Where something is on the floor, and its heading.

    Raises:
        ValueError: a number is not finite or beyond any world, or the quaternion is none.
    """
    at, turn = message.position, message.orientation
    values = (at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w)
    if not all(math.isfinite(v) for v in values) or max(abs(at.x), abs(at.y), abs(at.z)) > REACH_OF_A_WORLD:
        raise ValueError("a pose that is not finite, or beyond 1000 m")
    if math.hypot(turn.x, turn.y, turn.z, turn.w) < 0.5:
        raise ValueError("a pose whose orientation is no unit quaternion")
    sine = 2.0 * (turn.w * turn.z + turn.x * turn.y)
    return Pose(at.x, at.y, math.atan2(sine, 1.0 - 2.0 * (turn.y * turn.y + turn.z * turn.z)))


def pose_message(pose: Pose, frame: str, stamp: int) -> PoseStamped:
    """A pose as a message in a frame."""
    message = PoseStamped()
    message.header.frame_id, message.header.stamp = frame, to_time(stamp)
    message.pose.position.x, message.pose.position.y = float(pose.x), float(pose.y)
    message.pose.orientation = Quaternion(z=math.sin(pose.yaw / 2), w=math.cos(pose.yaw / 2))
    return message


def read_percepts(
    markers: Sequence[Marker], frame: str, robot_frame: str, robot: Pose | None, most: int
) -> tuple[tuple[Percept, ...], str]:
    """The objects of a look, the first `most` of them, and what was wrong with the last that was left out.

    Args:
        frame: of the world.
        robot_frame: of markers that are relative to the robot.
        robot: where it is; None: unknown, and such markers are left out.
    """
    found: dict[str, Percept] = {}
    objects = [marker for marker in markers if marker.action == Marker.ADD]
    wrong = "" if len(objects) <= most else f"a look at {len(objects)} objects, of which {most} are taken"
    for marker in objects[:most]:
        try:
            percept = _percept(marker, frame, robot_frame, robot)
        except ValueError as error:
            wrong = str(error)
        else:
            found.setdefault(percept.id, percept)
    return tuple(found.values()), wrong


def _percept(marker: Marker, frame: str, robot_frame: str, robot: Pose | None) -> Percept:
    type_, name = " ".join(marker.text.split()), plain(marker.ns, _LONGEST)
    if not type_ or len(type_) > _LONGEST:
        raise ValueError(f"a percept without a class, or with one longer than {_LONGEST} characters")
    at, scale = marker.pose.position, (marker.scale.x, marker.scale.y, marker.scale.z)
    place = (at.x, at.y, at.z - scale[2] / 2)
    if not all(abs(v) <= REACH_OF_A_WORLD for v in place) or not all(0.0 <= s <= REACH_OF_A_WORLD for s in scale):
        raise ValueError(f"a percept of {shown(type_)} whose place or size makes no sense")
    own = marker.header.frame_id.lstrip("/")
    if own == robot_frame and robot is not None:
        place = (*from_robot_frame(robot, at.x, at.y), place[2])
    elif own not in ("", frame):
        raise ValueError(f"a percept in the frame {shown(own)}, which is not {frame!r}")
    id_ = str(marker.id) if not name else name if marker.id == 0 else f"{name}/{marker.id}"
    look = marker.color
    seen = all(0.0 <= c <= 1.0 for c in (look.r, look.g, look.b)) and look.a > 0.0
    color = color_name(round(255 * look.r), round(255 * look.g), round(255 * look.b)) if seen else None
    return Percept(id_, type_, color, place, scale if all(scale) else None)


@functools.lru_cache(maxsize=4096)
def color_name(red: int, green: int, blue: int) -> str:
    """The basic colour term that fits a colour best; 0 to 255 each."""
    return max(BASIC, key=lambda word: color_log_likelihood(word, (red, green, blue)))


def percept_markers(
    percepts: Iterable[Percept], rgb: dict[str, tuple[float, float, float]], frame: str, stamp: int
) -> MarkerArray:
    """What a robot sees, as `read_percepts` reads it; `rgb` are the colours of objects by id, 0 to 1 each."""
    first = Marker(action=Marker.DELETEALL)  # so that a look at nothing has a stamp too
    first.header.frame_id, first.header.stamp = frame, to_time(stamp)
    markers = [first]
    for percept in percepts:
        marker = Marker(header=first.header, ns=percept.id, type=Marker.CUBE, text=percept.type)
        size = percept.size or (0.0, 0.0, 0.0)
        marker.scale.x, marker.scale.y, marker.scale.z = map(float, size)
        marker.pose.position.x, marker.pose.position.y = map(float, percept.position[:2])
        marker.pose.position.z = float(percept.position[2] + size[2] / 2)
        if percept.id in rgb:
            marker.color.r, marker.color.g, marker.color.b = rgb[percept.id]
            marker.color.a = 1.0
        markers.append(marker)
    return MarkerArray(markers=markers)


def lexicon_markers(entries: Iterable[Entry], percepts: Iterable[Percept], frame: str) -> MarkerArray:
    """Above each object the word that most probably names its type, for RViz; "?" where there is none."""
    names: dict[str, tuple[float, str]] = {}
    for entry in entries:
        for type_, probability in entry.types:
            names[type_] = max(names.get(type_, (0.0, "")), (probability, entry.word))
    markers = [Marker(action=Marker.DELETEALL)]
    for number, percept in enumerate(percepts):
        marker = Marker(ns="lexicon", id=number, type=Marker.TEXT_VIEW_FACING)
        marker.header.frame_id = frame
        probability, word = names.get(percept.type, (0.0, ""))
        marker.text = f"{word} {100 * probability:.0f} %" if word else "?"
        marker.pose.position.x, marker.pose.position.y = map(float, percept.position[:2])
        marker.pose.position.z = float(percept.position[2] + (percept.size[2] if percept.size else 0.0) + 0.2)
        marker.scale.z = 0.15
        marker.color.r = marker.color.g = marker.color.b = marker.color.a = 1.0
        markers.append(marker)
    return MarkerArray(markers=markers)


def lexicon_text(entries: Iterable[Entry]) -> str:
    """A word a line, with what it may mean."""
    meanings = ((e.word, ", ".join(f"{t} {100 * p:.0f} %" for t, p in e.types)) for e in entries)
    return "\n".join(f"{word}: {means or 'unknown'}" for word, means in meanings)
