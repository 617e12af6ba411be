"""The page to talk to the robot, without a browser: what it shows, who may see it, its files."""

from __future__ import annotations

import asyncio
import functools
import io
import json
import socket
import subprocess
import sys
import zipfile
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("nicegui", reason="the page needs the extra talk: pip install -e '.[talk]'")

from fastapi import FastAPI
from making import typed
from nicegui.testing import User, user_simulation

from dcg_torch.apps.talk import files, program
from dcg_torch.apps.talk.gate import Gate
from dcg_torch.apps.talk.host import Host
from dcg_torch.apps.talk.lines import Line, names_of
from dcg_torch.apps.talk.looks import object_looks, robot_looks
from dcg_torch.apps.talk.panels import candidates_table, words_table
from dcg_torch.apps.talk.server import Address, add_routes
from dcg_torch.cli.config import register
from dcg_torch.dialogue.events import Candidate
from dcg_torch.dialogue.file import Input, read_session
from dcg_torch.dialogue.session import Session
from dcg_torch.settings import TalkSettings
from dcg_torch.simulator.bodies import extent
from dcg_torch.storage.errors import UserError
from dcg_torch.storage.resources import resource
from dcg_torch.world.files import World, load_world

Talk = Callable[[User, Host], Awaitable[None]]


@pytest.fixture(scope="module")
def laboratory() -> World:
    return load_world(resource("worlds") / "hardware" / "laboratory.yaml")


@pytest.fixture
def host(tmp_path: Path, laboratory: World) -> Host:
    file = tmp_path / "session.jsonl"
    return Host(file, lambda: Session(laboratory, file=file, simulator="fake"), pace=0.0)


def visit(host: Host, talk: Talk) -> None:
    """A visitor opens the page, once the robot is awake."""

    failed: list[BaseException] = []

    async def run() -> None:
        async with user_simulation() as user:
            add_routes(FastAPI(), host)
            await host.begin()
            await user.open("/")
            try:
                await talk(user, host)
            except BaseException as error:  # NiceGUI does not end where its simulation is left by an exception
                failed.append(error)
            await host.end()

    ours = {name: module for name, module in sys.modules.items() if name.partition(".")[0] == "dcg_torch"}
    asyncio.run(run())
    sys.modules.update(ours)  # NiceGUI takes the modules of its pages out at the end, with all above them
    if failed:
        raise failed[0]


async def said(user: User, text: str) -> None:
    user.find("Command").type(text).trigger("keydown.enter")


async def dealt_with(host: Host) -> None:
    for _ in range(400):
        await asyncio.sleep(0.02)
        if not host.state.waiting:
            return
    raise AssertionError("the robot did not get done")


def test_a_command_is_answered_and_its_word_is_shown(host: Host) -> None:
    async def talk(user: User, host: Host) -> None:
        await said(user, "move towards the cone")
        await dealt_with(host)
        await user.should_see("move towards the cone")
        await user.should_see("traffic cone")
        assert host.state.lines[0] == Line("you", "move towards the cone")
        assert {line.who for line in host.state.lines} == {"you", "robot", "note"}
        assert "cone" in host.state.words
        assert sum(row.probability for row in host.state.candidates) == pytest.approx(1.0)

    visit(host, talk)


def test_a_pointed_object_is_taught_and_pointing_ends_with_the_sentence(host: Host) -> None:
    async def talk(user: User, host: Host) -> None:
        user.find("Pointing at").click()
        user.find("orange traffic cone").click()
        await said(user, "this is a pylon")
        await dealt_with(host)
        assert host.state.words["pylon"]["traffic cone"] > 0.5
        assert read_session(host.file)[1] == (Input(say="this is a pylon", pointing_at="cone"),)
        await said(user, "what do you see?")
        await dealt_with(host)
        assert read_session(host.file)[1][1].pointing_at is None

    visit(host, talk)


def test_every_visitor_sees_the_same_conversation(host: Host) -> None:
    async def talk(user: User, host: Host) -> None:
        await said(user, "what do you see?")
        await dealt_with(host)
        other = User(user.http_client)
        await other.open("/")
        await other.should_see("what do you see?")
        host.say("turn left")
        await dealt_with(host)
        for one in (user, other):
            await one.should_see("turn left")

    visit(host, talk)


def test_a_session_comes_back_and_replays_to_the_same_bytes(host: Host, laboratory: World) -> None:
    async def talk(user: User, host: Host) -> None:
        for text in ("move towards the cone", "turn around", "<b>what</b> do you see?"):
            await said(user, text)
            await dealt_with(host)
        host.do(Input(remove="crate"))
        await dealt_with(host)
        before = list(host.state.lines)
        host.replay()
        await dealt_with(host)
        assert host.state.lines[:-1] == before
        assert "4 inputs, all that followed from them the same to the last byte" in host.state.lines[-1].text
        await host.ask(Session.close)  # as if the server had gone
        back = Host(host.file, lambda: pytest.fail("the session is there"))
        await back.begin()
        assert back.state.lines == before
        await back.end()

    visit(host, talk)


