"""Examples as sufficient statistics: their likelihood is that of encoding them anew, whatever was learned between."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from making import KNOWN, noun_phrase

from dcg_torch.fitting.design import DesignMatrix
from dcg_torch.fitting.fit import objective_at
from dcg_torch.fitting.psi import TERNARY, LogLinearFactor
from dcg_torch.grounding.encoding import encode
from dcg_torch.grounding.features import PAPER, Group
from dcg_torch.grounding.statistics import SoftLabels, Statistics
from dcg_torch.learning.commit_first import contrast, contrasts, with_meant
from dcg_torch.learning.learner import TrainingSet
from dcg_torch.model import GroundingModel, Variant
from dcg_torch.types import Correspondence, Example, Object, Symbol, WorldModel

GROUPS = [PAPER, PAPER | {Group.OPEN, Group.NAMES}, PAPER | {Group.RELATION, Group.OPEN, Group.NAMES}]


def agree(model: GroundingModel, one: Sequence[DesignMatrix], other: Sequence[DesignMatrix]) -> None:
    """They have one objective: value and gradient are the same at random weights."""
    factor = LogLinearFactor(model.features.pairs, TERNARY)
    factor.set_weight(np.random.default_rng(0).normal(size=factor.weight.shape) * model.features.pairs)
    found, wanted = (objective_at(factor, designs, 0.1) for designs in (one, other))
    assert found[0] == pytest.approx(wanted[0], rel=1e-12)
    assert found[1] == pytest.approx(wanted[1], abs=1e-9)


@pytest.mark.parametrize("groups", GROUPS, ids=["paper", "names", "relations"])
def test_it_is_the_likelihood_of_the_examples(training: TrainingSet, groups: frozenset[Group]) -> None:
    """Also after columns have grown, so that what was unknown is known, and when examples are gone or come anew."""
    model = GroundingModel.trained(training, Variant(groups=groups))
    examples, statistics = list(training.examples), Statistics(groups)
    features = model.features
    for change in ("first", "again", "a symbol more", "examples less", "an example more"):
        if change == "a symbol more":
            features = features.grow(Symbol("gizmo", "drill", "pink", "pink"))
            model.grow(features)
        if change == "examples less":
            examples = examples[7:]
        if change == "an example more":
            world = WorldModel((Object("d", "drill", True, color="pink"), Object("c", "cone", False, color="mauve")))
            examples.append(Example(noun_phrase("gizmo"), world, (Correspondence.ACTIVE, Correspondence.INACTIVE)))
        found = statistics.designs(examples, (), features, TERNARY)
        agree(model, found, encode(examples, features, TERNARY))


def test_a_copy_goes_its_own_way(training: TrainingSet) -> None:
    model = GroundingModel.trained(training)
    first, statistics = training.examples[:5], Statistics(PAPER)
    statistics.designs(first, (), model.features, TERNARY)
    other = statistics.copy()
    other.designs(training.examples, (), model.features.grow(Symbol("gizmo", "drill")), TERNARY)
    agree(model, statistics.designs(first, (), model.features, TERNARY), encode(first, model.features, TERNARY))


@pytest.mark.parametrize("groups", GROUPS, ids=["paper", "names", "relations"])
def test_soft_labels_are_two_examples_of_each_pair(training: TrainingSet, groups: frozenset[Group]) -> None:
    model = GroundingModel.trained(training, Variant(groups=groups))
    phrases = [noun_phrase("cube"), noun_phrase("gizmo"), noun_phrase("ball")]
    objects = [Object("a", "cube", True), Object("b", "drill", False, color="red"), Object("c", "sphere", True, True)]
    rng = np.random.default_rng(1)
    active, inactive, shown = rng.uniform(size=(3, 3)), rng.uniform(size=(3, 3)), rng.random((3, 3)) < 0.7
    examples = [
        Example(phrase, WorldModel((thing,)), (label,), weight=float(weights[p, o]))
        for p, phrase in enumerate(phrases)
        for o, thing in enumerate(objects)
        for label, weights in ((Correspondence.ACTIVE, active), (Correspondence.INACTIVE, inactive))
        if shown[p, o]
    ]
    soft = [SoftLabels(phrases, objects, active, inactive, shown)]
    statistics = Statistics(groups)
    for _ in range(2):
        found = statistics.designs((), soft, model.features, TERNARY)
        agree(model, found, encode(examples, model.features, TERNARY))


def test_contrasts_are_what_contrast_adds(training: TrainingSet) -> None:
    model = GroundingModel.trained(training)
    symbols = {word: Symbol(word, word) for word in KNOWN} | {"gizmo": Symbol("gizmo", "drill")}
    examples = [replace(e, weight=1.0 + k % 3) for k, e in enumerate(training.examples)]
    model.grow(model.features.grow(symbols["gizmo"]))
    apart = Statistics(PAPER).designs(examples, contrasts(with_meant({}, examples), symbols), model.features, TERNARY)
    together = encode([contrast(e, symbols) for e in examples], model.features, TERNARY)
    agree(model, apart, together)
