"""Conversations with the robot without physics: the script of sixty turns, its file, and what goes wrong."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from talking import Played, play, script, transcript

from dcg_torch.dialogue.events import Asked, Done, Learned, Moved, Said, Understood
from dcg_torch.dialogue.export import export_episodes, replay
from dcg_torch.dialogue.file import SessionError
from dcg_torch.dialogue.session import Session
from dcg_torch.dialogue.text import spoken
from dcg_torch.evaluation.episodes import read_episodes
from dcg_torch.storage.resources import resource
from dcg_torch.types import Percept
from dcg_torch.world.files import World, WorldObject, load_world

LABORATORY = next((resource("worlds") / "hardware").glob("*.yaml"))


@dataclass
class Talk:
    file: Path
    played: list[Played]


def world_of(name: str) -> World:
    return load_world(resource("worlds") / f"{name}.yaml")


@pytest.fixture(scope="module")
def talk(tmp_path_factory: pytest.TempPathFactory) -> Talk:
    """The script, played once."""
    file = tmp_path_factory.mktemp("talk") / "session.jsonl"
    session = Session(world_of("world_04"), file=file, simulator="fake")
    played = play(session, script())
    session.close()
    return Talk(file, played)


@pytest.fixture
def laboratory() -> Iterator[Session]:
    session = Session(load_world(LABORATORY), simulator="fake")
    yield session
    session.close()


def test_at_least_57_of_60_turns_come_out_as_expected(talk: Talk) -> None:
    assert len(talk.played) == 60
    wrong = {k: (p.turn, p.failures) for k, p in enumerate(talk.played, start=1) if p.failures}
    assert len(wrong) <= 3, wrong


def test_the_script_has_turns_of_all_kinds(talk: Talk) -> None:
    acts = {e.act for p in talk.played for e in p.events if isinstance(e, Understood)}
    assert acts == {"command", "answer", "lesson", "forget", "question", "motion", "stop", "refused"}


def test_the_first_answer_comes_before_the_robot_moves(talk: Talk) -> None:
    for p in talk.played:
        kinds = [type(event) for event in p.events]
        assert Moved not in kinds[: kinds.index(Understood)]
        assert kinds.count(Done) == 1
        assert kinds[-1] is Done


def test_no_move_is_longer_than_the_robot_is_quick(talk: Talk) -> None:
    """30 poses to a second: at 0.65 m/s and 2 rad/s a pose is at most so far from the one before."""
    for p in talk.played:
        poses = [p.before, *(e.pose for e in p.events if isinstance(e, Moved)), p.after]
        for a, b in itertools.pairwise(poses):
            assert math.dist((a.x, a.y), (b.x, b.y)) <= 0.65 / 30 + 1e-6
            assert abs(math.remainder(b.yaw - a.yaw, math.tau)) <= 2.0 / 30 + 1e-6


def test_a_session_replays_to_the_same_bytes(talk: Talk) -> None:
    again = [events for line, events in replay(talk.file) if line.say is not None or line.click is not None]
    assert list(map(transcript, again)) == [transcript(p.events) for p in talk.played]


def test_a_session_is_exported_as_episodes(talk: Talk, tmp_path: Path) -> None:
    count = export_episodes(talk.file, tmp_path / "episodes.jsonl")
    episodes = {e.text: e for e in read_episodes(tmp_path / "episodes.jsonl")}
    assert count == len(episodes) > 10
    assert episodes["go to the cube"].target == ("red_cube",)  # as the person answered
    assert episodes["go to the red mailbox"].target == ()
    assert "go to the mailbox" not in episodes  # it was stopped
    assert "pick up the blue cube" not in episodes  # "no, that was the block"


def test_a_killed_session_comes_back_without_the_line_that_was_cut_short(talk: Talk, tmp_path: Path) -> None:
    lines = talk.file.read_bytes().splitlines(keepends=True)
    file = tmp_path / "killed.jsonl"
    file.write_bytes(b"".join(lines[:9]) + lines[9][:-7])
    session = Session.open(file)
    assert file.read_bytes() == b"".join(lines[:9])
    ninth = session.say(json.loads(lines[9])["say"])
    assert transcript(ninth) == transcript(talk.played[8].events)
    with pytest.raises(SessionError, match="another process has this session"):
        Session.open(file)
    session.close()
    assert file.read_bytes() == b"".join(lines[:10])


def test_an_input_is_on_disk_before_anything_comes_of_it(tmp_path: Path) -> None:
    session = Session(load_world(LABORATORY), file=tmp_path / "s.jsonl", simulator="fake")
    held: list[str] = []
    session.say("turn left", watch=lambda _: held.append((tmp_path / "s.jsonl").read_text().splitlines()[-1]))
    session.close()
    assert set(held) == {'{"say": "turn left"}'}


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda lines: [], "holds no session"),
        (lambda lines: [b"{}\n"], "line 1"),
        (lambda lines: [lines[0].replace(b'"sha256": "', b'"sha256": "0'), *lines[1:]], "not what it was"),
        (lambda lines: [*lines[:2], b'{"clik": "cone"}\n'], "line 3.*did you mean click"),
        (lambda lines: [*lines[:2], b'{"say": "a", "click": "b"}\n'], "line 3.*has one of"),
        (lambda lines: [*lines[:2], b"\xff\n"], "UTF-8"),
    ],
)
def test_a_damaged_file_is_named_in_one_line(talk: Talk, tmp_path: Path, change: object, says: str) -> None:
    file = tmp_path / "damaged.jsonl"
    file.write_bytes(b"".join(change(talk.file.read_bytes().splitlines(keepends=True))))  # type: ignore[operator]
    with pytest.raises(SessionError, match=says) as raised:
        Session.open(file)
    assert "\n" not in str(raised.value)


def test_a_file_that_is_there_is_not_written_over(talk: Talk) -> None:
    with pytest.raises(SessionError, match="there already"):
        Session(load_world(LABORATORY), file=talk.file, simulator="fake")


def test_the_laboratory_demonstration_is_talked_through(laboratory: Session) -> None:
    """The paper's three commands, from where the robot stands each time, with the shipped model."""
    results = []
    for text in ("move towards the cone", "move towards the cube", "move towards the crate"):
        done = laboratory.say(text)[-1]
        assert isinstance(done, Done)
        results.append((done.object, done.result))
    assert results == [("cone", "arrived"), ("cube", "arrived"), ("crate", "arrived")]
    assert {word: max(of, key=lambda t: of[t]) for word, of in laboratory.words().items()} == {
        "cone": "traffic cone",
        "crate": "crate",
    }
    assert "crate" in spoken(laboratory.say("why did you go there?"))[0]
    assert laboratory.reasons()


