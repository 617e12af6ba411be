"""A table full of things: landmarks that are named together, picks from a part of the scene, the middle one of a
counted set, pictures that stand upright, and the lessons on all that."""

from __future__ import annotations

import math

import numpy as np
import pytest

from dcg_torch.grounding.descriptions import comparison_set, modifier_factor
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.search import Search
from dcg_torch.grounding.solution import target_of
from dcg_torch.grounding.tables import Tables
from dcg_torch.interpretation.factor_tree import to_factor_tree
from dcg_torch.language import Parser
from dcg_torch.lessons.arrangements import KINDS, Scene, arranged_lessons
from dcg_torch.lessons.clutter import clutter_scene
from dcg_torch.model import GroundingModel
from dcg_torch.scene.layout_making import layout
from dcg_torch.scene.upright_pictures import laid_flat
from dcg_torch.scene.workspace import Workspace, with_places
from dcg_torch.types import Object, ParseTree, Percept, Pose, WorldModel

TABLE = Workspace((0.0, 7.0, -3.5, 3.5))


def noun_of(text: str, parser: Parser) -> ParseTree:
    """The factor tree of the noun phrase that a command is about."""
    tree = parser.parse(text, KINDS).tree
    assert tree is not None
    noun = target_of(to_factor_tree(tree))
    assert noun is not None
    return noun


def world_of(things: dict[str, tuple[str, float, float]]) -> WorldModel:
    """Cubes on a table: id -> colour, x, y."""
    objects = tuple(
        Object(i, "cube", known=True, color=color, position=(x, y, 0.0)) for i, (color, x, y) in things.items()
    )
    return with_places(WorldModel(objects, Pose(-4.0, 0.0)), TABLE)


def test_landmarks_that_are_named_together_each_describe(parser: Parser) -> None:
    both = noun_of("take the cube next to the red cube and the blue sphere", parser)
    assert [(m.phrase.words[0], len(m.children)) for m in both.children] == [("next to", 1), ("next to", 1)]
    between = noun_of("take the cube between the red cube and the blue sphere", parser)
    assert [(m.phrase.words[0], len(m.children)) for m in between.children] == [("between", 2)]


@pytest.mark.parametrize(("number", "landmarks"), [("the", 1), ("the two", 2), ("three", 3), ("the four", 1)])
def test_of_a_few_counted_landmarks_each_is_another(
    number: str, landmarks: int, parser: Parser, model: GroundingModel
) -> None:
    noun = noun_of(f"take the red cube behind {number} blue cubes", parser)
    (modifier,) = noun.children
    colors = {f"b{k}": ("blue", 1.0 + 0.7 * k, 0.3 * k) for k in range(5)}
    world = world_of({"r": ("red", 5.0, 0.0), **colors})
    encoder, tables = WorldEncoder(model.features, world), Tables(model.features, model.factor)
    beams = [Search(encoder, tables, 12)._beam_of(child, landmark=True) for child in modifier.children]
    factor = modifier_factor(modifier, beams, encoder, tables)
    assert factor.of_each == (landmarks > 1)
    for combo in factor.combos:
        ids = [h.child.grounding.object.id for h in combo]
        assert len(ids) == landmarks == len(set(ids))


@pytest.mark.parametrize(
    "text",
    [
        "take the red cube in the middle of the five red cubes on the left",
        "there are five red cubes on the left . take the one in the middle",
        "take the middle red cube of the group of 5 red cubes on the left",
    ],
)
def test_the_middle_of_so_many_is_picked_from_so_many(text: str, parser: Parser, model: GroundingModel) -> None:
    noun = noun_of(text, parser)
    assert noun.phrase.words == ("middle", "of 5")
    left = {f"l{k}": ("red", 1.0 + k, 2.0 + 0.2 * (k % 2)) for k in range(5)}
    right = {f"r{k}": ("red", 0.5 + 2.0 * k, -2.5) for k in range(3)}
    world = world_of({**right, **left, "b": ("blue", 3.0, 2.5)})
    encoder, tables = WorldEncoder(model.features, world), Tables(model.features, model.factor)
    modifiers = Search(encoder, tables, 12)._all_modifiers(noun)
    found = comparison_set(noun, modifiers, encoder, tables).among
    assert {thing.id for thing, inside in zip(world.things, found, strict=True) if inside} == set(left)


