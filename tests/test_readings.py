"""Readings of one command: their learned weights, and which of them lessons are taught in."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import cast

import numpy as np
import pytest

import dcg_torch
from dcg_torch import Percept, Pose
from dcg_torch.grounding.readings import Reading, sense, sum_over, worth_grounding
from dcg_torch.grounding.solution import Solution
from dcg_torch.language import parse_command
from dcg_torch.learning.landmarks import Lesson
from dcg_torch.learning.readings import in_meant_readings
from dcg_torch.lessons.relations import relational_lessons
from dcg_torch.model import GroundingModel
from dcg_torch.types import OPAQUE, PhraseKind, WorldModel

KITCHEN = [Percept("k", "kitchen", None, (4.0, 2.0, 0.0)), Percept("c", "cup", None, (2.0, -1.0, 0.0))]
SENTENCE = "go to the kitchen and take the cup"


@pytest.fixture(scope="module")
def world(model: GroundingModel) -> WorldModel:
    return model.world_model(KITCHEN, robot=None, looked=True)


def lessons(model: GroundingModel, world: WorldModel, meant: Sequence[str]) -> list[Lesson]:
    readings = tuple(worth_grounding(parse_command(SENTENCE), world, {}))
    return [Lesson(readings[0].tree, world, frozenset({id_}), 1.0, readings) for id_ in meant]


def grounded(model: GroundingModel, lesson: Lesson) -> list[Solution]:
    return [model.ground(reading.tree, lesson.world) for reading in lesson.readings]


def noun(reading: Reading) -> str | None:
    return next(node.phrase.noun for node in reading.tree.walk() if node.phrase.kind is PhraseKind.NOUN)


def test_of_two_orders_the_first_goal_is_likelier_and_a_way_past_something_is_none() -> None:
    assert parse_command(SENTENCE).noun == "kitchen"
    assert parse_command("approach the sofa and take the cup").noun == "sofa"
    assert parse_command("go past the cube and move to the cone").noun == "cone"
    assert parse_command("look at the table and pick up the cube").noun == "cube"
    assert parse_command("go to the sink. take the cup.").noun == "cup"


def test_weights_of_choices_are_at_the_maximum_of_the_penalised_likelihood(
    model: GroundingModel, world: WorldModel
) -> None:
    """The objective of the docstring, written out anew; no step along any weight makes it better."""
    told = lessons(model, world, ["c", "c", "c", "k"])
    _, weights = in_meant_readings(told, lambda one: grounded(model, one), {})
    rules = sorted({rule for r in told[0].readings for rule in r.rules})
    solutions = grounded(model, told[0])

    def value(of: dict[str, float]) -> float:
        total = -1.0 * sum(w * w for w in of.values())  # half of the penalty of 2
        scores = [
            r.log_weight + sense(s) + sum(of.get(rule, 0.0) for rule in r.rules)
            for r, s in zip(told[0].readings, solutions, strict=True)
        ]
        shares = np.exp(scores) / np.exp(scores).sum()
        for lesson in told:
            chance = [s.probabilities.get(next(iter(lesson.targets)), 0.0) for s in solutions]
            total += math.log(sum(p * (0.02 + 0.98 * c) for p, c in zip(shares, chance, strict=True)))
        return total

    best = value(weights)
    assert best > value({}) + 0.1
    for rule in rules:
        for step in (-0.05, 0.05):
            assert value({**weights, rule: weights.get(rule, 0.0) + step}) < best + 1e-6


def test_lessons_are_taught_in_the_reading_that_means_their_objects(model: GroundingModel, world: WorldModel) -> None:
    found, weights = in_meant_readings(
        lessons(model, world, ["c"] * 4 + ["k"]), lambda one: grounded(model, one), {"other=kept": 0.5}
    )
    nouns = [next(n.phrase.noun for n in one.tree.walk() if n.phrase.kind is PhraseKind.NOUN) for one in found]
    assert nouns == ["cup"] * 4 + ["kitchen"]
    assert weights["target=earlier_goal"] < 0.0 < weights["target=likeliest"]
    assert weights["other=kept"] == 0.5
    plain = replace(found[0], readings=())
    assert in_meant_readings([plain], lambda one: grounded(model, one), {}) == ([plain], {})


def test_learned_weights_choose_among_readings_and_are_saved(
    model: GroundingModel, world: WorldModel, tmp_path: Path
) -> None:
    assert model.ground(SENTENCE, world).object.id == "k"  # type: ignore[union-attr]
    taught = model.copy()
    taught.learner = taught.learner.with_readings({"target=earlier_goal": -3.0})
    assert taught.ground(SENTENCE, world).object.id == "c"  # type: ignore[union-attr]
    taught.save(tmp_path / "model")
    loaded = dcg_torch.load(tmp_path / "model")
    assert dict(loaded.learner.readings) == {"target=earlier_goal": -3.0}
    assert loaded.ground(SENTENCE, world).object.id == "c"  # type: ignore[union-attr]
    likely = worth_grounding(parse_command(SENTENCE), world, taught.learner.readings)
    assert noun(likely[0]) == "cup"
    assert [r.log_weight for r in likely] == sorted(r.log_weight for r in likely)[::-1]


def test_a_corpus_teaches_which_reading_is_meant(model: GroundingModel, world: WorldModel) -> None:
    taught = model.copy()
    taught.teach(lessons(model, world, ["c"] * 8), rounds=1)
    assert taught.learner.readings["target=earlier_goal"] < -0.2
    before, after = (one.ground(SENTENCE, world).probabilities["c"] for one in (model, taught))
    assert after > before


def test_what_is_taken_of_several_readings_has_the_runner_up_of_its_own(model: GroundingModel) -> None:
    cups = [Percept(f"cup {k}", "cup", None, (2.0, y, 0.0)) for k, y in enumerate((-1.0, 1.5))]
    seen = model.world_model([*KITCHEN[:1], *cups], robot=Pose(0.0, 0.0), looked=True)
    assert len(worth_grounding(parse_command(SENTENCE), seen, {})) > 1
    solution = model.ground(SENTENCE, seen)
    assert solution.tree is not None
    assert solution.runner_up is not None
    assert solution.runner_up == model.solve(solution.tree, solution.world).runner_up


def test_a_group_that_one_reading_alone_speaks_of_keeps_its_share(model: GroundingModel) -> None:
    cups = [Percept(f"c{k}", "cup", None, (2.0, 0.4 * k, 0.0)) for k in range(3)]
    world = model.world_model([*cups, Percept("k", "kettle", None, (1.0, 3.0, 0.0))], robot=None, looked=True)
    row, kettle = (model.ground(text, world) for text in ("go to the row of cups", "go to the kettle"))
    assert row.object is not None
    assert row.object.members
    assert kettle.world.groups == ()
    for first, second in ((row, kettle), (kettle, row)):
        found = sum_over([first, second], [0.1, 0.0])
        assert sum(found.probabilities.values()) == pytest.approx(1.0)
        assert set(found.probabilities) <= {o.id for o in found.world.meanable}
        assert found.probabilities[row.object.id] > 0.1


def test_an_unheard_noun_names_a_thing_and_hardly_a_place(model: GroundingModel) -> None:
    """ "The mailbox" is no edge and no corner: of its landmarks things have nearly all the weight."""
    things = [
        Percept("a", f"{OPAQUE}x", "red", (3.0, 2.0, 0.0)),
        Percept("b", f"{OPAQUE}y", "red", (3.0, -2.0, 0.0)),
        Percept("near a", "sphere", "blue", (3.2, 2.9, 0.0)),
        Percept("far", "sphere", "green", (-3.0, 0.0, 0.0)),
    ]
    solution = model.ground("go to the sphere closest to the mailbox", model.world_model(things, robot=Pose(0.0, 0.0)))
    modifier = solution.modifiers[0]
    scores = {combo[0].child.grounding.object.id: combo[0].log_score for combo in modifier.combos}
    places = np.logaddexp.reduce([s for id_, s in scores.items() if id_ not in {"a", "b"}])
    assert np.logaddexp.reduce([scores["a"], scores["b"]]) > places + math.log(4.0)
    assert solution.object is not None
    assert solution.object.id == "near a"


def test_lessons_name_landmarks_that_were_never_heard() -> None:
    told = relational_lessons(300)
    landmarks = [n.phrase.noun for one in told for n in list(one.tree.walk())[3:] if n.phrase.kind is PhraseKind.NOUN]
    unheard = {"drill", "mailbox", "fire hydrant", "door handle", "traffic cone"} & set(cast("list[str]", landmarks))
    assert len(unheard) >= 3
    classes = {o.type for one in told for o in one.world.objects if o.type is not None}
    assert all(kind in {"cube", "sphere", "cylinder"} or kind.startswith(OPAQUE) for kind in classes)