def test_it_remembers_what_it_saw_and_looks_no_second_time(laboratory: Session) -> None:
    laboratory.say("look around")
    seen = {p.id: p for p in laboratory.memory}
    assert set(seen) == {"cone", "cube", "crate"}
    events = laboratory.say("is there a cube?")
    assert not any(isinstance(e, Moved) for e in events)
    assert spoken(events)[0].startswith("Yes")


def test_what_is_moved_by_hand_is_forgotten_until_it_is_seen_again(laboratory: Session) -> None:
    laboratory.say("look around")
    laboratory.move_object("cube", (2.5, -0.3))
    laboratory.say("go to the cube")
    (cube,) = [p for p in laboratory.memory if p.id == "cube"]
    assert isinstance(cube, Percept)
    assert cube.position[:2] == (2.5, -0.3)
    assert math.dist((laboratory.pose.x, laboratory.pose.y), (2.5, -0.3)) < 0.51


def test_a_stop_takes_effect_with_the_next_move(laboratory: Session) -> None:
    moves = []

    def watch(event: object) -> None:
        if isinstance(event, Moved):
            moves.append(event.pose)
            if len(moves) == 30:
                laboratory.stop()

    events = laboratory.say("drive two metres forward", watch=watch)
    assert len(moves) == 30
    assert laboratory.pose == moves[-1]
    assert Said("I stopped.") in events
    assert not any(isinstance(e, Moved) for e in laboratory.say("what do you see?"))
    assert any(isinstance(e, Moved) for e in laboratory.say("turn left"))


def test_a_question_is_answered_by_words_or_a_click_and_else_dropped(laboratory: Session) -> None:
    for answer in ("the brown one", "the last one", "no, the crate"):
        laboratory.say("look around")
        asked = next(e for e in laboratory.say("go to the thing") if isinstance(e, Asked))
        assert set(asked.candidates) == {"cone", "cube", "crate"} == set(laboratory.question)
        done = laboratory.say(answer)[-1]
        assert isinstance(done, Done)
        assert done.object == ("crate" if answer != "the last one" else asked.candidates[-1])
    laboratory.say("go to the thing")
    done = laboratory.click("cone")[-1]
    assert isinstance(done, Done)
    assert (done.object, laboratory.question) == ("cone", ())
    laboratory.say("go to the thing")
    laboratory.say("turn left")
    assert laboratory.question == ()


