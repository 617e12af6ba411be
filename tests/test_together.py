"""Several that stand together: which they are is measured. All commands here were written for this project."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch.grounding.counted_sets import closest_together
from dcg_torch.model.pretrain import pretrained
from dcg_torch.types import Percept, Pose

seeds = st.integers(0, 2**32 - 1)


@given(seed=seeds, count=st.integers(3, 9))
def test_two_together_are_the_closest_pair(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    at = rng.uniform(0.0, 5.0, (count, 3))
    found, log_close = closest_together(at, np.ones(count, dtype=np.bool_), np.zeros(count), 2)
    pair = min(itertools.combinations(range(count), 2), key=lambda of: math.dist(at[of[0]], at[of[1]]))
    assert set(np.flatnonzero(found)) == set(pair)
    assert (log_close[list(pair)] == 0.0).all()
    assert (log_close <= 0.0).all()


@given(seed=seeds, count=st.integers(4, 9), several=st.integers(2, 4))
def test_only_candidates_are_together(seed: int, count: int, several: int) -> None:
    rng = np.random.default_rng(seed)
    at, candidates = rng.uniform(0.0, 5.0, (count, 3)), np.zeros(count, dtype=np.bool_)
    candidates[rng.permutation(count)[:several]] = True
    found, _ = closest_together(at, candidates, np.zeros(count), several)
    assert (found == candidates).all()


def test_what_stands_together_among_many_takes_no_square_of_them() -> None:
    """Of twenty thousand things a table of all distances would have 9.6 GB."""
    at = np.random.default_rng(0).uniform(0.0, 100.0, (20_000, 3))
    at[7_000] = at[13_000] + 1e-6
    found, _ = closest_together(at, np.ones(len(at), dtype=np.bool_), np.zeros(len(at)), 2)
    assert set(np.flatnonzero(found)) == {7_000, 13_000}


def scene(seed: int, kind: str) -> tuple[list[Percept], str, str]:
    """Six things far apart and a pair; the ids of its left and its right one."""
    rng = np.random.default_rng(seed)
    x, y = float(rng.uniform(1.4, 3.6)), float(rng.uniform(-1.2, 1.2))
    points = [(x + 0.05, y + 0.15), (x - 0.05, y - 0.15)]
    while len(points) < 8:
        point = float(rng.uniform(1.0, 4.0)), float(rng.uniform(-1.6, 1.6))
        if all(math.dist(point, other) > 0.6 for other in points):
            points.append(point)
    things = [Percept(f"o{k}", kind, "red", (*at, 0.0)) for k, at in enumerate(points)]
    return [things[k] for k in rng.permutation(len(things))], "o0", "o1"


@pytest.mark.parametrize("kind", ["cup", "dot", "block"])
@pytest.mark.parametrize("seed", range(6))
def test_the_shipped_model_finds_the_pair(seed: int, kind: str) -> None:
    things, left, right = scene(seed, kind)
    model = pretrained()
    world = model.world_model(things, Pose(0.0, 0.0), looked=True)
    for text, meant in (
        (f"take the left one of the two {kind}s that are close together", {left}),
        (f"there are two {kind}s next to each other, take the right one", {right}),
        (f"take the pair of {kind}s that are close together", {left, right}),
        (f"the two {kind}s that almost touch", {left, right}),
        (f"two {kind}s are very close together, take the one on the right", {right}),
        (f"there is a pair of {kind}s nearly touching. The left one.", {left}),
    ):
        assert {o.id for o in model.ground(text, world).objects} == meant, text


def test_of_more_that_are_alike_so_many_that_stand_together_are_picked_from() -> None:
    at = {"a": (2.0, 0.2), "b": (2.1, -0.1), "c": (2.0, -0.4), "d": (3.5, 1.5), "e": (3.4, -1.6)}
    things = [Percept(k, "mug", "red", (x, y, 0.0)) for k, (x, y) in at.items()]
    model = pretrained()
    world = model.world_model(things, Pose(0.0, 0.0), looked=True)
    assert [o.id for o in model.ground("take the middle one of the three mugs", world).objects] == ["b"]
