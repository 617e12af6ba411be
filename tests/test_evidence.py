"""What there is to be learned of a command whose phrases are scored otherwise than they were said."""

from __future__ import annotations

import dcg_torch
from dcg_torch import Percept, Pose
from dcg_torch.learning.evidence import evidence


def test_a_landmark_that_says_which_few_are_meant_is_heard_of() -> None:
    """ "In the corner" is scored as said of both dots; the words in it are evidence all the same."""
    model = dcg_torch.pretrained()
    dots = [Percept(f"d{k}", "dot", None, (2.0 + 0.2 * k, 1.0 - 0.5 * k, 0.0)) for k in range(4)]
    world = model.world_model([*dots, Percept("g", "gnarp", None, (2.8, 1.0, 0.0))], Pose(0.0, 0.0), looked=True)
    solution = model.ground("two dots in the corner, the higher one", world)
    assert solution.target is not None
    said = list(solution.target.children)
    assert [factor.tree for factor in solution.modifiers] != said

    found = list(evidence(solution, model.solve, lambda attribute, word: True))
    assert {one.word for one in found if one.landmark} == {place.children[0].phrase.noun for place in said}
    for one in found:
        assert all(0.0 <= fit <= 1.0 + 1e-9 for fit in one.fits.values())
