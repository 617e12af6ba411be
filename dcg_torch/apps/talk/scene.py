"""The world in 3-D: its objects, the robot with its field of view, and what the robot takes to be meant."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote

from nicegui import ui
from nicegui.events import SceneClickEventArguments, SceneDragEventArguments

from dcg_torch.apps.talk.looks import height_of, radius_of
from dcg_torch.types import Pose
from dcg_torch.types.geometry import FIELD_OF_VIEW
from dcg_torch.world.files import World, WorldObject

ROBOT_URL, FLOOR_URL = "/bodies/robot.glb", "/bodies/floor.glb"
_FAN = 4.0  # metres of the field of view that are drawn
_LABEL = "font:600 12px system-ui;text-shadow:0 0 3px #fff,0 0 3px #fff;white-space:nowrap;color:"
_SEEN, _UNSEEN = "#111827", "#8a8f98"
_MEANT, _POINTED, _VIEW = "#f59e0b", "#1d4ed8", "#4f8dff"
_FLOOR = "#e9e7e2"


def object_url(thing: WorldObject) -> str:
    """Where the page gets the looks of an object."""
    return f"/bodies/{quote(thing.type, safe='')}/{quote(thing.color, safe='')}.glb"


@dataclass
class _Thing:
    """An object in the scene: the group that holds all of it, and its marks on the floor."""

    looks: tuple[str, str]
    group: Any
    meant: Any
    pointed: Any
    label: Any
    seen: bool


class WorldView:
    """The 3-D scene of one page.

    Args:
        clicked: called with the id of an object that was clicked.
        dragged: called with the id and the new (x, y) of an object that was dragged.
    """

    def __init__(self, clicked: Callable[[str], None], dragged: Callable[[str, tuple[float, float]], None]) -> None:
        self._clicked, self._dragged = clicked, dragged
        self._things: dict[str, _Thing] = {}
        self._by_hand = False
        self._fitted: str | None = None
        self.scene = ui.scene(
            grid=False,  # its plane is shaded all over, which takes most of the time where no graphics card draws
            camera=ui.scene.perspective_camera(fov=35, near=0.05, far=120),
            on_click=self._on_click,
            click_events=["click"],
            on_drag_end=self._on_drag,
            drag_constraints="z=0",
            background_color=_FLOOR,
            fps=60,
        )
        self.scene.classes("world").props('role=img aria-label="The world in 3-D; Objects lists what is in it"')
        with self.scene:
            self.scene.gltf(FLOOR_URL)
        with self.scene, self.scene.group() as self._robot:
            self.scene.gltf(ROBOT_URL)
            edge = [FIELD_OF_VIEW * (k / 16 - 0.5) for k in range(17)]
            fan = [[0.0, 0.0], *([_FAN * math.cos(a), _FAN * math.sin(a)] for a in edge)]
            self.scene.extrusion(fan, 0.002).move(z=0.004).material(_VIEW, opacity=0.28)

    def show_world(self, world: World, seen: Collection[str]) -> None:
        """Put every object where it is; those that the robot has seen have a dark name."""
        there = {thing.id for thing in world.objects}
        for gone in [name for name in self._things if name not in there]:
            self._things.pop(gone).group.delete()
        for item in world.objects:
            thing = self._things.get(item.id)
            if thing is None or thing.looks != (item.type, item.color):
                if thing is not None:
                    thing.group.delete()
                thing = self._things[item.id] = self._make(item)
            thing.group.move(*item.position).rotate(0.0, 0.0, item.yaw)
            if thing.seen != (item.id in seen):
                self._name(thing, item, item.id in seen)
        if self._fitted != world.name:
            self._fitted = world.name
            self.look("overview", world)

    def show_pose(self, pose: Pose) -> None:
        """Put the robot there."""
        self._robot.move(pose.x, pose.y).rotate(0.0, 0.0, pose.yaw)

    def show_marks(self, probabilities: Mapping[str, float], pointed: str | None) -> None:
        """Ring what may be meant, the more strongly the more probable it is; and what the visitor points at."""
        for name, thing in self._things.items():
            share = round(probabilities.get(name, 0.0), 1)
            thing.meant.visible(share > 0.0)
            if share:
                thing.meant.material(_MEANT, opacity=0.1 + 0.9 * share)
            thing.pointed.visible(name == pointed)

    def by_hand(self, on: bool) -> None:
        """Whether objects follow the mouse."""
        self._by_hand = on
        for thing in self._things.values():
            thing.group.draggable(on)

    def look(self, where: str, world: World, pose: Pose | None = None) -> None:
        """Move the view: "overview" from behind the start, "above", or from behind the "robot"."""
        if where == "robot" and pose is not None:
            x, y = math.cos(pose.yaw), math.sin(pose.yaw)
            eye = (pose.x - 2.2 * x, pose.y - 2.2 * y, 1.5)
            self._camera(eye, (pose.x + 1.2 * x, pose.y + 1.2 * y, 0.2))
            return
        places = [thing.position for thing in world.objects] + [(world.robot.x, world.robot.y)]
        low, high = (tuple(f(place[k] for place in places) for k in (0, 1)) for f in (min, max))
        middle = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, 0.0)
        reach = max(1.5, math.dist(low, high) / 2) + 0.4
        down = math.radians(40.0 if where == "overview" else 88.0)
        far = 2.6 * reach
        back = far * math.cos(down)
        yaw = world.robot.yaw
        self._camera((middle[0] - back * math.cos(yaw), middle[1] - back * math.sin(yaw), far * math.sin(down)), middle)

    def _camera(self, eye: tuple[float, float, float], at: tuple[float, float, float]) -> None:
        x, y, z = eye
        self.scene.move_camera(x, y, z, look_at_x=at[0], look_at_y=at[1], look_at_z=at[2], duration=0.4)

    def _make(self, item: WorldObject) -> _Thing:
        radius = radius_of(item.type)
        with self.scene, self.scene.group().with_name(item.id) as group:
            self.scene.gltf(object_url(item)).with_name(item.id)
            meant = self.scene.ring(radius + 0.05, radius + 0.16, theta_segments=48).move(z=0.02).visible(False)
            pointed = self.scene.ring(radius + 0.18, radius + 0.24, theta_segments=48).move(z=0.02)
            pointed.material(_POINTED).visible(False)
            label = self.scene.text(item.type, _LABEL + _UNSEEN).move(z=height_of(item.type) + 0.16)
        group.draggable(self._by_hand)
        return _Thing((item.type, item.color), group, meant, pointed, label, False)

    def _name(self, thing: _Thing, item: WorldObject, seen: bool) -> None:
        thing.label.delete()
        with self.scene, thing.group:
            text = self.scene.text(item.type, _LABEL + (_SEEN if seen else _UNSEEN))
        thing.label, thing.seen = text.move(z=height_of(item.type) + 0.16), seen

    def _on_click(self, event: SceneClickEventArguments) -> None:
        hit = next((hit.object_name for hit in event.hits if hit.object_name in self._things), None)
        if hit is not None and not self._by_hand:
            self._clicked(hit)

    def _on_drag(self, event: SceneDragEventArguments) -> None:
        if event.object_name in self._things:
            self._dragged(event.object_name, (event.x, event.y))