def test_what_is_not_there_is_said_and_teaches_nothing(laboratory: Session) -> None:
    events = laboratory.say("go to the red sphere")
    done = events[-1]
    assert isinstance(done, Done)
    assert done.result == "absent"
    assert Said("There is no red sphere here.") in events
    assert not any(isinstance(event, Learned) for event in events)
    assert laboratory.words() == {}


@pytest.mark.parametrize("word", ["pallet", "cube"])
def test_a_lesson_that_changes_a_meaning_says_so(laboratory: Session, word: str) -> None:
    if word == "pallet":  # "cube" it knows from the start
        assert "I will remember that." in spoken(laboratory.say("this is a pallet", pointing_at="cube"))
    before = "cube"
    changed = spoken(laboratory.say(f"this is a {word}", pointing_at="cone"))
    assert any(f'Until now I took "{word}" for what my camera calls "{before}"' in line for line in changed), changed
    assert "I will remember that." in spoken(laboratory.say(f"this is a {word}", pointing_at="cone"))


def test_the_unclear_thing_of_a_lesson_is_asked_for(laboratory: Session) -> None:
    asked = next(e for e in laboratory.say("the thing behind you is called a wug") if isinstance(e, Asked))
    assert set(asked.candidates) == {"cube", "crate"}
    assert Learned("wug", "crate", "told") in laboratory.click("crate")


def test_changes_of_the_world_that_cannot_be_are_answered_with_a_sentence(laboratory: Session) -> None:
    again = WorldObject(id="cone", type="cube", color="red", position=(3.0, 3.0))
    for events in (laboratory.remove_object("no"), laboratory.click("no"), laboratory.add_object(again)):
        assert [type(event) for event in events] == [Said, Done]
    for id_ in ("cone", "cube", "crate"):
        last = laboratory.remove_object(id_)
    assert isinstance(last[0], Said)
    assert [o.id for o in laboratory.world.objects] == ["crate"]


@pytest.mark.parametrize(
    "text", ["", "   ", "?", "\ud800", "a" * 5_000, "go\nto\tthe\x00cube", "🤖", "the the the", "'"]
)
def test_any_text_has_an_answer(laboratory: Session, text: str) -> None:
    events = laboratory.say(text)
    assert any(isinstance(event, Understood) for event in events)
    assert not any("went wrong" in sentence for sentence in spoken(events))


def test_a_world_and_a_model_are_saved_and_loaded(laboratory: Session, tmp_path: Path) -> None:
    laboratory.say("this is a pallet", pointing_at="crate")
    laboratory.save_model(tmp_path / "model")
    laboratory.save_world(tmp_path / "world.yaml")
    again = Session(load_world(tmp_path / "world.yaml"), tmp_path / "model", simulator="fake")
    assert again.pose == laboratory.pose
    done = again.say("go to the pallet")[-1]
    assert isinstance(done, Done)
    assert (done.object, done.result) == ("crate", "arrived")
    again.close()


def test_a_conversation_in_plain_text(laboratory: Session) -> None:
    laboratory.say("this is a box", pointing_at="crate")
    assert spoken(laboratory.click("crate"))[-1] == "It is a brown box."


@pytest.mark.parametrize(
    ("text", "id_", "says"),
    [
        ("where is pepsi?", "pepsi block", "the pepsi is"),
        ("what colour is the bmw?", "bmw block", "the bmw is blue"),
        ("is there a starbucks?", "starbucks block", "yes"),
        ("is there a heineken block?", None, "no, there is no heineken block"),
    ],
)
def test_questions_know_what_is_written_on_things(text: str, id_: str | None, says: str) -> None:
    types = ("shell block", "pepsi block", "bmw block", "starbucks block")
    things = [
        {"id": type_, "type": type_, "color": "red" if k % 2 else "blue", "position": (2.0, 0.5 * k - 0.75)}
        for k, type_ in enumerate(types)
    ]
    session = Session(World.model_validate({"name": "marks", "objects": things, "commands": []}), simulator="fake")
    done = session.say(text)
    session.close()
    assert isinstance(done[-1], Done)
    assert done[-1].object == id_
    assert says in " ".join(spoken(done)).lower()


def test_all_words_are_forgotten_but_those_known_from_the_start(laboratory: Session) -> None:
    assert "no word yet" in spoken(laboratory.say("forget everything"))[0]
    laboratory.say("go to the cone")
    laboratory.say("the blue cube is called a wug")
    assert {"cone", "wug"} <= {e.word for e in laboratory.model.lexicon()}
    said = spoken(laboratory.say("forget all the words you have learned"))
    assert said[-1] == "I have forgotten them."
    assert {e.word for e in laboratory.model.lexicon()} == {"cube", "sphere", "cylinder"}
    assert "no other word" in spoken(laboratory.say("which words do you know?"))[0]
