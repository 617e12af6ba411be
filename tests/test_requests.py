"""What a person asks that is no order about a thing: motions, questions, words to forget, answers."""

from __future__ import annotations

import math

import pytest

from dcg_torch.dialogue.acts import Forget, Lesson, Refused, Stop, is_stop, read_act, replies
from dcg_torch.language import Parse
from dcg_torch.language.lexicon import REFUSALS
from dcg_torch.language.refusals import MOTION, NO_THING
from dcg_torch.speech_acts.requests import (
    Answer,
    Motion,
    Question,
    forgets_all,
    read_forget,
    read_motion,
    read_question,
)
from dcg_torch.storage.resources import resource
from dcg_torch.world.files import load_worlds

RIGHT = math.pi / 2


@pytest.mark.parametrize(
    ("text", "kind", "angle", "metres"),
    [
        ("turn left", "turn", RIGHT, 0),
        ("Turn to the right, please.", "turn", -RIGHT, 0),
        ("turn around", "turn", math.pi, 0),
        ("turn 45 degrees to the right", "turn", -RIGHT / 2, 0),
        ("turn half a circle", "turn", math.pi, 0),
        ("make a full turn", "turn", 2 * math.pi, 0),
        ("turn a quarter turn to the left", "turn", RIGHT, 0),
        ("drive two metres forward", "drive", 0, 2),
        ("go forward", "drive", 0, 1),
        ("drive 50 cm backwards", "drive", math.pi, 0.5),
        ("could you move half a metre to the left?", "drive", RIGHT, 0.5),
        ("drive 1.5m", "drive", 0, 1.5),
        ("reverse one meter", "drive", math.pi, 1),
        ("drive 10 km forward", "drive", 0, 10_000),
        ("go 20 inches back", "drive", math.pi, 0.508),
        ("move 10 yards ahead", "drive", 0, 9.144),
        ("drive -3 metres", "drive", math.pi, 3),
        ("drive -3 metres backwards", "drive", 0, 3),
        ("turn -90 degrees", "turn", -RIGHT, 0),
        ("come back", "return", 0, 0),
        ("go back to where you were", "return", 0, 0),
        ("return", "return", 0, 0),
        ("look around", "look", 0, 0),
    ],
)
def test_motions_that_name_no_thing(text: str, kind: str, angle: float, metres: float) -> None:
    found = read_motion(text)
    assert found is not None
    assert found.kind == kind
    assert (found.angle, found.metres) == pytest.approx((angle, metres))


@pytest.mark.parametrize(
    "text",
    [
        "go",
        "turn",
        "go to the cube",
        "turn to the cube",
        "come here",
        "turn 2 m",
        "turn the light on",
        "stop",
        "go to the back yard",
        "",
    ],
)
def test_what_is_no_bare_motion(text: str) -> None:
    assert read_motion(text) is None


@pytest.mark.parametrize(
    ("text", "kind", "about"),
    [
        ("what do you see?", "see", None),
        ("What can you see now?", "see", None),
        ("is there a mailbox?", "exists", "mailbox"),
        ("do you see any red things here?", "exists", "red things"),
        ("robot, where is the cone?", "where", "the cone"),
        ("how far away is the red cube?", "where", "the red cube"),
        ("how many cubes are there?", "count", "cubes"),
        ("what colour is the cube?", "color", "the cube"),
        ("what is a wug?", "meaning", "wug"),
        ("what does wug mean?", "meaning", "wug"),
        ("what's this?", "identify", None),
        ("what is behind you?", "identify", "behind you"),
        ("why did you go there?", "why", None),
        ("which words do you know?", "words", None),
        ("Which cup is next to the lamp?", "where", "cup next to the lamp"),
        ("what is the leftmost cup?", "where", "the leftmost cup"),
        ("which of these cups is red?", "where", "cups red"),
        ("which is the red cube?", "where", "the red cube"),
        ("where are you?", "place", None),
        ("what can you do?", "help", None),
    ],
)
def test_questions(text: str, kind: str, about: str | None) -> None:
    assert read_question(text) == Question(kind, about)


