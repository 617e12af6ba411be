"""Visitors in a real browser talk through the paper's laboratory demonstration."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("nicegui", reason="the page needs the extra talk: pip install -e '.[talk]'")
pytest.importorskip("playwright", reason="a browser is driven by Playwright: pip install playwright")

from browser import chromium, serving
from playwright.sync_api import Page, expect

pytestmark = pytest.mark.slow

PACE = "pace=3"
PATIENCE = 60_000  # milliseconds that a busy machine may take
Start = Callable[..., str]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Starts the program with a session in a file; its address. What ran before is ended."""
    with contextlib.ExitStack() as running:

        def run(*settings: str) -> str:
            running.close()
            settings = ("talk", "open=false", f"session={tmp_path}/session.jsonl", *settings)
            return running.enter_context(serving(*settings, cwd=tmp_path))

        yield run


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with chromium() as browser:
        yield browser


@pytest.fixture
def page(browser: Any) -> Iterator[Page]:
    """A phone's page; it fails with any error of its scripts."""
    errors: list[str] = []
    page = browser.new_page(viewport={"width": 390, "height": 844})
    page.set_default_timeout(PATIENCE)
    page.on("pageerror", lambda error: errors.append(str(error)))
    yield page
    page.close()
    assert errors == []


def listening(page: Page) -> None:
    expect(page.get_by_role("status").first).to_have_text("listening", timeout=PATIENCE)


def say(page: Page, text: str) -> None:
    page.get_by_label("Command").fill(text)
    page.keyboard.press("Enter")
    expect(page.get_by_role("log")).to_contain_text(text, timeout=PATIENCE)


def point_at(page: Page, name: str) -> None:
    """Choose an object from the list, which the keyboard opens."""
    field, option = page.get_by_label("Pointing at"), page.get_by_role("option", name=name)
    field.focus()
    page.keyboard.press("ArrowDown")
    expect(option).to_be_visible(timeout=PATIENCE)
    option.click()
    expect(option).to_be_hidden(timeout=PATIENCE)


def conversation(page: Page) -> list[str]:
    return page.get_by_role("log").locator(".lines > div").all_inner_texts()


def test_the_laboratory_demonstration_talked_through(page: Page, start: Start) -> None:
    """By keyboard alone, with a stop while it drives, a reload in the middle, a killed server, and a replay."""
    address = start("port=0", PACE)
    page.goto(address)
    listening(page)
    expect(page.get_by_label("Command")).to_be_focused()
    say(page, "move towards the cone")
    listening(page)
    say(page, "move towards the crate")
    expect(page.get_by_role("status").first).to_have_text("busy", timeout=PATIENCE)
    page.keyboard.press("Escape")
    listening(page)
    page.reload()
    listening(page)
    expect(page.get_by_role("log")).to_contain_text("move towards the crate")
    say(page, "move towards the crate")
    listening(page)
    words = page.get_by_label("Words it has learned")
    expect(words).to_contain_text("cone")
    expect(words).to_contain_text("crate")
    before = conversation(page)

    port = re.search(r":(\d+)/", address)
    assert port is not None
    page.evaluate("window.before = true")
    assert start(f"port={port[1]}", PACE) == address
    page.wait_for_function("!window.before")  # the page finds the server again by itself
    listening(page)
    expect(words).to_contain_text("crate", timeout=PATIENCE)
    assert conversation(page) == before

    page.get_by_text("Save, load, replay").click()
    page.get_by_role("button", name="Replay", exact=True).click()
    expect(page.get_by_role("log")).to_contain_text("the same to the last byte", timeout=PATIENCE)
    assert conversation(page)[:-1] == before
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


WORLD = """name: {name}
objects:
  - {{id: left, type: traffic cone, color: red, position: [2.0, 0.8]}}
  - {{id: right, type: traffic cone, color: green, position: [2.0, -0.8]}}
  - {{id: box, type: crate, color: brown, position: [{x}, 0.0]}}
"""


