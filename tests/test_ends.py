"""Lessons on which of several scattered things lies at an end: true by an independent computation."""

from __future__ import annotations

import math

import numpy as np
import pytest

from dcg_torch.interpretation.factor_tree import to_factor_tree
from dcg_torch.language import default_parser, target_phrase
from dcg_torch.lessons.arrangements import KINDS
from dcg_torch.lessons.ends import scattered_scene
from dcg_torch.model.pretrain import pretrained
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Object, Percept, Pose, WorldModel


@pytest.mark.parametrize("seed", range(20))
def test_what_is_said_of_scattered_things_is_so(seed: int) -> None:
    scene = scattered_scene(np.random.default_rng(seed))
    assert scene.commands
    for text, meant in scene.commands:
        kind = next(k for k in KINDS if k in text)
        alike = [o for o in scene.objects if o.type == kind]
        side = [o.id for o in sorted(alike, key=lambda o: -o.position[1])]
        near = [o.id for o in sorted(alike, key=lambda o: math.hypot(*o.position[:2]))]
        order = side if "left" in text else side[::-1] if "right" in text else near
        if order is near and any(word in text for word in ("farthest", "furthest", "back", "rearmost")):
            order = near[::-1]
        number = next((k for k, w in enumerate(("two", "three"), 2) if w in text.split()), None)
        place = next((k for k, w in enumerate(("first", "second", "third", "fourth", "fifth")) if w in text), 0)
        assert meant == (frozenset(order[:number]) if number else {order[place]}), text


def test_scattered_scenes_are_read() -> None:
    for seed in range(5):
        for text, _ in scattered_scene(np.random.default_rng(seed)).commands:
            assert default_parser().parse(text, KINDS).tree is not None, text


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("the second farthest cone to the left", ("second", "from the left")),
        ("the farthest cone to the right", ("rightmost",)),
        ("the farthest cone", ("farthest",)),
    ],
)
def test_the_farthest_to_a_side_is_at_its_end(text: str, words: tuple[str, ...]) -> None:
    tree = default_parser().parse(text).tree
    assert tree is not None
    world = WorldModel((Object("a", "cone", known=True, position=(1.0, 0.0, 0.0)),))
    noun = target_phrase(to_factor_tree(tree, world))
    assert (noun.phrase.words, noun.children) == (words, ())


def test_a_landmark_in_the_singular_is_no_group_of_its_kind() -> None:
    """Three green blocks near one another are a group, too; what is on top of "the green block" is on one of them."""
    things = (
        *(("green", 4.0, 0.0, 0.0), ("green", 5.0, 1.0, 0.0), ("green", 5.0, -0.6, 0.0), ("red", 4.0, 0.0, 1.0)),
        *(("red", 1.0, 6.0, 0.0), ("red", 1.0, 6.0, 1.0), ("blue", 7.0, 6.0, 0.0)),
    )
    percepts = [Percept(f"p{k}", "cube", c, (x, y, z)) for k, (c, x, y, z) in enumerate(things)]
    model = pretrained()
    world = model.world_model(percepts, Pose(0.0, 0.0), None, looked=True, workspace=Workspace(None, 1.0))
    told = default_parser().parse("pick up the red block on top of the green block right of the red tower")
    solution = model.ground(told, world)
    (over,) = solution.modifiers
    landmarks = [combo[0].child.grounding.object for combo in over.combos]
    assert any({"p0", "p1", "p2"} == set(group.members) for group in solution.world.groups)
    assert {o.id for o in landmarks[:3]} == {"p0", "p1", "p2"}
    assert not any(o.members for o in landmarks)