def test_a_word_to_forget_is_no_command_taken_back() -> None:
    assert (
        read_forget("forget wug")
        == read_forget("forget what a wug is")
        == read_forget("Forget the word 'wug'.")
        == "wug"
    )
    assert read_forget("forget it") is None
    assert forgets_all("Forget everything.")
    assert forgets_all("please forget all the words that you have learned")
    assert forgets_all("forget all words")
    assert not forgets_all("forget it")
    assert not forgets_all("forget everything behind the cube")
    assert read_act("forget everything", (), asked=True) == Forget(None)
    assert read_forget("drop the cube") is None


@pytest.mark.parametrize(
    ("text", "answer"),
    [
        ("yes", Answer(yes=True)),
        ("No.", Answer(yes=False)),
        ("none of them", Answer(yes=False)),
        ("the second one", Answer(ordinal=1)),
        ("the left one", Answer(phrase="the one on the left")),
        ("I mean the drill", Answer(phrase="the drill")),
        ("no, the red one please", Answer(phrase="the red one")),
        ("behind you", Answer(phrase="behind you")),
    ],
)
def test_answers_are_read_where_a_question_waits(text: str, answer: Answer) -> None:
    assert read_act(text, (), asked=True) == answer


def test_other_acts_are_read_where_a_question_waits() -> None:
    assert isinstance(read_act("go to the cube", (), asked=True), Parse)
    assert isinstance(read_act("no, that was the drill", (), asked=True), Lesson)
    assert isinstance(read_act("never mind", (), asked=True), Stop)
    assert isinstance(read_act("hello", (), asked=True), Refused)
    assert read_act("turn left", (), asked=True) == Motion("turn", RIGHT)
    assert read_act("forget wug", (), asked=True) == Forget("wug")
    assert read_act("what do you see?", (), asked=True) == Question("see")


def test_a_lesson_that_says_what_it_is_about_answers_no_question() -> None:
    assert isinstance(read_act("the thing on your left is called a gizmo", (), asked=True), Lesson)
    assert isinstance(read_act("a wug and a pylon are the same", (), asked=True), Lesson)


def test_every_command_of_the_worlds_is_a_command() -> None:
    worlds = load_worlds(resource("worlds"))
    texts = [command.text for world in worlds for command in (*world.commands, *world.relational)]
    assert len(texts) > 300
    assert [t for t in texts for asked in (False, True) if not isinstance(read_act(t, (), asked=asked), Parse)] == []


@pytest.mark.parametrize("text", ["stop", "Stop!", "halt", "please wait", "never mind"])
def test_what_stops_the_robot(text: str) -> None:
    assert is_stop(text)


@pytest.mark.parametrize("text", ["go to the cube", "stop at the cube", "turn left", "this is a stop sign", ""])
def test_what_does_not_stop_it(text: str) -> None:
    assert not is_stop(text)


def test_every_refusal_of_the_parser_has_a_reply() -> None:
    reasons = {reason for _, reason in REFUSALS} | {MOTION, NO_THING}
    assert reasons <= set(replies()["refused"])


def test_a_very_long_text_is_refused_at_once() -> None:
    assert isinstance(read_act("how many " * 5_000, (), asked=False), Refused)


def test_telling_is_no_order_and_pointing_out_is() -> None:
    assert isinstance(read_act("the weather is nice", (), asked=False), Refused)
    assert isinstance(read_act("There is a red cube behind you. Go to it.", (), asked=False), Parse)


@pytest.mark.parametrize(
    "text",
    [
        "which cup is on the table, bring it to me",
        "which cup is nearest? take it",
        "which room is the cup in",
        "what is the best way to the door",
    ],
)
def test_what_asks_for_no_thing_alone(text: str) -> None:
    assert read_question(text) is None