def click_in_the_world(page: Page, object_id: str) -> None:
    """Click on an object in the 3-D picture, half a hand above its foot."""
    page.wait_for_function(f"(id) => {_MESH}", arg=object_id)
    page.wait_for_timeout(600)  # the view moves as the page opens
    x, y = page.evaluate(f"(id) => {{ const mesh = {_MESH}; {_PIXEL} }}", object_id)
    page.mouse.click(x, y)


_VIEW = "getElement(Number(document.querySelector('.world').id.slice(1)))"
_MESH = f"[...{_VIEW}.objects.values()].map((o) => o.mesh).find((mesh) => mesh?.name === id)"
_PIXEL = f"""
  const view = {_VIEW}, box = document.querySelector(".world canvas").getBoundingClientRect();
  const at = mesh.position.clone().setZ(0.1).project(view.camera);
  return [box.left + (at.x + 1) / 2 * box.width, box.top + (1 - at.y) / 2 * box.height];
"""


def test_words_are_taught_and_a_question_is_answered_by_clicks(page: Page, start: Start, tmp_path: Path) -> None:
    """In a world of two alike things, by clicks into the picture of the world, from the list, and on a button."""
    (tmp_path / "two.yaml").write_text(WORLD.format(name="two", x=3.0))
    page.goto(start("port=0", "world=two.yaml", "simulator=fake", PACE))
    listening(page)
    point_at(page, "brown crate")
    say(page, "this is a pallet")
    listening(page)
    click_in_the_world(page, "left")
    expect(page.get_by_label("Pointing at")).to_have_value("red traffic cone")
    say(page, "this is a wug")
    listening(page)
    for word in ("pallet", "wug"):
        expect(page.get_by_label("Words it has learned")).to_contain_text(word)
    log, meant = page.get_by_role("log"), page.get_by_label("What may be meant")
    choices = log.get_by_role("button", name="green traffic cone")
    answers: tuple[Callable[[], None], ...] = (lambda: click_in_the_world(page, "right"), choices.last.click)
    for turn, answer in enumerate(answers, start=1):
        say(page, "go to the wug")
        expect(choices).to_have_count(turn)
        answer()
        expect(log.get_by_text("(points at the green traffic cone)")).to_have_count(turn)
        expect(meant.get_by_role("row").first).to_contain_text("green")
        listening(page)


def test_files_are_taken_home_and_brought_back(page: Page, start: Start, tmp_path: Path) -> None:
    """A world and a session are loaded; what is no world is said, and changes nothing."""
    page.goto(start("port=0", "simulator=fake", PACE))
    listening(page)
    say(page, "move towards the cone")
    listening(page)
    page.get_by_text("Save, load, replay").click()
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save: Session").click()
    session = saved.value.path().read_bytes()
    (tmp_path / "other.yaml").write_text(WORLD.format(name="other", x=3.0))
    (tmp_path / "wrong.yaml").write_text("name: [")

    def load(what: str, name: str, content: bytes) -> None:
        files = page.locator(".q-uploader", has_text=f"Load {what}").locator("input[type=file]")
        files.set_input_files({"name": name, "mimeType": "application/octet-stream", "buffer": content})

    load("world", "wrong.yaml", (tmp_path / "wrong.yaml").read_bytes())
    expect(page.get_by_role("alert").first).to_contain_text("world.yaml")
    expect(page.get_by_role("log")).to_contain_text("move towards the cone")
    load("world", "other.yaml", (tmp_path / "other.yaml").read_bytes())
    page.wait_for_function(f"(id) => {_MESH}", arg="right")
    expect(page.get_by_role("log")).not_to_contain_text("move towards the cone")
    expect(page.get_by_label("Words it has learned")).to_contain_text("cone")  # comes along into the other world
    load("session", "session.jsonl", session)
    expect(page.get_by_role("log")).to_contain_text("move towards the cone")
    listening(page)
    assert page.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