def test_a_stop_brings_a_replay_to_its_end_and_changes_nothing_in_it(tmp_path: Path, laboratory: World) -> None:
    file = tmp_path / "session.jsonl"
    shown = Host(file, lambda: Session(laboratory, file=file, simulator="fake"), pace=4.0)

    async def talk(user: User, host: Host) -> None:
        host.say("move towards the cone")
        await dealt_with(host)
        before = list(host.state.lines)
        host.replay()
        while host.state.lines[-1:] == before[-1:]:  # until it begins
            await asyncio.sleep(0.005)
        host.stop()
        await dealt_with(host)
        assert host.state.lines[:-1] == before
        assert "the same to the last byte" in host.state.lines[-1].text

    visit(shown, talk)


def test_who_waits_is_answered_or_told_so_at_once(tmp_path: Path, laboratory: World) -> None:
    """A question that takes no look is answered while the robot turns; what has to wait is dealt with in turn."""
    file = tmp_path / "session.jsonl"
    shown = Host(file, lambda: Session(laboratory, file=file, simulator="fake"), pace=2.0)

    async def talk(user: User, host: Host) -> None:
        host.say("turn around")
        for text in ("turn left", "what is a cube?", "what do you see?"):
            host.say(text)
        await dealt_with(host)
        said = [line.text for line in host.state.lines if line.who == "robot"]
        assert said[0] == "I turn left by 180 degrees."
        assert said[1] == "I am still busy; this comes next."
        assert said[2].startswith("A cube is")
        assert said[3] == "I am still busy; this comes next after 1 more."
        assert said[4] == "I turn left by 90 degrees."
        assert said[5].startswith("I see")
        assert [line.say for line in read_session(file)[1]] == ["turn around", "turn left", "what do you see?"]

    visit(shown, talk)


def test_worlds_models_and_sessions_are_taken_home_and_brought_back(host: Host, laboratory: World) -> None:
    async def talk(user: User, host: Host) -> None:
        host.say("move towards the cone")
        kinds = ("World", "Model", "Session")
        world, model, session = [await host.ask(functools.partial(files.saved, k, file=host.file)) for k in kinds]
        lines = list(host.state.lines)
        await host.exchange(files.with_world(host.file, world))
        assert host.state.lines == []
        assert "cone" in host.state.words  # what was learned goes along into another world
        await host.exchange(files.with_session(host.file, session))
        assert host.state.lines == lines
        await host.exchange(files.with_model(host.file, model))
        assert "cone" in host.state.words
        assert len(list(host.file.parent.glob("session-before-*.jsonl"))) == 3

    visit(host, talk)


def test_what_is_no_file_of_ours_changes_nothing(host: Host) -> None:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("../../evil", "x")

    async def talk(user: User, host: Host) -> None:
        host.say("turn left")
        await dealt_with(host)
        before = host.file.read_bytes()
        for change in (files.with_world, files.with_model, files.with_session):
            for content in (b"", b"nonsense", packed.getvalue()):
                with pytest.raises(UserError):
                    await host.exchange(change(host.file, content))
        assert host.file.read_bytes() == before
        assert not list(host.file.parent.parent.rglob("evil"))
        host.say("turn left")
        await dealt_with(host)
        assert len(read_session(host.file)[1]) == 2

    visit(host, talk)


def test_alike_objects_are_told_apart_by_their_ids(laboratory: World) -> None:
    twin = laboratory.objects[1].model_copy(update={"id": "twin"})
    names = names_of([*laboratory.objects, twin])
    assert names["cube"] == "blue cube (cube)"
    assert names["twin"] == "blue cube (twin)"
    assert names["cone"] == "orange traffic cone"


def test_tables_escape_what_they_show() -> None:
    evil = "<script>alert(1)</script>"
    for table in (candidates_table([Candidate("a", evil, 0.9, True, False)]), words_table({evil: {evil: 1.0}})):
        assert "<script" not in table
        assert "&lt;script" in table


def test_a_short_table_says_how_many_it_leaves_out() -> None:
    rows = [Candidate(str(k), f"thing {k}", 0.05, True, False) for k in range(20)]
    table = candidates_table(rows)
    assert table.count("<tr>") < 12
    assert "11 more" in table
    assert "55 %" in table


@pytest.mark.parametrize("type_", ["cube", "traffic cone", "drill", "fire hydrant"])
def test_a_body_fills_the_box_that_the_physics_gives_it(type_: str) -> None:
    corners = np.concatenate([np.reshape(part["vertices"], (-1, 3)) for part in json.loads(object_looks(type_, "red"))])
    assert corners.max(axis=0) - corners.min(axis=0) == pytest.approx(extent(type_), abs=2e-4)


