"""Who may see the page: everyone who can reach the loopback address, or whoever has the token."""

from __future__ import annotations

import secrets
from http.cookies import SimpleCookie
from urllib.parse import parse_qs

from starlette.responses import PlainTextResponse, RedirectResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

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
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        given = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[0]
        if self._token is None:
            if _host(headers.get("host", "")) in LOOPBACK:
                await self.app(scope, receive, send)
            else:
                await _refuse(scope, receive, send, "This page is served to this machine only.")
        elif self._same(_cookie(headers.get("cookie", ""))):
            await self.app(scope, receive, send)
        elif scope["type"] == "http" and self._same(given):
            answer = RedirectResponse(scope["path"], status_code=303)
            answer.set_cookie(_COOKIE, given, httponly=True, samesite="strict", max_age=30 * 24 * 3600)
            await answer(scope, receive, send)
        else:
            await _refuse(scope, receive, send, "Open the address with its token, as the program printed it.")

    def _same(self, given: str) -> bool:
        return secrets.compare_digest(given.encode(), (self._token or "").encode())


def _host(header: str) -> str:
    """The host of "name:port", "[::1]:port" or "name"."""
    return header[1:].partition("]")[0] if header.startswith("[") else header.partition(":")[0]


def _cookie(header: str) -> str:
    cookies: SimpleCookie = SimpleCookie()
    cookies.load(header)
    return cookies[_COOKIE].value if _COOKIE in cookies else ""


async def _refuse(scope: Scope, receive: Receive, send: Send, why: str) -> None:
    if scope["type"] == "http":
        await PlainTextResponse(why, status_code=403)(scope, receive, send)
    else:
        closing: Message = {"type": "websocket.close", "code": 1008, "reason": why}
        await send(closing)
