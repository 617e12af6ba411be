"""The server of the page: its routes, its address, its end."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import secrets
import socket
import sys
import warnings
import webbrowser
from collections.abc import AsyncIterator
from dataclasses import dataclass

import uvicorn
from fastapi import FastAPI, Response, WebSocket
from nicegui import ui

from dcg_torch.apps.talk.gate import LOOPBACK, Gate
from dcg_torch.apps.talk.host import Host
from dcg_torch.apps.talk.live_updates import PATH
from dcg_torch.apps.talk.looks import object_looks, robot_looks
from dcg_torch.apps.talk.page import CSS, Page
from dcg_torch.apps.talk.scene import BODIES
from dcg_torch.storage.errors import UserError

_TITLE = "Talk to the robot"
_NO_CARD = """<script>{
  const own = HTMLCanvasElement.prototype.getContext, probe = own.call(document.createElement("canvas"), "webgl");
  const name = probe?.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? probe?.RENDERER;
  const plain = function (kind, options) { return own.call(this, kind, { ...options, antialias: false }); };
  if (probe && /swiftshader|llvmpipe|software|basic render/i.test(probe.getParameter(name)))
    HTMLCanvasElement.prototype.getContext = plain;
}</script>"""
"""Where no graphics card draws, smooth edges would take half of the time."""


@dataclass(frozen=True)
class Address:
    """Where the page is served. `token` is what visitors need where the host is not the loopback address."""

    host: str = "127.0.0.1"
    port: int = 8080
    token: str | None = None

    @classmethod
    def checked(cls, host: str, port: int, token: str | None) -> Address:
        """With a token made by chance, where one is needed and none is given."""
        if host in LOOPBACK:
            return cls(host, port, token)
        return cls(host, port, token or secrets.token_urlsafe(16))

    def url(self, port: int) -> str:
        """What to open, the token in it."""
        name = f"[{self.host}]" if ":" in self.host else self.host
        return f"http://{name}:{port}/" + (f"?token={self.token}" if self.token else "")


def serve(host: Host, address: Address, *, show: bool) -> None:
    """Serve the page until the program is told to end; its address is the first line of output.

    Raises:
        UserError: the address can't be had, or the session can't be opened.
    """
    listening = _listen(address)
    sys.setswitchinterval(0.0005)  # so that the event loop, which sends little by little, waits less for the robot
    url = address.url(listening.getsockname()[1])
    print(url, flush=True)
    failed: list[Exception] = []

    @contextlib.asynccontextmanager
    async def life(_: FastAPI) -> AsyncIterator[None]:
        beginning = asyncio.create_task(_begin(host, failed, server))
        if show:
            webbrowser.open(url)
        yield
        beginning.cancel()
        await host.end()

    app = FastAPI(title=_TITLE, lifespan=life, openapi_url=None)
    add_routes(app, host)
    ui.run_with(
        app,
        title=_TITLE,
        favicon="🤖",
        language="en-US",
        tailwind=False,
        reconnect_timeout=20.0,  # of a phone that changes its network
        message_history_length=200,
        binding_refresh_interval=None,
        show_welcome_message=False,
    )
    # what a browser asks for by itself, as its own icons, is no news
    logging.getLogger("nicegui").addFilter(lambda record: not record.getMessage().endswith(" not found"))
    gate = Gate(app, address.token)
    # messages are short: to compress them takes longer
    server = uvicorn.Server(uvicorn.Config(gate, log_level="warning", lifespan="on", ws_per_message_deflate=False))
    with warnings.catch_warnings():  # NiceGUI touches every object there is as it starts
        warnings.simplefilter("ignore", FutureWarning)
        server.run(sockets=[listening])
    if failed:
        raise failed[0]


def add_routes(app: FastAPI, host: Host) -> None:
    """The page, and the looks of what is in its scene."""

    @ui.page("/")
    def talk() -> None:
        ui.add_css(CSS)
        ui.add_head_html(_NO_CARD)
        ui.colors(primary="#1d4ed8")
        Page(host)

    @app.get(BODIES)
    def body(type: str = "", color: str = "") -> Response:
        looks = object_looks(type, color) if type else robot_looks()
        return Response(looks, media_type="application/json", headers={"Cache-Control": "public, max-age=3600"})

    @app.websocket(PATH)
    async def live(socket: WebSocket) -> None:
        await host.live.serve(socket)


async def _begin(host: Host, failed: list[Exception], server: uvicorn.Server) -> None:
    try:
        await host.begin()
    except Exception as error:  # raised again by the thread that serves
        failed.append(error)
        server.should_exit = True


def _listen(address: Address) -> socket.socket:
    """The socket, listening already, so that whoever reads the address may open it at once."""
    family = socket.AF_INET6 if ":" in address.host else socket.AF_INET
    try:
        return socket.create_server((address.host, address.port), family=family)
    except (OSError, OverflowError) as error:
        why = getattr(error, "strerror", None) or error
        raise UserError(
            f"host={address.host} port={address.port}: {why}; give another, port=0 takes a free one"
        ) from None
