"""Who may see the page: everyone who can reach the loopback address, or whoever has the token."""

from __future__ import annotations

import secrets

from starlette.requests import HTTPConnection
from starlette.responses import PlainTextResponse, RedirectResponse
from starlette.types import ASGIApp, Receive, Scope, Send
from starlette.websockets import WebSocketClose

LOOPBACK = ("127.0.0.1", "localhost", "::1")
_COOKIE = "dcg_torch_talk"


class Gate:
    """Lets requests and sockets through that carry the token, once in the address and then in a cookie.

    Without a token it lets through what names the loopback address as its host, so that no page from elsewhere gets
    in by a name of its own for that address.
    """

    def __init__(self, app: ASGIApp, token: str | None) -> None:
        self.app = app  # NiceGUI looks for its server along this name
        self._token = token

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, or hand on."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        asked = HTTPConnection(scope)
        given, cookie = asked.query_params.get("token", ""), asked.cookies.get(_COOKIE, "")
        if self._token is None:
            passes, why = asked.url.hostname in LOOPBACK, "This page is served to this machine only."
        else:
            passes, why = self._same(cookie), "Open the address with its token, as the program printed it."
        answer: ASGIApp = PlainTextResponse(why, status_code=403)
        if passes:
            answer = self.app
        elif scope["type"] == "websocket":
            answer = WebSocketClose(1008, why)
        elif self._token is not None and self._same(given):
            answer = redirect = RedirectResponse(scope["path"], status_code=303)
            redirect.set_cookie(_COOKIE, given, httponly=True, samesite="strict", max_age=30 * 24 * 3600)
        await answer(scope, receive, send)

    def _same(self, given: str) -> bool:
        return secrets.compare_digest(given.encode(), (self._token or "").encode())
