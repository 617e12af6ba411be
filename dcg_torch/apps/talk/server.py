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
from urllib.parse import unquote

import uvicorn
from fastapi import FastAPI, Response, WebSocket
from nicegui import Client, ui

from dcg_torch.apps.talk.gate import LOOPBACK, Gate
from dcg_torch.apps.talk.host import Host
from dcg_torch.apps.talk.live import PATH
from dcg_torch.apps.talk.looks import object_looks, robot_looks
from dcg_torch.apps.talk.page import CSS, Page
from dcg_torch.apps.talk.scene import BODIES
from dcg_torch.storage.errors import UserError

_KEEP = {"Cache-Control": "public, max-age=3600"}
_TITLE = "Talk to the robot"
_NO_CARD = """{
  const own = HTMLCanvasElement.prototype.getContext, probe = own.call(document.createElement("canvas"), "webgl");
  const name = probe?.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? probe?.RENDERER;
  if (probe && /swiftshader|llvmpipe|software|basic render/i.test(probe.getParameter(name)))
    HTMLCanvasElement.prototype.getContext = function (kind, options) {
      return own.call(this, kind, { ...options, antialias: false });
    };
}"""
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
    config = uvicorn.Config(
        Gate(app, address.token),
        log_level="warning",
        lifespan="on",
        ws_ping_interval=20.0,
        ws_per_message_deflate=False,  # it takes longer than the short messages
    )
    server = uvicorn.Server(config)
    with warnings.catch_warnings():  # NiceGUI touches every object there is as it starts
        warnings.simplefilter("ignore", FutureWarning)
        server.run(sockets=[listening])
    if failed:
        raise failed[0]


def add_routes(app: FastAPI, host: Host) -> None:
    """The page, and the looks of what is in its scene."""

    @ui.page("/")
    def talk(client: Client) -> None:
        ui.add_css(CSS)
        ui.add_head_html(f"<script>{_NO_CARD}</script>")
        ui.colors(primary="#1d4ed8")
        Page(host, client)

    @app.get(BODIES + "/robot.json")
    def robot() -> Response:
        return Response(robot_looks(), media_type="application/json", headers=_KEEP)

    @app.get(BODIES + "/{type_}/{color}.json")
    def body(type_: str, color: str) -> Response:
        return Response(object_looks(unquote(type_), unquote(color)), media_type="application/json", headers=_KEEP)

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
    try:
        found = socket.getaddrinfo(address.host, address.port, type=socket.SOCK_STREAM)
        family, kind, protocol, _, place = found[0]
        listening = socket.socket(family, kind, protocol)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(place)
        listening.listen(128)
    except OSError as error:
        raise UserError(
            f"host={address.host} port={address.port}: {error.strerror or error}; give another, port=0 takes a free one"
        ) from None
    return listening
