"""Towers and rows of several colours. All commands here were written for this project."""

from __future__ import annotations

import itertools

import asked
import numpy as np
import pytest

from dcg_torch.grounding.hypotheses import Hypothesis
from dcg_torch.grounding.solution import Solution
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import (
    Child,
    Correspondence,
    Grounding,
    GroundingKind,
    Object,
    ParseTree,
    Percept,
    Phrase,
    PhraseKind,
    WorldModel,
)

STEP = 0.15
COLORS = ("red", "green", "blue", "yellow")
SPOTS = ((1.3, 0.45), (1.3, -0.45), (1.9, 0.45), (1.9, -0.45), (2.2, 0.0), (1.6, 0.0))


def on_towers(pairs: list[tuple[str, str]], seed: int) -> list[Percept]:
    """A cylinder on each of so many towers, whose things have two colours, both of them, in any order."""
    rng = np.random.default_rng(seed)
    things = []
    for k, (pair, (x, y)) in enumerate(zip(pairs, SPOTS, strict=False)):
        colors = [*pair, *rng.choice(pair, int(rng.integers(0, 2)))]
        rng.shuffle(colors)
        for level, color in enumerate(colors):
            things.append(Percept(f"t{k} {level}", "cube", color, (x, y, STEP * level), (STEP,) * 3))
        things.append(Percept(f"top {k}", "cylinder", "gray", (x, y, STEP * len(colors)), (STEP,) * 3))
    return things


def meant(text: str, things: list[Percept]) -> set[str]:
    return asked.meant(text, things, workspace=Workspace((1.0, 2.5, -0.75, 0.75), STEP))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    "way", ["{}-{} tower", "{} and {} tower", "{} and {} stack of cubes", "tower of {} and {} cubes"]
)
def test_a_tower_of_two_colours_has_these_and_no_others(seed: int, way: str) -> None:
    """Each pair of four colours has a tower. What stands on one is no part of what the colours say."""
    pairs = list(itertools.combinations(COLORS, 2))
    np.random.default_rng(seed).shuffle(pairs)
    things, k = on_towers(pairs, seed), seed % len(pairs)
    right = 0
    for told in (pairs[k], pairs[k][::-1]):
        right += meant(f"pick up the gray cylinder on top of the {way.format(*told)}", things) == {f"top {k}"}
    assert right == 2


def counted(count: int, probabilities: dict[str, float], types: dict[str, str]) -> list[str]:
    """What is meant by so many things of which the likeliest is known."""
    objects = tuple(Object(k, types[k], True) for k in probabilities)
    best = Grounding(GroundingKind.OBJECT, objects[0])
    phrase = Phrase(PhraseKind.NOUN, "things", noun="thing", plural=True, count=count)
    tree = ParseTree(phrase)
    hypothesis = Hypothesis(tree, Child(best, Correspondence.ACTIVE), (), 0.0)
    return [o.id for o in Solution(tree, WorldModel(objects), hypothesis, probabilities).objects]


def test_a_count_takes_no_thing_of_another_type_that_is_far_less_likely() -> None:
    """ "Three cups" where there is one cup: a plate is none, however new the word. Other cups count."""
    likely = {"a": 0.8, "b": 0.05, "c": 0.04, "d": 0.03}
    assert counted(3, likely, {"a": "cup", "b": "plate", "c": "fork", "d": "cup"}) == ["a", "d"]
    assert counted(3, likely, {"a": "cup", "b": "cup", "c": "cup", "d": "cup"}) == ["a", "b", "c"]
    assert counted(2, {"a": 0.5, "b": 0.4}, {"a": "jar", "b": "vase"}) == ["a", "b"]
