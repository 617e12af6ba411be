"""Lessons on the middle of a table: true by an independent computation, and learned."""

from __future__ import annotations

import math

import numpy as np
import pytest

from dcg_torch.grounding.factor_tree import to_factor_tree
from dcg_torch.language import default_parser
from dcg_torch.lessons.arranged import COLORS, KINDS
from dcg_torch.lessons.middles import middle_scene


@pytest.mark.parametrize("seed", range(20))
def test_what_is_said_to_be_in_the_middle_is_nearest_to_it(seed: int) -> None:
    scene = middle_scene(np.random.default_rng(seed))
    assert scene.workspace is not None
    assert scene.workspace.bounds is not None
    near, far, right, left = scene.workspace.bounds  # as the robot sees them
    middle = scene.robot.x + (near + far) / 2, scene.robot.y + (right + left) / 2
    for text, meant in scene.commands:
        said = text.split()
        alike = [
            o
            for o in scene.objects
            if o.type in said and (o.color in said or not any(color in said for color in COLORS))
        ]
        off = {o.id: math.dist(o.position[:2], middle) for o in alike}
        assert {min(off, key=lambda i: off[i])} == meant, text
        assert len(alike) > 1


def test_many_scenes_have_something_in_the_middle_and_are_read_so() -> None:
    parse, found = default_parser().parse, 0
    for seed in range(20):
        commands = middle_scene(np.random.default_rng(seed)).commands
        found += bool(commands)
        for text, _ in commands:
            tree = parse(text, KINDS).tree
            assert tree is not None
            *_, landmark = to_factor_tree(tree).walk()
            assert landmark.phrase.noun in ("middle", "center"), text
    assert found > 5
