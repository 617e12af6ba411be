"""What changes many times a second: every message is made once, and sent to all visitors as fast as each takes it."""

from __future__ import annotations

import asyncio
import contextlib
import json
from dataclasses import dataclass, field
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

PATH = "/live"
_KIND: dict[type, str] = {str: "text", bytes: "bytes"}


@dataclass(eq=False)
class _Visitor:
    """What a visitor has not been sent yet: of each kind the newest, so that a slow connection skips what is old."""

    pending: dict[str, str | bytes]
    wake: asyncio.Event = field(default_factory=asyncio.Event)


class Live:
    """The newest message of each kind, and who is to have it. For the event loop."""

    def __init__(self) -> None:
        self._newest: dict[str, str | bytes] = {}
        self._visitors: set[_Visitor] = set()

    def __bool__(self) -> bool:
        """Is anybody there?"""
        return bool(self._visitors)

    def send(self, **news: Any) -> None:
        """Values by their names, as JSON; bytes as they are."""
        for name, value in news.items():
            message = value if isinstance(value, bytes) else json.dumps({name: value})
            if self._newest.get(name) == message:
                continue
            self._newest[name] = message
            for visitor in self._visitors:
                visitor.pending[name] = message
                visitor.wake.set()

    async def serve(self, socket: WebSocket) -> None:
        """Serve a visitor until they go: all that there is, and then what is new."""
        await socket.accept()
        visitor = _Visitor(dict(self._newest))
        visitor.wake.set()
        self._visitors.add(visitor)
        leaving = asyncio.create_task(socket.receive())
        leaving.add_done_callback(lambda _: visitor.wake.set())
        try:
            with contextlib.suppress(WebSocketDisconnect):
                while not leaving.done():
                    messages, visitor.pending = visitor.pending, {}
                    for message in messages.values():
                        await socket.send({"type": "websocket.send", _KIND[type(message)]: message})
                    visitor.wake.clear()
                    if not visitor.pending and not leaving.done():
                        await visitor.wake.wait()
        finally:
            self._visitors.discard(visitor)
            leaving.cancel()
