"""Orders and neighbours among many things, found without a table of all pairs, against one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dcg_torch.scene import neighbours as room
from dcg_torch.scene.neighbours import LEVEL, NEXT, ONE_LEVEL, SAME_POINT, SAME_SPOT, neighbours
from dcg_torch.scene.order import TIE, Alike, before, signatures

seeds = st.integers(0, 2**32 - 1)


@settings(max_examples=40, deadline=None)
@given(seed=seeds, n=st.integers(1, 150), classes=st.integers(1, 40), most=st.sampled_from([1, 3, 9, 200]))
def test_counts_equal_those_of_all_pairs(seed: int, n: int, classes: int, most: int) -> None:
    rng = np.random.default_rng(seed)
    code = rng.integers(-1, classes, size=n)
    values = rng.integers(0, 6, size=(4, n)) + rng.choice([0.0, TIE / 2, 2 * TIE], size=(4, n))
    values[rng.random(values.shape) < 0.1] = np.nan
    alike = (code[:, None] == code[None]) & (code[:, None] >= 0)
    expected = ((values[:, None, :] < values[:, :, None] - TIE) & alike[None]).sum(axis=2)
    found = before(values, Alike.by(code), most)
    assert (np.minimum(found, most) == np.minimum(expected, most)).all()


@settings(max_examples=25, deadline=None)
@given(seed=seeds, n=st.integers(65, 120), most=st.sampled_from([3, 50]))
def test_a_thing_may_be_compared_with_a_row_that_shares_members(seed: int, n: int, most: int) -> None:
    rng = np.random.default_rng(seed)
    rows = [np.sort(rng.choice(n, size=size, replace=False)) for size in (4, 7, 0, 12)]
    code = rng.integers(-1, len(rows), size=n)
    values = rng.normal(size=(2, n)).round(1)
    found = before(values, Alike(code, rows), most)
    for j in range(n):
        members = rows[code[j]] if code[j] >= 0 else []
        for r in range(2):
            count = sum(values[r, k] < values[r, j] - TIE for k in members)
            assert min(found[r, j], most) == min(count, most)


@pytest.mark.parametrize("pairs", [1 << 20, 64])
@pytest.mark.parametrize("n", [40, 400])
def test_neighbours_equal_those_of_all_pairs(n: int, pairs: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A tree is asked where things are many, in parts where there are many pairs."""
    monkeypatch.setattr(room, "_PAIRS", pairs)
    rng = np.random.default_rng(n + pairs)
    position = rng.uniform(0, n**0.5, size=(n, 3)) * (1.0, 1.0, 0.1)
    position[: n // 2] = position[: n // 2].round(1)  # some stand just at a bound
    position[3] = np.nan
    color = rng.integers(-1, 3, size=n)
    found = neighbours(position, color)
    for i in range(n):
        apart = np.hypot(*(position[i, :2] - position[:, :2]).T)
        other = np.arange(n) != i
        up = position[i, 2] - position[:, 2]
        # Two on one level are beside one another, unless both are in one place.
        spot = (apart < SAME_SPOT) & other & ((np.abs(up) > LEVEL) | (apart <= SAME_POINT))
        assert found.beside[i] == ((apart < NEXT) & other).any()
        assert found.stacked[i] == spot.any()
        assert found.resting[i] == (spot & (up > 0.01) & (up <= ONE_LEVEL)).any()
        assert found.covered[i] == (spot & (-up > 0.01) & (-up <= ONE_LEVEL)).any()
        assert found.colors.get(i, ()) == tuple(sorted(set(color[spot & (color >= 0)].tolist())))


@pytest.mark.parametrize("n", [30, 300])
def test_signatures_tell_apart_what_differs_in_any_column(n: int) -> None:
    rng = np.random.default_rng(n)
    kinds, colors, codes = (
        rng.choice(["a", "b"], n).tolist(),
        ["x" if one else None for one in rng.integers(2, size=n)],
        rng.integers(3, size=n),
    )
    first, kind = signatures(kinds, colors, codes)
    rows = list(zip(kinds, colors, codes.tolist(), strict=True))
    assert len(first) == len(set(rows))
    assert [rows[first[k]] for k in kind] == rows


@settings(max_examples=25, deadline=None)
@given(seed=seeds, n=st.integers(1, 120), side=st.sampled_from([0.5, 4.0, 30.0, 1e6]))
def test_no_more_pairs_are_close_than_the_bound_says(seed: int, n: int, side: float) -> None:
    points = np.random.default_rng(seed).uniform(-side, side, size=(n, 2))
    apart = np.hypot(*(points[:, None] - points[None]).transpose(2, 0, 1))
    assert (apart < NEXT).sum() <= room._most_pairs(points, NEXT)
