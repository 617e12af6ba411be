"""What stands on the floor and what stands on something. All commands here were written for this project."""

from __future__ import annotations

import numpy as np
import pytest
from asked import meant

from dcg_torch.types import Percept

WAYS = ("on the floor", "from the ground", "that is at the floor", "off the floor", "which lies on the ground")


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("way", WAYS)
def test_what_is_on_the_floor_rests_on_nothing_wherever_it_stands(seed: int, way: str) -> None:
    """Three balls lie on crates and one on the floor, near or far, in the middle or aside."""
    rng = np.random.default_rng(seed)
    spots = rng.permutation([(x, y) for x in (1.0, 1.8, 2.6) for y in (-0.9, 0.0, 0.9)])[:5]
    things = [
        Percept(f"crate {k}", "crate", "brown", (x, y, 0.0), (0.3, 0.3, 0.3)) for k, (x, y) in enumerate(spots[:3])
    ]
    things += [Percept(f"on {k}", "ball", "green", (x, y, 0.3), (0.1, 0.1, 0.1)) for k, (x, y) in enumerate(spots[:3])]
    x, y = spots[3]
    things.append(Percept("down", "ball", "green", (x, y, 0.0), (0.1, 0.1, 0.1)))
    assert meant(f"pick up the green ball {way}", things) == {"down"}


@pytest.mark.parametrize("way", WAYS)
def test_what_is_high_up_is_not_on_the_floor_though_nobody_says_on_what_it_stands(way: str) -> None:
    for near in (True, False):
        spots = ((1.0, 0.2, 0.9), (2.5, -0.4, 0.0)) if near else ((2.5, 0.2, 0.9), (1.0, -0.4, 0.0))
        things = [Percept(name, "vase", None, spot) for name, spot in zip(("up", "down"), spots, strict=True)]
        assert meant(f"fetch the vase {way}", [*things, Percept("mug", "mug", None, (1.5, 0.5, 0.9))]) == {"down"}
