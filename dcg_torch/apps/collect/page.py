"""The pages: agree, write commands, get a code. They are made on the server and need no JavaScript."""

from __future__ import annotations

import hmac
import re
import secrets
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Annotated, Any
from urllib.parse import parse_qsl

from fastapi import Cookie, Depends, FastAPI, HTTPException, Request, Response
from fastapi.responses import HTMLResponse, RedirectResponse
from fastapi.staticfiles import StaticFiles
from jinja2 import Environment, PackageLoader, select_autoescape
from sqlalchemy.exc import SQLAlchemyError
from starlette.exceptions import HTTPException as AnyHTTPException

from dcg_torch.apps.collect.database import Answers
from dcg_torch.apps.collect.settings import TaskSettings
from dcg_torch.apps.collect.texts import EXAMPLE, LONGEST

TEMPLATES = Environment(
    loader=PackageLoader("dcg_torch.apps.collect"), autoescape=select_autoescape(), trim_blocks=True
)
WORKER_IDS = ("workerId", "PROLIFIC_PID", "participant")
"""Parameters of the address in which Mechanical Turk, Prolific and others say who comes."""
COOKIE = "dcg_collect"
_KEY = re.compile(r"[0-9a-f]{64}")
_LARGEST_FORM = 16_384  # bytes
_NOTES = {
    "kept": "Your command is kept.",
    "next": "That picture needs no more commands. Here is another one.",
    "skipped": "You left that picture out. Here is another one.",
}
_HEADERS = {
    "Content-Security-Policy": "default-src 'none'; img-src 'self'; style-src 'self'; form-action 'self'; "
    "base-uri 'none'; frame-ancestors 'none'",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


@dataclass(frozen=True)
class Study:
    """What a server asks: its settings, answers, folder of pictures, salt, and the code for all, if there is one."""

    settings: TaskSettings
    answers: Answers
    pictures: Path
    salt: bytes
    code: str | None = None

    def person(self, key: str) -> str:
        """Who has a cookie, as the database knows them."""
        return hmac.new(self.salt, key.encode(), sha256).hexdigest()

    def key_of(self, worker: str) -> str:
        """The cookie of a worker; it does not tell their id."""
        return hmac.new(self.salt, b"worker " + worker.encode(), sha256).hexdigest()


def page(name: str, **values: Any) -> str:
    """A template with its values filled in."""
    return TEMPLATES.get_template(name).render(example=EXAMPLE, longest=LONGEST, **values)


async def _form(request: Request) -> dict[str, str]:
    """The fields of a form, the first of each name."""
    body = b""
    async for chunk in request.stream():
        body += chunk
        if len(body) > _LARGEST_FORM:
            raise HTTPException(413, "This is too long.")
    return dict(reversed(parse_qsl(body.decode("utf-8", "replace"), keep_blank_values=True)))


Form = Annotated[dict[str, str], Depends(_form)]
Key = Annotated[str | None, Cookie(alias=COOKIE)]


def make_app(study: Study) -> FastAPI:
    """The application that serves a study."""
    app = FastAPI(openapi_url=None)
    app.mount("/pictures", StaticFiles(directory=study.pictures), "pictures")
    app.mount("/static", StaticFiles(packages=[("dcg_torch.apps.collect", "static")]), "static")
    _add_errors(app)
    _add_welcome(app, study)
    _add_task(app, study)
    return app


def _add_errors(app: FastAPI) -> None:
    @app.exception_handler(AnyHTTPException)
    def refused(_: Request, error: AnyHTTPException) -> Response:
        return HTMLResponse(page("message.html", title="Sorry", text=error.detail), error.status_code)

    @app.exception_handler(SQLAlchemyError)
    def broken(_: Request, error: SQLAlchemyError) -> Response:
        text = "Nothing could be stored just now. Go back, wait a moment, and send it again."
        return HTMLResponse(page("message.html", title="Please try again", text=text), 503)

    @app.middleware("http")
    async def headers(request: Request, go_on: Callable[[Request], Awaitable[Response]]) -> Response:
        response = await go_on(request)
        response.headers.update(_HEADERS)
        if not request.url.path.startswith(("/pictures", "/static")):
            response.headers["Cache-Control"] = "no-store"
        return response


def _add_welcome(app: FastAPI, study: Study) -> None:
    @app.get("/")
    def welcome(request: Request, key: Key = None) -> Response:
        worker = next((w for name in WORKER_IDS if (w := request.query_params.get(name))), None)
        if worker is not None:  # the id leaves the address line at once
            return _with_cookie(request, RedirectResponse("/", 303), study.key_of(worker))
        if not _valid(key):
            key = secrets.token_hex(32)
        return _with_cookie(request, HTMLResponse(page("welcome.html", settings=study.settings)), str(key))

    @app.post("/")
    def agree(form: Form, key: Key = None) -> Response:
        if key is None or not _valid(key):
            raise HTTPException(400, "Your browser keeps no cookies. Please allow them for this page, and start again.")
        if form.get("agree") != "yes":
            return HTMLResponse(
                page("welcome.html", settings=study.settings, problem="Please tick the box first."), 422
            )
        study.answers.agree(study.person(key))
        return RedirectResponse("/task", 303)


def _add_task(app: FastAPI, study: Study) -> None:
    def shown(key: str | None, note: str = "", problem: str = "", text: str = "", item: str = "") -> Response:
        person = study.person(key) if key is not None and _valid(key) else ""
        task = study.answers.task(person)
        if task is None:
            return RedirectResponse("/", 303)
        if task.item is None:
            return RedirectResponse("/done", 303)
        if item != task.item.id:  # what was typed belongs to another picture
            text = ""
        values = {"task": task, "note": _NOTES.get(note), "problem": problem, "text": text}
        return HTMLResponse(page("task.html", **values), 422 if problem else 200)

    @app.get("/task")
    def task(key: Key = None, note: str = "") -> Response:
        return shown(key, note)

    @app.post("/task")
    def write(form: Form, key: Key = None) -> Response:
        if key is None or not _valid(key) or study.answers.code(study.person(key)) is None:
            return RedirectResponse("/", 303)
        text, item = form.get("command", ""), form.get("item", "")
        if "skip" in form:
            study.answers.skip(study.person(key), item)
            return RedirectResponse("/task?note=skipped", 303)
        added = study.answers.add(study.person(key), item, text)
        if added.refused:
            return shown(key, problem=added.refused, text=text, item=item)
        return RedirectResponse(f"/task?note={'kept' if added.kept else 'next'}", 303)

    @app.get("/done")
    def done(key: Key = None) -> Response:
        person = study.person(key) if key is not None and _valid(key) else ""
        task, code = study.answers.task(person), study.answers.code(person)
        if task is None or task.item is not None:
            return RedirectResponse("/task", 303)
        values = {"code": study.code or code, "own": study.code is None, "contact": study.settings.contact}
        return HTMLResponse(page("done.html", **values))


def _valid(key: str | None) -> bool:
    return key is not None and _KEY.fullmatch(key) is not None


def _with_cookie(request: Request, response: Response, key: str) -> Response:
    secure = request.url.scheme == "https"
    response.set_cookie(COOKIE, key, max_age=30 * 86_400, httponly=True, samesite="lax", secure=secure)
    return response
