"""The order in which a recogniser gives the things changes nothing, and more landmarks than the beam holds count."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from dcg_torch.model import GroundingModel
from dcg_torch.types import Percept, Pose

COMMANDS = (
    "take the jar in the row of jars",
    "the middle one of the three nearest jars",
    "the jar between two lids",
    "the lid left of the jar",
    "the second jar from the left",
    "all jars near a lid",
    "the top of the pile",
    "take a jar",
)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), text=st.sampled_from(COMMANDS), apart=st.sampled_from([0.25, 1.0]))
def test_a_permutation_of_the_things_changes_no_bit(model: GroundingModel, seed: int, text: str, apart: float) -> None:
    """On a coarse grid, where many things are equally far, and more alike than a beam holds."""
    rng = np.random.default_rng(seed)
    cells = rng.permutation(36)[: int(rng.integers(3, 20))].tolist()
    things = [
        Percept(f"t{k}", "jar" if rng.random() < 0.7 else "lid", None, (1.0 + apart * (c // 6), apart * (c % 6), 0.0))
        for k, c in enumerate(cells)
    ]
    given_so = model.ground(text, model.world_model(things, robot=Pose(0.0, 0.0), looked=True))
    shuffled = [things[k] for k in rng.permutation(len(things)).tolist()]
    otherwise = model.ground(text, model.world_model(shuffled, robot=Pose(0.0, 0.0), looked=True))
    assert [o.id for o in given_so.objects] == [o.id for o in otherwise.objects]
    assert dict(given_so.probabilities) == dict(otherwise.probabilities)
    assert given_so.probability == otherwise.probability


def test_all_that_is_alike_counts(model: GroundingModel) -> None:
    """Twenty posts, more than the beam, each with a bowl beside it: each is as much a bowl next to a post."""
    posts = [Percept(f"p{k}", "post", None, (2.0 + 3.0 * (k % 5), 3.0 * (k // 5), 0.0)) for k in range(20)]
    bowls = [Percept(f"b{k}", "bowl", None, (p.position[0], p.position[1] + 0.5, 0.0)) for k, p in enumerate(posts)]
    world = model.world_model([*posts, *bowls], robot=None, looked=True)
    found = model.ground("take the bowl next to a post", world).probabilities
    shares = [found[b.id] for b in bowls]
    assert max(shares) < 1.5 * min(shares)
    assert sum(shares) > 0.9