def test_the_closest_on_a_side_is_one_of_that_side(parser: Parser, model: GroundingModel) -> None:
    near_right = {"near": ("red", 0.5, -2.5)}
    left = {"close": ("red", 2.5, 2.5), "far": ("red", 6.5, 2.2)}
    tree = parser.parse("take the red cube on the left that is closest to you", KINDS).tree
    assert tree is not None
    solution = model.ground(tree, world_of({**near_right, **left, "b": ("blue", 4.0, 0.0)}))
    assert solution.object is not None
    assert solution.object.id == "close"


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("take the cube in the top row", ("in", "line across")),
        ("take the cube in the left column", ("in", "line along")),
        ("take the cube on your side of the table", ("closest to", "you")),
        ("take the cube closer to my end", ("closest to", "me")),
    ],
)
def test_sides_by_another_name(text: str, place: tuple[str, str], parser: Parser) -> None:
    (modifier,) = noun_of(text, parser).children
    assert (modifier.phrase.words[0], modifier.children[0].phrase.noun) == place


def test_a_picture_is_laid_flat_and_nothing_else() -> None:
    picture = np.array([(2.0, 0.4, 0.6), (2.0, 0.0, 1.0), (2.0, -0.4, 1.4), (2.0, 0.4, 1.0)])
    flat = laid_flat(picture)
    assert (flat[:, 2] == 0.0).all()
    assert np.allclose(flat[:, 0], 2.0 + picture[:, 2] - 0.6)
    assert np.array_equal(flat[:, 1], picture[:, 1])
    stacks = np.array([(2.0, 0.4, 0.0), (2.0, 0.4, 1.0), (2.0, -0.4, 0.0), (2.0, -0.4, 1.0)])
    table = np.array([(2.0, 0.4, 0.0), (3.0, 0.4, 1.0), (2.0, -0.4, 0.5)])
    for other in (stacks, table, picture[:2]):
        assert np.array_equal(laid_flat(other), other)


def test_the_top_of_a_picture_is_its_far_side() -> None:
    objects = tuple(
        Object(name, "chair", known=True, position=(2.0, y, z))
        for name, y, z in (("low", 0.4, 0.6), ("high", 0.0, 1.4), ("mid", -0.4, 1.0), ("low too", -0.8, 0.6))
    )
    where = layout(with_places(WorldModel(objects, Pose(0.0, 0.0)), Workspace()))
    ahead = dict(zip([o.id for o in where.things], where.position[:, 0].tolist(), strict=True))
    assert ahead["low"] == ahead["low too"] < ahead["mid"] < ahead["high"]
    assert ahead["place: far side edge"] == ahead["high"]
    assert ahead["place: near side edge"] == ahead["low"]


@pytest.mark.parametrize("seed", range(20))
def test_what_is_said_of_a_cluttered_table_is_true_of_one_thing(seed: int) -> None:
    scene = clutter_scene(np.random.default_rng(seed))
    objects = {o.id: o for o in scene.objects}
    for text, meant in scene.commands:
        (one,) = (objects[i] for i in meant)
        alike = [o for o in scene.objects if (o.type, o.color) == (one.type, one.color)]
        assert f"{one.color} {one.type}" in text
        assert len(alike) > 1
        if text == f"go to the {one.color} {one.type} closest to you":
            assert min(alike, key=lambda o: math.dist(o.position[:2], (scene.robot.x, scene.robot.y))) is one
        if "touching" in text and " two " not in text and " and " not in text:
            assert _nearest_other(one, scene) < 1.1


def _nearest_other(one: Percept, scene: Scene) -> float:
    return min(math.dist(one.position[:2], o.position[:2]) for o in scene.objects if o is not one)


def test_lessons_on_clutter_are_read_and_reproducible(parser: Parser) -> None:
    def made(seed: int) -> object:
        return arranged_lessons(parser.parse, 8, seed=seed, makers=(clutter_scene,))

    assert made(1) == made(1)
    assert made(1) != made(2)
