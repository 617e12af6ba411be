"""Lessons in arranged scenes: true by an independent computation, reproducible, and enough to be learned from."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from dcg_torch.grounding.features import PAPER, Group
from dcg_torch.language import Parser
from dcg_torch.lessons.arrangements import KINDS, Scene, arranged_lessons, cluster_scene, row_scene, table_scene
from dcg_torch.lessons.boards import board_scene
from dcg_torch.lessons.clutter import clutter_scene
from dcg_torch.lessons.handling import stack_scene
from dcg_torch.model import GroundingModel, TrainingSet, Variant
from dcg_torch.scene.upsilon import world_model
from dcg_torch.scene.workspace import with_places


@pytest.mark.parametrize("seed", range(25))
def test_everything_said_of_a_table_is_said_of_one_object(seed: int) -> None:
    scene = table_scene(np.random.default_rng(seed))
    objects = {o.id: o for o in scene.objects}
    for text, meant in scene.commands:
        (one,) = (objects[i] for i in meant)
        assert f"{one.color} {one.type}" in text
        alike = [o for o in scene.objects if (o.type, o.color) == (one.type, one.color)]
        if "closest to the left edge" in text or text.startswith("take the leftmost"):
            assert one.position[1] == max(o.position[1] for o in alike)
            assert sum(o.position[1] == one.position[1] for o in alike) == 1
        if text.endswith((" at the edge", " on the edge", " at the border", " on the border")):
            depth = {o.id: min(min(v, 7.0 - v) for v in o.position[:2]) for o in alike}
            assert depth[one.id] == 0.0
            assert all(d >= 2.0 for i, d in depth.items() if i != one.id)
        if text.endswith((" in the corner", " in a corner", " in the corner of the board")):
            depth = {o.id: math.hypot(*(min(v, 7.0 - v) for v in o.position[:2])) for o in alike}
            assert depth[one.id] == 0.0
            assert all(d >= 2.0 for i, d in depth.items() if i != one.id)
        if " single " in text:
            places = [o.position[:2] for o in scene.objects]
            assert [o for o in alike if places.count(o.position[:2]) == 1] == [one]
        if "on the floor" in text:
            assert [o for o in alike if o.position[2] == 0.0] == [one]
        if "with nothing on it" in text:
            bare = [o for o in alike if not any(p.position[:2] == o.position[:2] and p.position[2] > o.position[2]
                                                for p in scene.objects)]  # fmt: skip
            assert bare == [one]


@pytest.mark.parametrize("seed", range(12))
def test_ordinals_in_a_row_count_from_the_side_they_name(seed: int) -> None:
    scene = row_scene(np.random.default_rng(seed))
    objects = {o.id: o for o in scene.objects}
    row = sorted((o for o in scene.objects if o.id.startswith("row")), key=lambda o: -o.position[1])
    for text, meant in scene.commands:
        if "second" in text:
            (one,) = meant
            assert objects[one] == row[1 if "from the left" in text else -2]


def test_lessons_are_reproducible(parser: Parser) -> None:
    assert arranged_lessons(parser.parse, 12, seed=3) == arranged_lessons(parser.parse, 12, seed=3)
    assert arranged_lessons(parser.parse, 12, seed=3) != arranged_lessons(parser.parse, 12, seed=4)


def test_groups_and_their_members_are_learned(parser: Parser, training: TrainingSet) -> None:
    """Other scenes than those of the lessons; what is meant is a set, and has to be right to the last object."""
    variant = Variant(groups=PAPER | {Group.RELATION}, hypothetical=False, ternary=False)
    model = GroundingModel.trained(training, variant)
    model.teach(arranged_lessons(parser.parse, 400), rounds=2)
    rng = np.random.default_rng(77)
    right = {"row": 0, "cluster": 0, "table": 0}
    for name, make in (("row", row_scene), ("cluster", cluster_scene), ("table", table_scene)):
        for _ in range(30):
            right[name] += _is_right(model, parser, _spoken(make, rng), rng)
    assert right["row"] >= 22
    assert right["cluster"] >= 22
    assert right["table"] >= 22


def _spoken(make: Callable[[np.random.Generator], Scene], rng: np.random.Generator) -> Scene:
    while True:
        scene = make(rng)
        if scene.commands:
            return scene


def _is_right(model: GroundingModel, parser: Parser, scene: Scene, rng: np.random.Generator) -> bool:
    text, meant = scene.commands[int(rng.integers(len(scene.commands)))]
    tree = parser.parse(text, KINDS).tree
    assert tree is not None
    world = model.world_model(scene.objects, scene.robot, workspace=scene.workspace)
    return {o.id for o in model.ground(tree, world).objects} == meant


@pytest.mark.parametrize("maker", [table_scene, stack_scene, clutter_scene, board_scene])
def test_tables_lie_between_their_edges(maker: Callable[[np.random.Generator], Scene]) -> None:
    """The places of a table are where its things are, wherever the robot stands."""
    for seed in range(5):
        scene = maker(np.random.default_rng(seed))
        upsilon = with_places(world_model(scene.objects, KINDS, hypothetical=False, robot=scene.robot), scene.workspace)
        edges = np.array([o.position for o in upsilon.places if o.type == "edge"])[:, :2]
        middle = next(o.position for o in upsilon.places if o.type == "middle")
        assert middle is not None
        points = np.array([o.position[:2] for o in scene.objects])
        assert (points >= edges.min(axis=0) - 1.0).all()
        assert (points <= edges.max(axis=0) + 1.0).all()
        assert np.array(middle[:2]) == pytest.approx((edges.min(axis=0) + edges.max(axis=0)) / 2)
