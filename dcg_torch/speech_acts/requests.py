"""What a person asks of the robot that is no order about a thing: questions, words to forget, bare motions, answers."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib.resources import files
from typing import Any

import yaml

from dcg_torch.language.lexicon import NUMBERS, SETS
from dcg_torch.language.tokens import tokens


@dataclass(frozen=True, slots=True)
class Question:
    """A question to the robot.

    Attributes:
        kind: "see", "exists", "where", "count", "color", "identify", "meaning", "why", "words", "place" or "help".
        about: the noun phrase, or the word, that it is about; None: what is pointed at, or nothing.
    """

    kind: str
    about: str | None = None


@dataclass(frozen=True, slots=True)
class Motion:
    """A motion that names no thing.

    Attributes:
        kind: "turn" (in place), "drive", "return" (where it came from) or "look" (all round).
        angle: radians, left positive: how far it turns, or in which direction it drives.
        metres: how far it drives.
    """

    kind: str
    angle: float = 0.0
    metres: float = 0.0


@dataclass(frozen=True, slots=True)
class Answer:
    """An answer to "do you mean ...?".

    Attributes:
        yes: True for yes, False for no or none of them, None where it says neither.
        ordinal: which of those named in the question, from 0; -1 for the last.
        phrase: a noun phrase that describes the one meant.
    """

    yes: bool | None = None
    ordinal: int | None = None
    phrase: str | None = None


@functools.cache
def _data() -> Mapping[str, Any]:
    found: dict[str, Any] = yaml.safe_load(files(__package__).joinpath("data", "requests.yaml").read_text("utf-8"))
    return found


@functools.cache
def _patterns(name: str) -> tuple[tuple[re.Pattern[str], str], ...]:
    rows = [row if isinstance(row, list) else [row, name] for row in _data()[name]]
    return tuple((re.compile(pattern), kind) for pattern, kind in rows)


def read_question(text: str) -> Question | None:
    """The question that a text asks; None if it is none that the robot can answer."""
    said = _plain(text, _data()["fillers"])
    for pattern, kind in _patterns("questions"):
        if (found := pattern.fullmatch(said)) is not None:
            return Question(kind, " ".join(filter(None, found.groupdict().values())) or None)
    return None


def read_forget(text: str) -> str | None:
    """The word that the robot is to forget."""
    said = _plain(text, _data()["fillers"])
    for pattern, _ in _patterns("forget"):
        if (found := pattern.fullmatch(said)) is not None and found["word"] not in _data()["no_words"]:
            return found["word"].strip(" '\"")
    return None


def forgets_all(text: str) -> bool:
    """Is the robot to forget all words that it has learned?"""
    said = _plain(text, _data()["fillers"])
    return any(pattern.fullmatch(said) for pattern, _ in _patterns("forget_all"))


def read_answer(text: str) -> Answer | None:
    """What a text says if it answers a question; a phrase is only a guess, for the caller to parse."""
    data = _data()["answers"]
    said = _plain(text, _data()["fillers"])
    if said in data["yes"] or said in data["no"]:
        return Answer(yes=said in data["yes"])
    said = _plain(said.removeprefix("no ").removeprefix("yes "), data["fillers"])
    if said in data["yes"] or said in data["no"]:
        return Answer(yes=said in data["yes"])
    words = said.removeprefix("the ").removesuffix(" one").split()
    if len(words) == 1 and words[0] in data["ordinals"]:
        return Answer(ordinal=data["ordinals"][words[0]])
    return Answer(phrase=data["sides"].get(said, said)) if said else None


def _plain(text: str, fillers: list[str]) -> str:
    """Small letters, one kind of quotes, no stops at the ends, and none of some words at the beginning."""
    said = " ".join(text.lower().replace("\u2019", "'").replace(",", " ").split()).strip(" .!?'\"")
    said = re.sub(r"\b(what|where|who|that|how)'s\b", r"\1 is", said)
    while (found := next((f for f in fillers if said.startswith(f + " ")), None)) is not None:
        said = said[len(found) :].strip()
    while (found := next((f for f in _data()["endings"] if said.endswith(" " + f)), None)) is not None:
        said = said[: -len(found)].strip()
    return said


_STUCK = re.compile(r"(\d)([a-zA-Z]+)\b")  # "2m"
_MINUS = re.compile(r"(?<!\S)-(?=\d)")
_CLASSES = ("turn", "drive", "reverse", "come", "origin", "directions", "angles", "lengths", "parts")


def read_motion(text: str) -> Motion | None:
    """The motion that a text orders; None if there is any word in it that is none of a bare motion's."""
    data = _data()["motion"]
    slots: dict[str, list[str]] = {name: [] for name in _CLASSES}
    numbers: list[float] = []
    for word in tokens(_STUCK.sub(r"\1 \2", text)):
        if (number := _number(word)) is not None:
            numbers.append(number)
        elif word == "turn" and slots["turn"]:
            slots["angles"].append(word)  # "make a turn"
        elif found := [name for name in _CLASSES if word in data[name]]:
            slots[found[0]].append(word)
        elif word not in data["ignored"] and word not in SETS["fillers"]:
            return None
    if len(numbers) > 1 or len(slots["lengths"]) > 1:
        return None
    numbers += [data["parts"][word] for word in slots["parts"]]
    motion = _motion(slots, numbers[0] if numbers else None, data)
    return motion if motion is None or _MINUS.search(text) is None else _turned(motion)


def _turned(motion: Motion) -> Motion:
    """The other way: "drive -2 metres", "turn -90 degrees"."""
    if motion.kind == "drive":
        return replace(motion, angle=math.remainder(motion.angle + math.pi, math.tau))
    return replace(motion, angle=-motion.angle)


def _motion(slots: Mapping[str, list[str]], amount: float | None, data: Mapping[str, Any]) -> Motion | None:
    """The motion of the words, by their classes, and of the number, if there is one."""
    where = [math.radians(data["directions"][word]) for word in slots["directions"]]
    angle = max(where, key=abs) if where else None
    back = angle is not None and abs(angle) > math.radians(170.0)
    measured = amount is not None or bool(slots["lengths"])
    if slots["come"] or (slots["drive"] and back and not measured):
        return Motion("return") if back or "return" in slots["come"] else None
    if slots["origin"]:
        return None
    if slots["reverse"] or slots["drive"]:
        if angle is None and not measured and not slots["reverse"]:
            return None
        unit = data["lengths"][slots["lengths"][0]] if slots["lengths"] else 1.0
        return Motion(
            "drive", math.pi if slots["reverse"] else angle or 0.0, (1.0 if amount is None else amount) * unit
        )
    return _turn(slots, angle, amount, data)


def _turn(
    slots: Mapping[str, list[str]], angle: float | None, amount: float | None, data: Mapping[str, Any]
) -> Motion | None:
    """A motion in place."""
    if slots["turn"][:1] == ["look"] and {"around", "round"} & set(slots["directions"]):
        return Motion("look")
    if not slots["turn"] or slots["lengths"] or (angle is None and amount is None):
        return None
    if amount is None:
        return Motion("turn", angle or 0.0)
    units = slots["angles"] or (["circle"] if slots["parts"] else ["degrees"])
    return Motion("turn", math.copysign(math.radians(amount * data["angles"][units[0]]), angle or 1.0))


def _number(word: str) -> float | None:
    if word in NUMBERS:
        return float(NUMBERS[word])
    return float(word.replace(",", ".")) if re.fullmatch(r"\d+(?:[.,]\d+)?", word) else None
