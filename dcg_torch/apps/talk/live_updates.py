"""What changes many times a second: every message is made once, and sent to all visitors as fast as each takes it."""

from __future__ import annotations

import asyncio
import contextlib
import json
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

PATH = "/live"
_KIND: dict[type, str] = {str: "text", bytes: "bytes"}


class Live:
    """The newest message of each kind; a slow connection skips what is old. For the event loop.

    Attributes:
        visitors: how many are there.
    """

    def __init__(self) -> None:
        self.visitors = 0
        self._newest: dict[str, str | bytes] = {}
        self._news = asyncio.Event()  # another one after each

    def send(self, **news: Any) -> None:
        """Values by their names, as JSON; bytes as they are."""
        messages = {k: v if isinstance(v, bytes) else json.dumps({k: v}) for k, v in news.items()}
        messages = {name: message for name, message in messages.items() if self._newest.get(name) != message}
        if messages:
            self._newest.update(messages)
            self._wake()

    def _wake(self) -> None:
        self._news.set()
        self._news = asyncio.Event()

    async def serve(self, socket: WebSocket) -> None:
        """Serve a visitor until they go: all that there is, and then what is new."""
        await socket.accept()
        leaving = asyncio.create_task(socket.receive())
        leaving.add_done_callback(lambda _: self._wake())
        sent: dict[str, str | bytes] = {}
        self.visitors += 1
        try:
            with contextlib.suppress(WebSocketDisconnect):
                while not leaving.done():
                    news = self._news
                    for name, message in tuple(self._newest.items()):
                        if sent.get(name) is not message:
                            sent[name] = message
                            await socket.send({"type": "websocket.send", _KIND[type(message)]: message})
                    await news.wait()
        finally:
            self.visitors -= 1
            leaving.cancel()
