"""What a visitor does to the world and to files by hand: add, move and take away objects; save, load, replay."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterator
from pathlib import Path

from nicegui import events, ui

from dcg_torch.apps.talk import files
from dcg_torch.apps.talk.host import Change, Host
from dcg_torch.dialogue.file import Input, Move
from dcg_torch.storage.errors import UserError
from dcg_torch.world.files import WorldObject
from dcg_torch.world.names import MORE_COLORS, MORE_TYPES


class Tools:
    """The two drawers of the page: objects, and files.

    Args:
        host: the conversation.
        by_hand: called with whether objects follow the mouse.
    """

    def __init__(self, host: Host, by_hand: Callable[[bool], None]) -> None:
        self._host = host
        self._chosen: WorldObject | None = None
        with ui.expansion("Objects").classes("card").props("dense"), ui.element("div").classes("tools"):
            self._objects(by_hand)
        with ui.expansion("Save, load, replay").classes("card").props("dense"), ui.element("div").classes("tools"):
            self._files()

    def choose(self, thing: WorldObject | None) -> None:
        """Show where an object is, which is now the one to be moved or taken away."""
        self._chosen = thing
        self._which.set_text(f"The {thing.color} {thing.type}:" if thing else "Point at an object to move it:")
        for button in self._changes:
            button.set_enabled(thing is not None)
        if thing is not None:
            for field, value in zip((self._x, self._y), thing.position, strict=True):
                field.set_value(value)
            self._yaw.set_value(round(math.degrees(thing.yaw)))

    def move(self, object_id: str, place: tuple[float, float], yaw: float | None = None) -> None:
        """Put an object elsewhere; where that is refused it goes back in the picture, too."""
        x, y = (round(value, 3) for value in place)
        self._host.do(Input(move=Move(id=object_id, position=(x, y), yaw=yaw)))

    def _objects(self, by_hand: Callable[[bool], None]) -> None:
        self._which = ui.label().classes("wide")
        self._x = ui.number("x, metres", value=1.0, step=0.1, format="%.2f")
        self._y = ui.number("y, metres", value=0.0, step=0.1, format="%.2f")
        self._yaw = ui.number("turned, degrees", value=0, step=15, format="%.0f")
        self._changes = [ui.button("Move", on_click=self._move), ui.button("Take away", on_click=self._remove)]
        ui.element("span")
        self._type = ui.select(list(MORE_TYPES), label="Type", value="cube")
        self._color = ui.select(list(MORE_COLORS), label="Colour", value="yellow")
        for button in (*self._changes, ui.button("Add", on_click=self._add)):
            button.props("outline dense no-caps")
        ui.switch("Drag objects in the picture", on_change=lambda event: by_hand(event.value)).classes("wide")
        for field in (self._x, self._y, self._yaw, self._type, self._color):
            field.props("outlined dense options-dense")
        self.choose(None)

    def _files(self) -> None:
        ui.label("Save:").classes("wide")
        for what in files.SAVED:
            button = ui.button(what, on_click=lambda what=what: self._save(what))
            button.props(f'outline dense no-caps aria-label="Save: {what}"')
        ui.button("Replay", on_click=self._host.replay).props("outline dense no-caps")
        ui.label("Load; what is there now is kept beside it:").classes("wide")
        for name, accepted, change in (
            ("world", ".yaml,.yml", files.with_world),
            ("model", ".zip", files.with_model),
            ("session", ".jsonl", files.with_session),
        ):
            upload = ui.upload(label=f"Load {name}", auto_upload=True, max_file_size=files.MOST)
            upload.on_upload(lambda event, upload=upload, change=change: self._load(event, upload, change))
            upload.props(f'accept="{accepted}" flat bordered').classes("wide")

    def _place(self) -> tuple[tuple[float, float], float]:
        x, y, yaw = (float(field.value or 0.0) for field in (self._x, self._y, self._yaw))
        return (x, y), math.radians(yaw)

    def _move(self) -> None:
        if self._chosen is not None:
            self.move(self._chosen.id, *self._place())

    def _remove(self) -> None:
        if self._chosen is not None:
            self._host.do(Input(remove=self._chosen.id))

    def _add(self) -> None:
        (x, y), yaw = self._place()
        type_, color = str(self._type.value), str(self._color.value)
        taken = self._host.state.names
        name = f"{color}_{type_}".replace(" ", "_")
        ids = (name if number == 1 else f"{name}_{number}" for number in range(1, len(taken) + 2))
        id_ = next(i for i in ids if i not in taken)
        self._host.do(Input(add=WorldObject(id=id_, type=type_, color=color, position=(x, y), yaw=yaw)))

    async def _save(self, what: str) -> None:
        with told():
            content = await self._host.ask(lambda session: files.saved(what, session, self._host.file))
            ui.download.content(content, files.SAVED[what][0])

    async def _load(
        self, event: events.UploadEventArguments, upload: ui.upload, change: Callable[[Path, bytes], Change]
    ) -> None:
        content = await event.file.read()
        upload.reset()
        with told():
            await self._host.exchange(change(self._host.file, content))


@contextlib.contextmanager
def told() -> Iterator[None]:
    """Tell the visitor if something can't be done."""
    try:
        yield
    except UserError as error:
        ui.notify(str(error), type="warning", multi_line=True)
