"""Visitors in a real browser talk through the paper's laboratory demonstration."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

pytest.importorskip("nicegui", reason="the page needs the extra talk: pip install -e '.[talk]'")
pytest.importorskip("playwright", reason="a browser is driven by Playwright: pip install playwright")

from playwright.sync_api import Browser, Page, expect, sync_playwright

BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(BROWSER is None, reason="no Chromium here: apt-get install chromium"),
]

# Without a graphics card, in a container, and without a word to anyone.
FLAGS = (
    *("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic"),
    *("--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"),
)
PACE = "pace=3"
PATIENCE = 60_000  # milliseconds that a busy machine may take
Start = Callable[..., str]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Starts the program with a session in a file; its address. What ran before is killed."""
    running: list[subprocess.Popen[str]] = []

    def kill() -> None:
        for one in running:
            with one:  # closes its pipe, too
                one.kill()
        running.clear()

    def run(*settings: str) -> str:
        kill()
        command = [sys.executable, "-m", "dcg_torch.talk", "open=false", f"session={tmp_path}/session.jsonl", *settings]
        environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
        running.append(process)
        assert process.stdout is not None
        return process.stdout.readline().strip()

    yield run
    kill()


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
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


def test_words_are_taught_and_a_question_is_answered_by_clicks(page: Page, start: Start, tmp_path: Path) -> None:
    """In a world of two alike things, by clicks into the picture of the world and on the buttons of the question."""
    world = tmp_path / "two.yaml"
    world.write_text(
        """name: two
objects:
  - {id: left, type: traffic cone, color: red, position: [2.0, 0.8]}
  - {id: right, type: traffic cone, color: green, position: [2.0, -0.8]}
  - {id: box, type: crate, color: brown, position: [3.0, 0.0]}
"""
    )
    page.goto(start("port=0", f"world={world}", "simulator=fake", PACE))
    listening(page)
    for name, word in (("brown crate", "pallet"), ("red traffic cone", "wug")):
        point_at(page, name)
        say(page, f"this is a {word}")
        listening(page)
        expect(page.get_by_label("Words it has learned")).to_contain_text(word)
    say(page, "go to the wug")
    choice = page.get_by_role("log").get_by_role("button", name="green traffic cone")
    choice.click()
    expect(page.get_by_role("log")).to_contain_text("(points at the green traffic cone)")
    listening(page)
    expect(page.get_by_label("What may be meant").get_by_role("row").first).to_contain_text("green")
