"""Relations by definition: true of the worlds, read as the parser reads them, and spoken where nothing is written."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest

from dcg_torch.language import Parser
from dcg_torch.lessons.relations import KNOWN, relational_lessons
from dcg_torch.lessons.selections import half_scene
from dcg_torch.types import ParseTree
from dcg_torch.world.files import World, WorldObject
from dcg_torch.world.generator import TYPES, generate_world
from dcg_torch.world.speaker import RelationalSpeaker
from dcg_torch.world.speaker.fit import Surroundings
from dcg_torch.world.speaker.phrases import command, wording
from dcg_torch.world.speaker.referring import RELATIONS, SETS, SPOKEN, Description, generate

SIZES = (0.2, 0.3, 0.45, 0.7)


def told(relation: str, seed: int, count: int = 3) -> list[tuple[Surroundings, Description]]:
    """Some descriptions by a relation, with their worlds."""
    rng = np.random.default_rng(seed)
    found: list[tuple[Surroundings, Description]] = []
    for k in itertools.count():
        world = generate_world(rng, "w", types=KNOWN if k % 2 else TYPES, probability=0.6 if k % 2 else 0.3)
        view = Surroundings.of(world, rng.choice(SIZES, size=len(world.objects)))
        said = generate(view, relation, rng, KNOWN)
        if said is not None:
            found.append((view, said))
        if len(found) == count:
            return found
    raise AssertionError


def shape(tree: ParseTree) -> tuple[Any, ...]:
    """What a tree says, without the texts of its phrases."""
    p = tree.phrase
    return (p.kind, p.words, p.noun, p.color, p.plural, p.count, *(shape(child) for child in tree.children))


@pytest.mark.parametrize("relation", RELATIONS)
def test_a_lesson_is_read_as_its_words_are(relation: str, parser: Parser) -> None:
    """What the parser makes of the text is the tree that is taught."""
    for _, said in told(relation, 1, 4):
        tree = command(said.tree)
        reading = parser.parse(wording(tree), KNOWN)
        assert reading.tree is not None, wording(tree)
        assert shape(reading.tree) == shape(tree), wording(tree)


def alike(view: Surroundings, tree: ParseTree) -> list[int]:
    """The objects that noun and colour fit."""
    p = tree.phrase
    return [
        j
        for j, (t, c) in enumerate(zip(view.types, view.colors, strict=True))
        if (p.noun in ("thing", t)) and p.color in (None, c)
    ]


def landmark(view: Surroundings, tree: ParseTree) -> int:
    (only,) = alike(view, tree.children[0].children[0])
    return only


def bearing(view: Surroundings, j: int) -> float:
    return math.degrees(math.atan2(view.position[j][1], view.position[j][0]))


def off(a: float, b: float) -> float:
    """Degrees between two headings."""
    return abs((a - b + 180.0) % 360.0 - 180.0)


@pytest.mark.parametrize(
    ("relation", "angle"), [("behind", 0), ("in front of", 180), ("to the left of", 90), ("to the right of", -90)]
)
def test_a_side_is_seen_from_the_robot(relation: str, angle: float) -> None:
    """By complex numbers: the offset from the landmark, turned so that the landmark is straight ahead."""
    for view, said in told(relation, 2, 10):
        (j,), mark = said.meant, landmark(view, said.tree)
        place = [complex(*p) for p in view.position]
        turned = [(p - place[mark]) / place[mark] for p in place]
        assert off(math.degrees(math.atan2(turned[j].imag, turned[j].real)), angle) <= 45.0 + 1e-6
        for k in set(alike(view, said.tree)) - {j, mark}:
            nearer = abs(place[k] - place[mark]) < abs(place[j] - place[mark]) + 0.5 - 1e-9
            assert not (nearer and off(math.degrees(math.atan2(turned[k].imag, turned[k].real)), angle) <= 45.0)


@pytest.mark.parametrize(
    ("relation", "angle"),
    [("behind you", 180), ("in front of you", 0), ("ahead of you", 0), ("on your left", 90), ("on your right", -90)],
)
def test_a_direction_of_the_robot_is_nobody_else_s(relation: str, angle: float) -> None:
    for view, said in told(relation, 3, 10):
        (j,) = said.meant
        own = off(bearing(view, j), angle)
        assert own <= 50.0 + 1e-6
        assert all(off(bearing(view, k), angle) > min(own + 39.0, 69.0) for k in set(alike(view, said.tree)) - {j})


@pytest.mark.parametrize(
    ("relation", "axis", "last"),
    [
        *(("leftmost", 1, True), ("rightmost", 1, False), ("closest", 0, False), ("nearest", 0, False)),
        *(("farthest", 0, True), ("closest to you", 0, False), ("farthest from you", 0, True)),
    ],
)
def test_a_superlative_stands_out(relation: str, axis: int, last: bool) -> None:
    for view, said in told(relation, 4, 10):
        (j,) = said.meant
        value = view.position[:, 1] if axis else np.linalg.norm(view.position, axis=1)
        others = [value[k] for k in alike(view, said.tree) if k != j]
        assert others
        assert value[j] >= max(others) + 0.399 if last else value[j] <= min(others) - 0.399


@pytest.mark.parametrize(
    ("relation", "place", "left"), [("second from the left", 1, True), ("third from the right", 2, False)]
)
def test_an_ordinal_counts(relation: str, place: int, left: bool) -> None:
    for view, said in told(relation, 5, 5):
        across = sorted(alike(view, said.tree), key=lambda k: view.position[k][1], reverse=left)
        assert said.meant == {across[place]}


def test_between_is_in_the_triangle_s_flat_corner() -> None:
    """The way round by the object meant is little longer than the straight one, and nobody else's is as short."""
    for view, said in told("between", 6, 10):
        (j,) = said.meant
        a, b = (alike(view, noun)[0] for noun in said.tree.children[0].children)
        detour = [
            math.dist(view.position[a], p)
            + math.dist(p, view.position[b])
            - math.dist(view.position[a], view.position[b])
            for p in view.position
        ]
        others = set(alike(view, said.tree)) - {a, b, j}
        assert all(detour[j] < detour[k] for k in others)


