"""The fit of choices: its value is what the factor graph says, its gradient that of differences, its optimum tells."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

from dcg_torch import GroundingModel, Percept, Pose, pretrained
from dcg_torch.grounding.choices import Choice, Likelihood, fit_choices
from dcg_torch.grounding.encoders import Encoders
from dcg_torch.language import parse_command
from dcg_torch.learning.landmarks import Lesson, fit_landmarks_em, parts_of
from dcg_torch.types import WorldModel


def scene(model: GroundingModel) -> WorldModel:
    seen = [
        Percept("a", "cube", "red", (2.0, 1.0, 0.0)),
        Percept("b", "cube", "red", (4.0, 0.0, 0.0)),  # straight: of what stands aslant more is measured than learned
        Percept("c", "cube", "blue", (2.0, -1.0, 0.0)),
        Percept("d", "sphere", "red", (4.0, 1.0, 0.0)),
        Percept("e", "sphere", "green", (5.0, 2.5, 0.0)),
    ]
    world = model.world_model(seen, Pose(0.0, 0.0), looked=True)
    return WorldModel(
        tuple(o for o in world.objects if not o.hypothetical), world.robot, world.speaker, world.places, unit=world.unit
    )


TEXTS: Sequence[tuple[str, set[str]]] = (
    ("go to the red cube", {"a"}),
    ("go to the cube behind the red cube", {"b"}),
    ("go to the leftmost cube", {"a"}),
    ("go to the sphere next to the green sphere", {"d"}),
    ("go to the cube that is not next to the sphere", {"c"}),
    ("go to the cubes", {"a", "b", "c"}),
)


def choice_of(model: GroundingModel, text: str, targets: set[str]) -> Choice:
    tree = parse_command(text, model.symbols.keys()).tree
    assert tree is not None
    found: list[Choice] = []

    def keep(choices: list[Choice], last: bool) -> None:
        found.append(choices[0])  # without those of its landmarks

    parts = parts_of(Lesson(tree, scene(model), frozenset(targets)))
    fit_landmarks_em(parts, Encoders(model.features), lambda: model.solve, keep, rounds=1)
    return found[0]


def likelihood_of(model: GroundingModel, said: Sequence[tuple[str, set[str]]]) -> Likelihood:
    own = [choice_of(model, text, targets) for text, targets in said]
    return Likelihood(own, model.features, model.factor, free=None, l2=0.3, prior=model.factor.weight.numpy())


# What is not next to the sphere is next to none of two: of these the graph takes the worst, and a fit weighs each.
@pytest.mark.parametrize(("text", "targets"), [t for t in TEXTS if len(t[1]) == 1 and " not " not in t[0]])
def test_the_value_is_the_probability_that_the_factor_graph_gives(
    model: GroundingModel, text: str, targets: set[str]
) -> None:
    likelihood = likelihood_of(model, [(text, targets)])
    tree = parse_command(text, model.symbols.keys()).tree
    assert tree is not None
    meant = model.ground(tree, scene(model)).probabilities[next(iter(targets))]
    assert likelihood(likelihood.start).value == pytest.approx(-math.log(meant), rel=0.05, abs=2e-3)


def test_the_value_of_a_set_is_that_each_is_described_and_no_other(model: GroundingModel) -> None:
    likelihood = likelihood_of(model, [("go to the cubes", {"a", "b", "c"})])
    tree = parse_command("go to the cubes", model.symbols.keys()).tree
    assert tree is not None
    fits = model.ground(tree, scene(model)).fits
    expected = sum(math.log(fits[i] if i in "abc" else 1.0 - fits[i]) for i in "abcde" if fits[i] > 1e-3 or i in "abc")
    assert likelihood(likelihood.start).value == pytest.approx(-expected, rel=0.05, abs=5e-3)


def test_the_value_of_several_is_the_sum_of_the_value_of_each(model: GroundingModel) -> None:
    """A set among things that are picked one at a time, in whatever order; where the weights are costs nothing."""
    alone = [likelihood_of(model, [one]) for one in TEXTS]
    for together in (likelihood_of(model, TEXTS), likelihood_of(model, TEXTS[::-1])):
        expected = sum(likelihood(likelihood.start).value for likelihood in alone)
        assert together(together.start).value == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("said", [*([one] for one in TEXTS), TEXTS])
def test_the_gradient_is_that_of_differences(model: GroundingModel, said: Sequence[tuple[str, set[str]]]) -> None:
    likelihood = likelihood_of(model, said)
    rng = np.random.default_rng(0)
    at = likelihood.start + 0.1 * rng.standard_normal(len(likelihood.start))
    for _ in range(5):
        way = rng.standard_normal(len(at))
        step = 1e-6
        slope = (likelihood(at + step * way).value - likelihood(at - step * way).value) / (2.0 * step)
        assert float(likelihood(at).gradient @ way) == pytest.approx(slope, rel=1e-5, abs=1e-6)


def test_a_choice_is_learned_and_the_weights_of_others_stay(model: GroundingModel) -> None:
    tree = parse_command("go to the outer cube", model.symbols.keys()).tree
    assert tree is not None
    world = scene(model)
    taught = pretrained()
    taught.teach([Lesson(tree, world, frozenset({"a"}))] * 20, rounds=1)
    before, after = model.ground(tree, world).probabilities, taught.ground(tree, world).probabilities
    assert after["a"] > 0.8 > before["a"]
    other = parse_command("go to the sphere behind the cube", model.symbols.keys()).tree
    assert other is not None
    assert taught.ground(other, world).object == model.ground(other, world).object


def test_nothing_to_choose_moves_nothing(model: GroundingModel) -> None:
    before = model.factor.weight.numpy().copy()
    fired = fit_choices(model.factor, [], model.features, free=None, l2=1.0, prior=before)
    assert not fired.any()
    assert (model.factor.weight.numpy() == before).all()
