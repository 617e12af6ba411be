"""Conversations with the robot in physics: slow, for everything is driven."""

from __future__ import annotations

import itertools
import json
import math
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image
from talking import play, script, transcript
from test_dialogue import LABORATORY, world_of

from dcg_torch.dialogue.events import Done, Event, Moved
from dcg_torch.dialogue.export import export_gif, replay
from dcg_torch.dialogue.session import Session
from dcg_torch.world.files import WorldObject, load_world

pytestmark = pytest.mark.slow


def test_the_script_in_physics_and_its_replay(tmp_path: Path) -> None:
    """As without physics; and a page that takes pictures meanwhile changes nothing."""
    file = tmp_path / "session.jsonl"
    session = Session(world_of("world_04"), file=file)
    played = play(session, script(), observe=lambda number: number % 120 or session.picture(width=64, height=36))
    session.close()
    wrong = {k: (p.turn, p.failures) for k, p in enumerate(played, start=1) if p.failures}
    assert len(wrong) <= 3, wrong
    for p in played:
        poses = [e.pose for e in p.events if isinstance(e, Moved)]
        for a, b in itertools.pairwise(poses):
            assert math.dist((a.x, a.y), (b.x, b.y)) < 0.05  # smooth: 0.65 m/s, 30 to a second
    again = [events for line, events in replay(file) if line.say is not None or line.click is not None]
    assert list(map(transcript, again)) == [transcript(p.events) for p in played]


def test_the_laboratory_demonstration_is_talked_through() -> None:
    session = Session(load_world(LABORATORY))
    for text, id_ in (
        ("move towards the cone", "cone"),
        ("move towards the cube", "cube"),
        ("move towards the crate", "crate"),
    ):
        done = session.say(text)[-1]
        assert isinstance(done, Done)
        (thing,) = [o for o in session.world.objects if o.id == id_]
        assert (done.object, done.result) == (id_, "arrived")
        stands = done.pose
        assert math.dist(thing.position, (session.pose.x, session.pose.y)) <= 0.5
    session.add_object(WorldObject(id="no", type="spaceship", color="red", position=(3.0, 3.0)))
    assert [o.id for o in session.world.objects] == ["cone", "cube", "crate"]  # the simulator has no such thing
    assert math.dist((stands.x, stands.y), (session.pose.x, session.pose.y)) < 1e-6
    session.close()


def test_a_session_is_animated(tmp_path: Path) -> None:
    session = Session(load_world(LABORATORY), file=tmp_path / "session.jsonl", simulator="fake")
    for text in ("what do you see?", "turn left", "go to the thing", "the blue one"):
        session.say(text)
    session.close()
    with Image.open(export_gif(tmp_path / "session.jsonl", tmp_path / "session.gif")) as picture:
        frames = getattr(picture, "n_frames", 0)
    assert picture.format == "GIF"
    assert frames > 5


_KILLED = """
import sys, time
from pathlib import Path
from dcg_torch.dialogue.session import Session
from dcg_torch.dialogue.events import Moved
from dcg_torch.world.files import load_world
session = Session(load_world(Path(sys.argv[1])), file=Path(sys.argv[2]))
session.say("turn left")
moves = []
def watch(event):
    moves.append(isinstance(event, Moved))
    if sum(moves) == 20:
        print("driving", flush=True)
        time.sleep(600)
session.say("go to the cube", watch=watch)
"""


def test_a_server_killed_in_the_middle_of_a_drive_comes_back(tmp_path: Path) -> None:
    file = tmp_path / "session.jsonl"
    command = [sys.executable, "-c", _KILLED, str(LABORATORY), str(file)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        assert server.stdout.readline() == "driving\n"
        os.kill(server.pid, signal.SIGKILL)
    assert [json.loads(line).get("say") for line in file.read_text().splitlines()][1:] == [
        "turn left",
        "go to the cube",
    ]
    events: list[Event] = []
    back = Session.open(file, events.append)
    unharmed = Session(load_world(LABORATORY))
    whole = (*unharmed.say("turn left"), *unharmed.say("go to the cube"))
    assert transcript(events) == transcript(whole)
    assert transcript(back.say("why did you go there?")) == transcript(unharmed.say("why did you go there?"))
    back.close()
    unharmed.close()