@pytest.mark.parametrize("relation", sorted(SETS))
def test_a_set_is_a_set(relation: str) -> None:
    for view, said in told(relation, 7, 3):
        assert said.tree.phrase.plural
        assert len(said.meant) >= 2
        assert said.meant <= set(alike(view, said.tree))
        assert said.tree.phrase.count in (None, len(said.meant))


def test_a_world_that_is_turned_and_moved_is_told_alike() -> None:
    """What is meant depends on the robot's view, not on where north is."""
    world = generate_world(np.random.default_rng(8), "w", probability=0.4)
    angle, c = 0.7, complex(math.cos(0.7), math.sin(0.7))

    def moved(x: float, y: float) -> tuple[float, float]:
        z = complex(x, y) * c + complex(3.0, -1.0)
        return z.real, z.imag

    x, y = moved(world.robot.x, world.robot.y)
    other = world.model_copy(
        update={
            "robot": world.robot.model_copy(update={"x": x, "y": y, "yaw": world.robot.yaw + angle}),
            "objects": tuple(o.model_copy(update={"position": moved(*o.position)}) for o in world.objects),
        }
    )
    for k, relation in enumerate(RELATIONS):
        views = Surroundings.of(world), Surroundings.of(other)
        one, two = (generate(view, relation, np.random.default_rng(k), TYPES) for view in views)
        assert one == two


def test_lessons_are_reproducible_and_cover_every_relation() -> None:
    lessons = relational_lessons(2 * len(RELATIONS))
    assert relational_lessons(5, 1) == relational_lessons.__wrapped__(5, 1)
    said = " ".join(wording(lesson.tree) for lesson in lessons)
    for words in (
        "between",
        "on your left",
        "behind you",
        "leftmost",
        "third",
        "middle",
        "biggest",
        "nearest to me",
        "two",
    ):
        assert words in said
    for lesson in lessons:
        assert lesson.targets <= {o.id for o in lesson.world.objects}


def test_ordinals_are_told_where_only_others_are_hard_to_tell_apart() -> None:
    scenes = [half_scene(np.random.default_rng(seed)) for seed in range(20)]
    said = [(scene, text, ids) for scene in scenes for text, ids in scene.commands if "second closest" in text]
    assert len({id(scene) for scene, _, _ in said}) >= 7
    for scene, text, ids in said:
        if text.endswith(("to you", "to the robot")):
            kind = next(o.type for o in scene.objects if o.id in ids)
            ways = {o.id: math.hypot(*o.position[:2]) for o in scene.objects if o.type == kind}
            assert sorted(ways, key=lambda i: ways[i])[1] in ids


def test_what_can_t_be_told_is_refused() -> None:
    view = Surroundings(("cube",), ("red",), np.array([[1.0, 0.0]]))
    assert generate(view, "leftmost", np.random.default_rng(0), KNOWN) is None
    with pytest.raises(ValueError, match="'beneath' is no relation; choose from behind"):
        generate(view, "beneath", np.random.default_rng(0), KNOWN)
    with pytest.raises(ValueError, match="count=-1"):
        relational_lessons(-1)


def test_the_speaker_speaks_where_nothing_is_written(parser: Parser) -> None:
    rng = np.random.default_rng(9)
    said = [
        c for k in range(6) for c in RelationalSpeaker().commands(generate_world(rng, f"w{k}", probability=0.3), rng)
    ]
    assert len(said) > 15
    for c in said:
        objects = {o.id: o for o in c.world.objects}
        assert c.noun in ("thing", objects[c.target].type)
        assert c.color in (None, objects[c.target].color)
        reading = parser.parse(c.text, TYPES)
        assert (reading.noun, reading.color) == (c.noun, c.color), c.text
    assert not set(SPOKEN) & SETS


def test_the_speaker_says_what_is_written() -> None:
    cubes = tuple(WorldObject(id=str(k), type="cube", color="red", position=(2.0 + k, 0.0)) for k in range(3))
    written = {"text": "go to the farthest cube", "target": "2", "noun": "cube"}
    world = World.model_validate({"name": "w", "objects": [o.model_dump() for o in cubes], "relational": [written]})
    (said,) = RelationalSpeaker().commands(world, np.random.default_rng(0))
    assert (said.text, said.target) == ("go to the farthest cube", "2")
