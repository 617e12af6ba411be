"""Questions: when, and that every description fits exactly one object."""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from dcg_torch.agent.asking import AskingPolicy, Question, Reply, candidates, describe, question, truthful
from dcg_torch.grounding.solution import Solution
from dcg_torch.types import Object, ParseTree, Percept, Phrase, PhraseKind, Pose, WorldModel
from dcg_torch.types.geometry import NEXT_TO

START = Pose(0.0, 0.0, 0.0)
NAMES = {"cube": "cube", "sphere": "ball"}


def thing(id_: str, type_: str, color: str, x: float, y: float) -> Percept:
    return Percept(id_, type_, color, (x, y, 0.0))


def grounded(**probabilities: float) -> Solution:
    objects = tuple(Object(k, "cube", True, hypothetical=k.startswith("h_")) for k in probabilities)
    return Solution(ParseTree(Phrase(PhraseKind.NOUN, "x")), WorldModel(objects), None, probabilities)


def test_it_asks_only_when_unsure() -> None:
    asking = AskingPolicy(below=0.8, least=0.05)
    assert candidates(grounded(a=0.9, b=0.1), asking) == ()
    assert candidates(grounded(a=0.3, b=0.6, c=0.01, h_x=0.09), asking) == ("b", "a")
    assert candidates(grounded(h_x=1.0), asking) == ()


def test_a_question_reads_like_one() -> None:
    world = [
        thing("a", "drill", "blue", 0.0, 2.0),
        thing("b", "cone", "blue", 3.0, -2.2),
        thing("c", "cube", "red", 3.0, -1.0),
        thing("d", "cube", "green", -2.0, 0.0),
    ]
    asked = question(["a", "b", "c"], world, START, NAMES)
    assert asked.text == "Do you mean the blue thing on my left, the one in front of me, or the red cube?"
    assert asked.candidates == ("a", "b", "c")
    assert question(["d"], world, START, NAMES).text == "Do you mean the green cube?"


def test_a_landmark_is_named() -> None:
    world = [
        thing("a", "drill", "blue", 3.0, 0.2),
        thing("b", "cone", "blue", 6.0, 0.0),
        thing("c", "cube", "red", 3.0, 1.0),
    ]
    assert describe(world[0], world, START, NAMES) == ("the blue thing", "next to the red cube")


def understood(what: str, where: str, world: Sequence[Percept], start: Pose) -> list[str]:
    """The oracle: which things a listener takes a description for, from its words alone."""
    _, *color, noun = what.split()
    alike = [p for p in world if (not color or p.color == color[0]) and noun in ("thing", NAMES.get(p.type))]
    seen = {p.id: (complex(*p.position[:2]) - complex(start.x, start.y)) / cmath.rect(1.0, start.yaw) for p in world}
    sides = {"in front of me": 1, "on my left": 1j, "on my right": -1j, "behind me": -1}
    if where in sides:
        return [p.id for p in alike if abs(math.degrees(cmath.phase(seen[p.id] / sides[where]))) < 40]
    if where.startswith("next to "):
        (mark,) = understood(where.removeprefix("next to "), "", world, start)
        return [p.id for p in alike if p.id != mark and abs(seen[p.id] - seen[mark]) <= NEXT_TO]
    if where in ("closest to me", "farthest from me"):
        ranked = sorted(alike, key=lambda p: abs(seen[p.id]), reverse=where.startswith("farthest"))
        return [ranked[0].id] if abs(abs(seen[ranked[0].id]) - abs(seen[ranked[1].id])) > 0.3 else []
    if measured := re.fullmatch(r"([\d.]+) m (in front of|behind) me and ([\d.]+) m to the (left|right)", where):
        ahead, depth, left, side = measured.groups()
        said = (ahead, depth == "in front of", left, side == "left")
        exact = len(ahead.partition(".")[2])  # decimals that are said
        measures = {
            id_: (f"{abs(z.real):.{exact}f}", z.real >= 0, f"{abs(z.imag):.{exact}f}", z.imag >= 0)
            for id_, z in seen.items()
        }
        return [p.id for p in alike if measures[p.id] == said]
    if quarter := re.fullmatch(r"(in front of|behind) me to the (left|right)", where):
        ahead_and_left = (quarter.group(1) == "in front of", quarter.group(2) == "left")
        return [p.id for p in alike if (seen[p.id].real > 0, seen[p.id].imag > 0) == ahead_and_left]
    assert where == "", f"a listener does not understand {where!r}"
    return [p.id for p in alike]


@settings(max_examples=60)
@given(st.integers(0, 10**6), st.integers(2, 12), st.floats(-3.0, 3.0))
@example(554984, 8, 2.5)  # two things five centimetres apart
def test_a_listener_understands_every_description_as_one_object(seed: int, count: int, yaw: float) -> None:
    rng = np.random.default_rng(seed)
    kinds, colors = ["cube", "sphere", "drill"], ["red", "blue"]
    world = [
        thing(str(k), str(rng.choice(kinds)), str(rng.choice(colors)), *rng.uniform(-4, 4, 2)) for k in range(count)
    ]
    start = Pose(0.5, -0.5, yaw)
    for p in world:
        assert understood(*describe(p, world, start, NAMES), world, start) == [p.id]


@pytest.mark.parametrize(
    ("x", "y", "where"),
    [
        (2.0, 0.0, "in front of me"),
        (-2.0, 0.2, "behind me"),
        (0.0, 2.0, "on my left"),
        (0.1, -2.0, "on my right"),
        (2.0, 2.0, "in front of me to the left"),
        (-2.0, -2.0, "behind me to the right"),
    ],
)
def test_where_a_thing_stands_is_said_from_the_start(x: float, y: float, where: str) -> None:
    # the others surround it at about the same distance, so that neither the closest nor the farthest can be said
    others = [(2.0, 0.0), (-2.0, 0.2), (0.0, 2.0), (0.1, -2.0), (2.0, 2.0), (-2.0, -2.0)]
    world = [thing("it", "drill", "blue", x, y)]
    world += [thing(f"o{k}", "drill", "blue", *o) for k, o in enumerate(others) if o != (x, y)]
    assert describe(world[0], world, Pose(0.0, 0.0, 0.0), NAMES) == ("the blue thing", where)


def test_the_speaker_tells_the_truth() -> None:
    listener = truthful("b")
    asked = Question("Do you mean this, or that?", ("a", "b"))
    assert listener(asked) == Reply("b")
    assert listener(asked).text(asked) == "the second one"
    assert listener(Question("Do you mean this?", ("a",))) == Reply(None)
    assert Reply(None).text(Question("", ("a",))) == "no"
    assert Reply(None).text(asked) == "none of them"


def test_left_is_left_of_the_heading() -> None:
    world = [thing("a", "drill", "blue", 2.0, 0.0), thing("b", "drill", "blue", -2.0, 0.0)]
    assert describe(world[0], world, Pose(0.0, 0.0, -math.pi / 2), NAMES)[1] == "on my left"
    assert describe(world[1], world, Pose(0.0, 0.0, -math.pi / 2), NAMES)[1] == "on my right"


@pytest.mark.parametrize("least", [0.0, 0.3])
def test_the_most_probable_come_first(least: float) -> None:
    found = candidates(grounded(a=0.2, b=0.5, c=0.3), AskingPolicy(below=0.9, least=least, options=3))
    assert list(found) == ["b", "c", "a"][: len(found)]
    assert len(found) == (3 if least == 0.0 else 2)