def test_the_triangles_of_all_looks_join_their_vertices() -> None:
    for looks in (robot_looks(), object_looks("mailbox", "teal"), object_looks("no such type", "no such colour")):
        for part in json.loads(looks):
            assert len(part["vertices"]) == len(part["normals"])
            assert set(part["triangles"]) == set(range(len(part["vertices"]) // 3))
            assert all(0.0 <= value <= 1.0 for value in (*part["color"], part["opacity"]))


def test_other_machines_need_a_token() -> None:
    assert Address.checked("127.0.0.1", 1, None).token is None
    made = Address.checked("0.0.0.0", 1, None)
    assert made.token
    assert made.token != Address.checked("0.0.0.0", 1, None).token
    assert made.url(80) == f"http://0.0.0.0:80/?token={made.token}"
    assert Address.checked("0.0.0.0", 1, "mine").token == "mine"


def ask_gate(token: str | None, kind: str = "http", query: str = "", **headers: str) -> list[dict[str, Any]]:
    """What the gate sends; "passed" where it lets a request through."""
    sent: list[dict[str, Any]] = []

    async def behind(scope: Any, receive: Any, send: Any) -> None:
        sent.append({"passed": True})

    async def send(message: Any) -> None:
        sent.append(message)

    scope = {
        "type": kind,
        "path": "/",
        "query_string": query.encode(),
        "headers": [(name.encode(), value.encode()) for name, value in headers.items()],
    }
    asyncio.run(Gate(behind, token)(scope, None, send))  # type: ignore[arg-type]
    return sent


@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_the_gate_lets_in_who_has_the_token(kind: str) -> None:
    assert ask_gate("t0k", kind, cookie="dcg_torch_talk=t0k") == [{"passed": True}]
    for cookie in ("", "dcg_torch_talk=other", "dcg_torch_talk=", "dcg_torch_talk=t0\xe9", ";;="):
        assert {"passed": True} not in ask_gate("t0k", kind, cookie=cookie)
    answer = ask_gate("t0k", "http", query="token=t0k")
    assert answer[0]["status"] == 303
    assert b"dcg_torch_talk=t0k" in dict(answer[0]["headers"])[b"set-cookie"]
    assert ask_gate("t0k", "http", query="token=wrong")[0]["status"] == 403
    assert ask_gate("t0k", "websocket", query="token=wrong")[0]["type"] == "websocket.close"


@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_the_gate_of_this_machine_knows_its_names_only(kind: str) -> None:
    for name in ("127.0.0.1:8080", "localhost", "localhost:1", "[::1]:8080"):
        assert ask_gate(None, kind, host=name) == [{"passed": True}]
    for name in ("evil.example:8080", "", "127.0.0.1.evil.example"):
        assert {"passed": True} not in ask_gate(None, kind, host=name)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ("world=nowhere", "world=nowhere: take generated, a YAML file, or one of"),
        ("world=none.yaml", "none.yaml"),
        ("prot=80", "prot: there is no such setting; did you mean port?"),
        ("port=-1", "port=-1"),
        ("simulator=gazebo", "simulator"),
        ("host=no.such.host.invalid", "host=no.such.host.invalid"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(
    wrong: str, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    settings = ("open=false", f"session={tmp_path}/session.jsonl")
    status, out, err = typed(capsys, program.main, "dcg_torch.talk", *settings, wrong)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert says in err


@pytest.mark.parametrize("says", [(), ("turn left",)])
def test_a_talk_leaves_a_session_only_if_something_was_said(
    says: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    async def serve(host: Host) -> None:
        await host.begin()
        for text in says:
            host.say(text)
        await dealt_with(host)
        await host.end()

    monkeypatch.setattr(program, "serve", lambda host, address, show: asyncio.run(serve(host)))
    monkeypatch.chdir(tmp_path)
    register()  # as if an experiment had been in this process
    with socket.socket() as free:  # another test may listen where a talk does by default
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    status, _, err = typed(capsys, program.main, "dcg_torch.talk", "simulator=fake", "pace=0", f"port={port}")
    assert status == 0, err
    assert len(list(tmp_path.glob("runs/*/session.jsonl"))) == len(list(tmp_path.glob("runs/*"))) == len(says)


def test_the_page_needs_no_pybullet_for_the_fake_robot() -> None:
    code = """
import sys
sys.modules["pybullet"] = None  # as if it were not installed
from dcg_torch.apps.talk import looks, program
from dcg_torch.dialogue.session import Session
from dcg_torch.settings import TalkSettings
session = Session(program.world_of(TalkSettings()), simulator="fake")
print([looks.object_looks(thing.type, thing.color)[:1] for thing in session.world.objects], looks.robot_looks()[:1])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("['[', '[', '['] [\n", "")


def test_worlds_are_committed_generated_or_ones_own(tmp_path: Path, laboratory: World) -> None:
    assert program.world_of(TalkSettings()) == laboratory
    assert program.world_of(TalkSettings(world="world_03")).name == "world_03"
    one, two = (program.world_of(TalkSettings(world="generated", seed=seed)) for seed in (1, 2))
    assert one.objects != two.objects
