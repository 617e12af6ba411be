"""The page: one instance for each visitor, all of the same conversation."""

from __future__ import annotations

from pathlib import Path

from nicegui import events, ui

from dcg_torch.apps.talk.host import Host
from dcg_torch.apps.talk.lines import Line
from dcg_torch.apps.talk.panels import candidates_table, words_table
from dcg_torch.apps.talk.scene import WorldView
from dcg_torch.apps.talk.tools import Tools, told
from dcg_torch.dialogue.file import Input
from dcg_torch.world.files import World

CSS = Path(__file__).with_name("page.css")
_SHOWN = 200
"""Lines of the conversation on a page."""


class Page:
    """What one visitor sees; `show` brings the part up to date that has changed.

    Args:
        host: the conversation.
    """

    def __init__(self, host: Host) -> None:
        self._host = host
        self._said = 0  # lines of the conversation that were shown, those that are gone included
        self._shown: World | None = None
        with ui.element("main").classes("talk"):
            with ui.element("header").classes("head"):
                ui.html("Talk to the robot", tag="h1", sanitize=False)
                self._status = ui.label().classes("status").props("role=status")
            self._world()
            self._chat()
            with ui.element("div").classes("pair"):
                with _card("Its camera").classes("camera"):
                    self._view.camera()
                with _card("What may be meant"):
                    self._means = ui.html(sanitize=False)
            with ui.element("div").classes("side"):
                with _card("Words it has learned"):
                    self._words = ui.html(sanitize=False)
                self._tools = Tools(self._host, self._view.by_hand)
        ui.keyboard(self._key, ignore=[], repeating=False)
        for part in ("status", "world", "lines", "candidates", "words"):
            self.show(part)
        host.changed.subscribe(self.show)

    def show(self, part: str) -> None:
        """Bring a part of the page up to date: as `Host` names it."""
        state = self._host.state
        match part:
            case "lines":
                self._show_lines()
            case "words":
                self._words.set_content(words_table(state.words))
            case "candidates":
                self._means.set_content(candidates_table(state.candidates))
            case "world" if state.world is not None:
                self._view.show_world(state.world)  # what was dragged and did not stay there goes back
                if state.world is not self._shown:
                    self._show_names(state.world)
            case "status":
                busy = f"busy, {state.waiting - 1} waiting" if state.waiting > 1 else "busy"
                self._status.set_text("waking up" if not state.ready else busy if state.waiting else "listening")

    def _world(self) -> None:
        with ui.element("section").classes("view").props('aria-label="World"'):
            self._view = WorldView(self._click, lambda id_, place: self._tools.move(id_, place))
            with ui.element("div").classes("views"):
                for name, where in (("Overview", "overview"), ("Above", "above"), ("Robot", "robot")):
                    ui.button(name, on_click=lambda where=where: self._look(where)).props(
                        f'dense unelevated no-caps size=sm color=white text-color=black aria-label="View: {name}"'
                    )

    def _chat(self) -> None:
        with ui.element("section").classes("card chat").props('aria-label="Talk"'):
            log = ui.element("div").classes("log")
            with log.props('role=log aria-live=polite aria-label="Conversation" tabindex=0'):
                self._log = ui.element("div").classes("lines")
            with ui.element("div").classes("entry"):
                self._input = ui.input("Command").props("outlined dense autofocus autocomplete=off maxlength=500")
                self._input.on("keydown.enter", self._say)
                ui.button("Send", on_click=self._say).props("unelevated no-caps")
                ui.button("Stop", on_click=self._host.stop, color="red-8").props("unelevated no-caps")
            with ui.element("div").classes("below"):
                self._pointing = ui.select({None: "nothing"}, label="Pointing at", on_change=self._choose)
                self._pointing.props("outlined dense options-dense")
                ui.button("Why?", on_click=self._why).props('flat no-caps aria-label="Why: factors and features"')

    def _show_lines(self) -> None:
        state = self._host.state
        first = max(state.dropped, state.dropped + len(state.lines) - _SHOWN)
        if self._said > state.dropped + len(state.lines) or not state.lines:
            self._said = 0
            self._log.clear()
        for line in state.lines[max(self._said, first) - state.dropped :]:
            self._add(line)
        self._said = state.dropped + len(state.lines)
        while len(self._log.default_slot.children) > _SHOWN:
            self._log.remove(0)

    def _add(self, line: Line) -> None:
        with self._log, ui.element("div").classes(line.who):
            ui.label(line.text)
            if line.choices:
                names = self._host.state.names
                with ui.element("div").classes("choices"):
                    for choice in line.choices:
                        ui.button(names.get(choice, choice), on_click=lambda choice=choice: self._click(choice)).props(
                            "dense outline no-caps"
                        )

    def _show_names(self, world: World) -> None:
        self._shown, names = world, self._host.state.names
        pointed = self._pointing.value
        self._pointing.set_options({None: "nothing", **names}, value=pointed if pointed in names else None)
        self._choose()

    def _say(self) -> None:
        text, pointed = self._input.value or "", self._pointing.value
        self._input.set_value("")
        self._pointing.set_value(None)
        self._host.say(text, pointed)

    def _click(self, object_id: str) -> None:
        """A click answers a question; without one it points at the object, for the next sentence."""
        if object_id in self._host.state.question:
            self._host.do(Input(click=object_id))
        else:
            self._pointing.set_value(None if object_id == self._pointing.value else object_id)

    def _choose(self) -> None:
        self._view.point(self._pointing.value)
        things = {thing.id: thing for thing in self._shown.objects} if self._shown is not None else {}
        self._tools.choose(things.get(self._pointing.value or ""))

    def _look(self, where: str) -> None:
        if self._host.state.world is not None:
            self._view.look(where, self._host.state.world, self._host.state.pose)

    def _key(self, event: events.KeyEventArguments) -> None:
        if event.key.escape and event.action.keydown:
            self._host.stop()

    async def _why(self) -> None:
        with told():
            lines = await self._host.ask(lambda session: session.reasons())
            with ui.dialog(value=True) as dialog, ui.card():
                ui.label("\n".join(lines) or "Nothing was grounded yet.").classes("reasons")
                ui.button("Close", on_click=dialog.close).props("no-caps")


def _card(title: str) -> ui.element:
    with ui.element("section").classes("card").props(f'aria-label="{title}"') as card:
        ui.html(title, tag="h2", sanitize=False)
    return card
