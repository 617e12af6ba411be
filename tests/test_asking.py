"""Questions: when, and that every description fits exactly one object."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dcg_torch.agent.asking import Answer, Asking, Question, candidates, describe, places, question, truthful
from dcg_torch.grounding.graph import Solution
from dcg_torch.types import Object, ParseTree, Percept, Phrase, PhraseKind, Pose, WorldModel

START = Pose(0.0, 0.0, 0.0)
NAMES = {"cube": "cube", "sphere": "ball"}


def thing(id_: str, type_: str, color: str, x: float, y: float) -> Percept:
    return Percept(id_, type_, color, (x, y, 0.0))


def grounded(**probabilities: float) -> Solution:
    objects = tuple(Object(k, "cube", True, hypothetical=k.startswith("h_")) for k in probabilities)
    return Solution(ParseTree(Phrase(PhraseKind.NOUN, "x")), WorldModel(objects), None, probabilities)


def test_it_asks_only_when_unsure() -> None:
    asking = Asking(below=0.8, least=0.05)
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


@settings(max_examples=60)
@given(st.integers(0, 10**6), st.integers(2, 12))
def test_every_description_fits_one_object_alone(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    world = [
        thing(
            str(k),
            str(rng.choice(["cube", "sphere", "drill"])),
            str(rng.choice(["red", "blue"])),
            *rng.uniform(-4, 4, 2),
        )
        for k in range(count)
    ]
    texts = [describe(p, world, START, NAMES) for p in world]
    for p, (_, where) in zip(world, texts, strict=True):
        alike = [o for o in world if o.color == p.color and NAMES.get(p.type) in (None, NAMES.get(o.type))]
        if not where:
            assert alike == [p]
            continue
        # where it is said by a relation, the relation's own test picks out this object
        for said, fits in places(p, world, alike, START, NAMES):
            if said == where:
                assert [o.id for o in alike if fits(o)] == [p.id]
                break
        else:
            assert where.endswith(("left", "right"))
    assert len(set(texts)) == count


def test_the_speaker_tells_the_truth() -> None:
    listener = truthful("b")
    asked = Question("Do you mean this, or that?", ("a", "b"))
    assert listener(asked) == Answer("b")
    assert listener(asked).text(asked) == "the second one"
    assert listener(Question("Do you mean this?", ("a",))) == Answer(None)
    assert Answer(None).text(Question("", ("a",))) == "no"
    assert Answer(None).text(asked) == "none of them"


def test_left_is_left_of_the_heading() -> None:
    world = [thing("a", "drill", "blue", 2.0, 0.0), thing("b", "drill", "blue", -2.0, 0.0)]
    assert describe(world[0], world, Pose(0.0, 0.0, -math.pi / 2), NAMES)[1] == "on my left"
    assert describe(world[1], world, Pose(0.0, 0.0, -math.pi / 2), NAMES)[1] == "on my right"


@pytest.mark.parametrize("least", [0.0, 0.3])
def test_the_most_probable_come_first(least: float) -> None:
    found = candidates(grounded(a=0.2, b=0.5, c=0.3), Asking(below=0.9, least=least, options=3))
    assert list(found) == ["b", "c", "a"][: len(found)]
    assert len(found) == (3 if least == 0.0 else 2)
