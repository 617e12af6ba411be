"""A side is a part of the scene where something is ranked or meant as a whole: lessons, trees, and the shipped model.

All commands here were written for this project.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from dcg_torch.interpretation.factor_tree import to_factor_tree
from dcg_torch.language import default_parser, target_phrase
from dcg_torch.lessons.arrangements import KINDS
from dcg_torch.lessons.parts import part_scene
from dcg_torch.model.pretrain import pretrained
from dcg_torch.types import Object, Percept, Pose, WorldModel


def in_part(things: list[Percept], text: str, kind: str) -> list[Percept]:
    """Those of a kind that lie on the side that a text names last."""
    depth = [o.position[0] for o in things]
    middle = (min(depth) + max(depth)) / 2
    side = [w for w in text.split() if w in ("left", "right", "front", "back")][-1]
    ways: dict[str, Callable[[Percept], float]] = {
        "left": lambda o: o.position[1],
        "right": lambda o: -o.position[1],
        "front": lambda o: middle - o.position[0],
        "back": lambda o: o.position[0] - middle,
    }
    return [o for o in things if o.type == kind and ways[side](o) > 0]


@pytest.mark.parametrize("seed", range(20))
def test_what_is_said_of_a_part_is_so(seed: int) -> None:
    scene = part_scene(np.random.default_rng(seed))
    for text, meant in scene.commands:
        assert default_parser().parse(text, KINDS).tree is not None, text
        kind = next(k for k in KINDS if k in text)
        there = in_part(list(scene.objects), text, kind)
        assert meant <= {o.id for o in there}, text
        words = text.split()
        if f"{kind}s" in words:
            assert meant == {o.id for o in there}, text
            continue
        orders: dict[str, Callable[[Percept], float]] = {
            "nearest": lambda o: math.hypot(*o.position[:2]),
            "farthest": lambda o: -math.hypot(*o.position[:2]),
            "leftmost": lambda o: -o.position[1],
            "rightmost": lambda o: o.position[1],
            "biggest": lambda o: -(o.size or (0.0,))[0],
            "smallest": lambda o: (o.size or (0.0,))[0],
        }
        orders |= {"closest": orders["nearest"], "furthest": orders["farthest"]}
        order = next((orders[w] for w in words if w in orders), None)
        if order is None:
            centre = np.mean([o.position[:2] for o in there], axis=0)
            assert "middle" in words, text
            assert meant == {min(there, key=lambda o: math.dist(o.position[:2], centre)).id}, text
        else:
            assert meant == {sorted(there, key=order)["second" in words].id}, text


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("take the nearest cone on the left", "within"),
        ("take the cone on your left that is closest to you", "within"),
        ("take the leftmost cone in the back", "within"),
        ("take the cones on the right", "within"),
        ("take the cone on the left", "on"),
        ("take the two cones on the left", "on"),
    ],
)
def test_a_side_is_a_part_where_something_is_ranked_there(text: str, word: str) -> None:
    tree = default_parser().parse(text).tree
    assert tree is not None
    world = WorldModel((Object("a", "cone", known=True, position=(1.0, 0.0, 0.0)),))
    modifiers = target_phrase(to_factor_tree(tree, world)).children
    assert word in [m.phrase.words[0] for m in modifiers]


def scattered(rng: np.random.Generator) -> list[Percept]:
    points: list[tuple[float, float]] = []
    while len(points) < 7:
        point = float(rng.uniform(1.0, 5.0)), float(rng.uniform(-3.0, 3.0))
        if abs(point[1]) > 0.4 and all(math.dist(point, other) > 0.6 for other in points):
            points.append(point)
    return [Percept(f"o{k}", "mug", "red", (x, y, 0.0)) for k, (x, y) in enumerate(points)]


def test_the_shipped_model_ranks_within_a_side() -> None:
    model, right, asked = pretrained(), 0, 0
    for seed in range(30):
        things = scattered(np.random.default_rng(seed))
        world = model.world_model(things, Pose(0.0, 0.0), looked=True)
        for side, sign in (("left", 1), ("right", -1)):
            there = sorted(
                (o for o in things if sign * o.position[1] > 0), key=lambda o: math.hypot(o.position[0], o.position[1])
            )
            if not 3 <= len(there) <= 4:
                continue
            opposite = "right" if side == "left" else "left"
            inner = min(there, key=lambda o: sign * o.position[1])
            texts = {
                f"take the nearest mug on the {side}": {there[0].id},
                f"take the farthest mug on your {side}": {there[-1].id},
                f"take the {opposite}most mug on the {side}": {inner.id},
                f"take the mugs on the {side}": {o.id for o in there},
            }
            for text, meant in texts.items():
                right += {o.id for o in model.ground(text, world).objects} == meant
                asked += 1
    assert asked > 100
    assert right / asked >= 0.8


def test_the_middle_of_so_many_on_a_side_is_among_the_farthest_there() -> None:
    """The leftmost of all has no better claim to be in the middle of the five on the left than the fifth."""
    at = {"a": (2.0, 2.4), "b": (3.2, 2.1), "c": (2.6, 1.6), "d": (2.0, 0.9), "e": (3.2, 1.0)}
    at |= {"f": (2.4, -1.5), "g": (3.0, -2.5), "h": (1.6, -0.8)}
    things = [Percept(k, "block", "green", (x, y, 0.0)) for k, (x, y) in at.items()]
    model = pretrained()
    world = model.world_model(things, Pose(0.0, 0.0), looked=True)
    for text in (
        "take the block in the middle of the group of 5 blocks on your left",
        "take the middle one of the five blocks on the left",
    ):
        assert [o.id for o in model.ground(text, world).objects] == ["c"], text


@pytest.mark.parametrize("number", [3, 5, 12, 30])
def test_between_many_has_an_answer(number: int) -> None:
    """Combinations of landmarks are cut, not their number: thirty names were 12 ** 30 combinations."""
    names = ["the lamp", "the chair", "the desk", "the mug"]
    things = [Percept(f"o{k}", names[k % 4][4:], "red", (1.0 + k / 4, (k % 5) - 2.0, 0.0)) for k in range(20)]
    model = pretrained()
    world = model.world_model(things, Pose(0.0, 0.0), looked=True)
    text = "take the mug between " + " and ".join(names[k % 3] for k in range(number))
    assert model.ground(text, world).probability is not None
