"""What a person's text does: a command, an answer, a lesson, a question, a motion, or nothing that the robot does."""

from __future__ import annotations

import functools
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

import yaml

from dcg_torch.interpretation.marks import heard
from dcg_torch.language import Parse, parse_command
from dcg_torch.language.lexicon import SETS
from dcg_torch.language.parser import MAX_CHARACTERS
from dcg_torch.language.tokens import tokens
from dcg_torch.speech_acts.requests import (
    Answer,
    Motion,
    Question,
    forgets_all,
    read_answer,
    read_forget,
    read_motion,
    read_question,
)
from dcg_torch.speech_acts.teaching import Teaching, read_teaching
from dcg_torch.types import Percept


@dataclass(frozen=True, slots=True)
class Stop:
    """Stop, or never mind."""


@dataclass(frozen=True, slots=True)
class Lesson:
    """A teacher's sentence."""

    teaching: Teaching


@dataclass(frozen=True, slots=True)
class Forget:
    """A word is to be forgotten; None: all that were learned."""

    word: str | None


@dataclass(frozen=True, slots=True)
class Refused:
    """No order about a thing, and nothing else that the robot does; what it answers."""

    text: str


Act = Stop | Answer | Lesson | Forget | Question | Motion | Parse | Refused
"""A `Parse` is a command, and has a tree."""


@functools.cache
def replies() -> Mapping[str, Any]:
    """The words for yes, no and other answers, of `data/replies.yaml`."""
    found: dict[str, Any] = yaml.safe_load(files(__package__).joinpath("data", "replies.yaml").read_text("utf-8"))
    return found


def is_stop(text: str) -> bool:
    """Does this text stop the robot at once ("stop", "halt!", "please wait")?"""
    return parse_command(text).refused in replies()["stop"]


def read_act(text: str, vocabulary: Collection[str], *, asked: bool, things: Iterable[Percept] = ()) -> Act:
    """What a text does.

    Args:
        vocabulary: the nouns known to the robot.
        asked: does a question of the robot wait for an answer?
        things: what has been seen, which may be called by its marks.
    """
    parse = heard(parse_command, text, vocabulary, things)
    if parse.refused in replies()["stop"]:
        return Stop()
    if len(text) > MAX_CHARACTERS:
        return Refused(f"I can't do that: {parse.problem}.")
    teaching = read_teaching(text)
    if forgets_all(text):
        return Forget(None)
    named = teaching is not None and (teaching.subject is not None or teaching.same_as is not None)
    answer = None if named or read_forget(text) else _answer(text, parse)
    if answer is not None and (asked or answer.yes is not None):
        return answer
    for read in (read_forget, read_teaching, read_motion, read_question):
        if (found := read(text)) is not None:
            if isinstance(found, str):
                return Forget(found)
            return Lesson(found) if isinstance(found, Teaching) else found
    if parse.tree is None:
        reason = parse.refused if tokens(text) else replies()["greeting"]  # "hello" is left out as a filler
        return Refused(replies()["refused"].get(reason) or f"I can't do that: {parse.problem}.")
    if parse.tree.phrase.words == ("be",) and not (SETS["commands"] | set(replies()["pointing_out"])) & set(
        tokens(text)
    ):
        return Refused(replies()["refused"][replies()["telling"]])
    return parse


def _answer(text: str, parse: Parse) -> Answer | None:
    """A text as an answer; None if it is an order, a question, or nothing that answers."""
    answer = read_answer(text)
    if answer is None or answer.phrase is None:
        return answer
    if parse.tree is not None and parse.tree.phrase.words not in ((), ("be",), ("mean",)):
        return None
    if read_question(text) or read_motion(text):
        return None
    own = parse_command(answer.phrase).tree
    return answer if own is not None and own.phrase.words == () else None
