"""The world in 3-D: its objects, the robot with its field of view, and what the robot takes to be meant."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from urllib.parse import urlencode

from nicegui import ui
from nicegui.elements.scene import Object3D
from nicegui.events import SceneClickEventArguments, SceneDragEventArguments

from dcg_torch.apps.talk.looks import height_of, radius_of
from dcg_torch.types import Pose
from dcg_torch.world.files import World, WorldObject

BODIES = "/bodies"
_ROBOT = "/robot"  # no object's id has a slash; see live.js


class _Body(Object3D, component=Path(__file__).with_name("body.js")):
    """What `body.js` makes: a body from an address, with a name and rings of a radius, a height; or the floor."""


class _Live(ui.element, component=Path(__file__).with_name("live.js")):
    """The camera's picture; it keeps the robot and the marks of a scene up to date."""


def url_of(type_: str, color: str) -> str:
    """Where the page gets the looks of an object."""
    return f"{BODIES}?{urlencode({'type': type_, 'color': color})}"


class WorldView:
    """The 3-D scene of one page.

    Args:
        clicked: called with the id of an object that was clicked.
        dragged: called with the id and the new (x, y) of an object that was dragged.
    """

    def __init__(self, clicked: Callable[[str], None], dragged: Callable[[str, tuple[float, float]], None]) -> None:
        self._clicked, self._dragged = clicked, dragged
        self._things: dict[str, _Body] = {}
        self._by_hand = False
        self._fitted: str | None = None
        self._live: _Live | None = None
        self._scene = ui.scene(
            grid=False,  # its plane is shaded all over, which takes most of the time where no graphics card draws
            camera=ui.scene.perspective_camera(fov=35, near=0.05, far=120),
            on_click=self._on_click,
            click_events=["click"],
            on_drag_end=self._on_drag,
            drag_constraints="z=0",
            background_color="#e9e7e2",
            fps=60,
        )
        self._scene.classes("world").props('role=img aria-label="The world in 3-D; Objects lists what is in it"')
        with self._scene:
            _Body(None)
            _Body(BODIES).with_name(_ROBOT)

    def camera(self) -> None:
        """Make the picture of the robot's camera here."""
        self._live = _Live().props('alt="What the robot\'s camera shows"')
        self._live.props["view"] = self._scene.id

    def show_world(self, world: World) -> None:
        """Put every object where it is."""
        looks = {thing.id: (url_of(thing.type, thing.color), thing.type) for thing in world.objects}
        for id_, body in list(self._things.items()):
            if looks.get(id_) != tuple(body.args[:2]):
                self._things.pop(id_).delete()
        for item in world.objects:
            body = self._things.get(item.id) or self._make(item)
            body.move(*item.position).rotate(0.0, 0.0, item.yaw)
        if self._fitted != world.name:
            self._fitted = world.name
            self.look("overview", world)

    def point(self, object_id: str | None) -> None:
        """Ring what the visitor points at."""
        if self._live is not None:
            self._live.props["pointed"] = object_id

    def by_hand(self, on: bool) -> None:
        """Whether objects follow the mouse."""
        self._by_hand = on
        for body in self._things.values():
            body.draggable(on)

    def look(self, where: str, world: World, pose: Pose | None = None) -> None:
        """Move the view: "overview" from behind the start, "above", or from behind the "robot"."""
        if where == "robot" and pose is not None:
            x, y = math.cos(pose.yaw), math.sin(pose.yaw)
            eye = (pose.x - 2.2 * x, pose.y - 2.2 * y, 1.5)
            self._look(eye, (pose.x + 1.2 * x, pose.y + 1.2 * y, 0.2))
            return
        places = [thing.position for thing in world.objects] + [(world.robot.x, world.robot.y)]
        low, high = (tuple(f(place[k] for place in places) for k in (0, 1)) for f in (min, max))
        middle = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, 0.0)
        reach = max(1.5, math.dist(low, high) / 2) + 0.4
        down = math.radians(40.0 if where == "overview" else 88.0)
        far = 2.6 * reach
        back = far * math.cos(down)
        yaw = world.robot.yaw
        self._look((middle[0] - back * math.cos(yaw), middle[1] - back * math.sin(yaw), far * math.sin(down)), middle)

    def _look(self, eye: tuple[float, float, float], at: tuple[float, float, float]) -> None:
        x, y, z = eye
        self._scene.move_camera(x, y, z, look_at_x=at[0], look_at_y=at[1], look_at_z=at[2], duration=0.4)

    def _make(self, item: WorldObject) -> _Body:
        with self._scene:
            body = _Body(url_of(item.type, item.color), item.type, radius_of(item.type), height_of(item.type))
        self._things[item.id] = body.with_name(item.id).draggable(self._by_hand)
        return body

    def _on_click(self, event: SceneClickEventArguments) -> None:
        hit = next((hit.object_name for hit in event.hits if hit.object_name in self._things), None)
        if hit is not None and not self._by_hand:
            self._clicked(hit)

    def _on_drag(self, event: SceneDragEventArguments) -> None:
        if event.object_name in self._things:
            self._dragged(event.object_name, (event.x, event.y))
