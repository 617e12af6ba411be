"""Tables of phrases: kept from command to command while the weights are as they were, and no longer."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import torch
from making import command_tree, noun_phrase, saw

from dcg_torch import scene
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.features import PAPER, Group, padded
from dcg_torch.grounding.patterns import Spread
from dcg_torch.grounding.tables import Tables
from dcg_torch.learning.learner import TrainingSet
from dcg_torch.model import GroundingModel, Variant
from dcg_torch.scene.ranks import RANKS
from dcg_torch.types import Child, Correspondence, Grounding, GroundingKind, Object

TREE = command_tree("cube", "red")


def test_what_is_kept_of_phrases_changes_no_answer(pupil: Callable[[], GroundingModel]) -> None:
    model = pupil()
    worlds = [saw(model, "red cube", "blue cube"), saw(model, "green sphere", "red cube"), saw(model, "red drill")]
    alone = [pupil().ground(TREE, world).probabilities for world in worlds]
    assert [model.ground(TREE, world).probabilities for world in worlds] == alone


def test_a_plain_command_asks_for_no_layout_of_the_scene(
    pupil: Callable[[], GroundingModel], monkeypatch: pytest.MonkeyPatch
) -> None:
    model = pupil()
    world = saw(model, "red cube", "blue cube")
    monkeypatch.setattr(scene, "layout", None)
    found = model.ground(TREE, world).object
    assert found is not None
    assert (found.type, found.color) == ("cube", "red")


@pytest.mark.parametrize("weighed", [False, True])
def test_only_ranks_that_a_word_weighs_are_worked_out(training: TrainingSet, weighed: bool) -> None:
    model = GroundingModel.trained(training, Variant(groups=PAPER | {Group.RELATION}, hypothetical=False))
    features, said = model.features, noun_phrase("cube", words=("left",))
    with torch.no_grad():
        own = model.factor.weight[:, features.language["word: left"]]
        own[:, [features.grounding[name] for name in RANKS]] = 0.0
        own[0, features.grounding["rank: left 1"]] = float(weighed)
    encoder = WorldEncoder(features, saw(model, "red cube", "blue cube"))
    tables = Tables(features, model.factor)
    table = tables.noun(encoder, said)
    assert np.array_equal(table, tables.unranked(encoder, said)) is not weighed
    assert bool(encoder._ranked) is weighed


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


@pytest.mark.parametrize("about", [((0,), (2,)), ((0, 1), (2, 2), (1, 0))])
def test_a_region_is_scored_as_all_its_factors_one_by_one(
    about: tuple[tuple[int, ...], ...], pupil: Callable[[], GroundingModel]
) -> None:
    model = pupil()
    tables, phrase = Tables(model.features, model.factor), command_tree("cube", "red").phrase
    things = [Object(id_, "cube", True) for id_ in "abc"]
    correspondences = model.factor.correspondences
    inactive = correspondences.index(Correspondence.INACTIVE)
    meant = [k for k in range(len(correspondences)) if k != inactive]
    spread = Spread(tables, phrase, GroundingKind.ACTION, len(things))
    for own in about:
        children = tuple(Child(Grounding(GroundingKind.OBJECT, things[j]), Correspondence.ACTIVE) for j in own)
        columns = [
            model.features.action_columns(GroundingKind.ACTION, children, [j == a for a in own]) for j in range(3)
        ]
        language = model.features.encode_phrases([phrase])
        one_by_one = model.factor.log_psi(language, padded(columns), np.zeros(3, dtype=np.int64)).numpy()
        of_each = one_by_one[:, inactive].sum() + one_by_one[:, meant] - one_by_one[:, [inactive]]
        first, *others = spread.of(children, own)
        for j, row in zip(dict.fromkeys(own), others, strict=True):
            assert row == pytest.approx(of_each[j], abs=1e-12)
        for j in {0, 1, 2} - {*own}:
            assert first == pytest.approx(of_each[j], abs=1e-12)
