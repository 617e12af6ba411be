"""Tables of phrases: kept from command to command while the weights are as they were, and no longer."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import torch
from making import command_tree, saw

from dcg_torch.grounding.patterns import Patterns
from dcg_torch.grounding.tables import Tables
from dcg_torch.model import GroundingModel
from dcg_torch.types import Child, Correspondence, Grounding, GroundingKind, Object

TREE = command_tree("cube", "red")


def test_what_is_kept_of_phrases_changes_no_answer(pupil: Callable[[], GroundingModel]) -> None:
    model = pupil()
    worlds = [saw(model, "red cube", "blue cube"), saw(model, "green sphere", "red cube"), saw(model, "red drill")]
    alone = [pupil().ground(TREE, world).probabilities for world in worlds]
    assert [model.ground(TREE, world).probabilities for world in worlds] == alone


def test_weights_that_are_changed_in_place_are_noticed(pupil: Callable[[], GroundingModel]) -> None:
    model = pupil()
    world = saw(model, "red cube", "blue sphere")
    before = model.ground(TREE, world).probabilities
    with torch.no_grad():
        model.factor.weight.zero_()
    found = model.ground(TREE, world).probabilities
    assert found != before
    assert len({round(p, 12) for p in found.values()}) == 1  # without weights all are equally probable


def test_a_retrained_model_answers_as_one_that_never_grounded(pupil: Callable[[], GroundingModel]) -> None:
    asked, silent = pupil(), pupil()
    world = saw(asked, "red cube", "red drill")
    asked.ground(TREE, world)
    for model in (asked, silent):
        model.correct("gizmo", "cube")
    assert asked.ground(TREE, world).probabilities == silent.ground(TREE, world).probabilities


def test_tables_hold_for_their_own_weights_alone(pupil: Callable[[], GroundingModel]) -> None:
    model, other = pupil(), pupil()
    tables = Tables(model.features, model.factor)
    assert tables.hold(model.features, model.factor)
    assert not tables.hold(other.features, model.factor)
    assert not tables.hold(model.features, other.factor)
    model.factor.set_weight(model.factor.weight.clone())
    assert not tables.hold(model.features, model.factor)


@pytest.mark.parametrize("kinds", [1, 2])
def test_patterns_tell_what_a_child_is_about(kinds: int) -> None:
    things = [Object(id_, "cube", True) for id_ in "abc"]
    children = [
        tuple(Child(Grounding(GroundingKind.OBJECT, things[j]), Correspondence.ACTIVE) for j in about)
        for about in ([(0,), (2,)] if kinds == 1 else [(0, 1), (2, 2)])
    ]
    patterns = Patterns({thing.id: j for j, thing in enumerate(things)})
    keys, (choice, grounding, special) = patterns.spread(children)
    which = np.repeat(np.array([[key[0]] for key in keys]), 3, axis=1)
    which[choice, grounding] = special
    assert [set(key) for key in keys] == [set(row) for row in which.tolist()]
    known = list(patterns.known)
    for row, own in zip(which, children, strict=True):
        for thing, number in zip(things, row.tolist(), strict=True):
            assert known[number][1] == tuple(child.grounding.object is thing for child in own)
    about = {child.grounding.object.id for own in children for child in own}
    assert {things[j].id for j in grounding.tolist()} == about
