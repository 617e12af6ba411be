"""What is meant after a side or an ordinal is turned: worked out by hand from where the things stand."""

from __future__ import annotations

from typing import Any

import pytest

from dcg_torch.evaluation.episodes import Episode
from dcg_torch.evaluation.made_scenes import made_episodes
from dcg_torch.evaluation.turned_texts import swap_ordinal, swap_side

ROBOT = {"x": 0.0, "y": 0.0, "yaw": 0.0}  # it looks along x; its left is +y
FACING = {"x": 8.0, "y": 0.0}
CUBES = {"a": (2.0, 2.0), "b": (3.0, 0.5), "c": (4.0, -1.0), "d": (5.0, -3.0)}


def scene(text: str, target: str, places: dict[str, tuple[float, float]] = CUBES, **keys: Any) -> Episode:
    """Red cubes at places; a place named "lamp" has a lamp."""
    objects = [
        {"id": i, "type": "lamp" if i == "lamp" else "cube", "color": None if i == "lamp" else "red", "position": at}
        for i, at in places.items()
    ]
    return Episode.model_validate(
        {"id": text, "text": text, "robot": ROBOT, "objects": objects, "target": (target,), **keys}
    )


@pytest.mark.parametrize(
    ("text", "target", "turned", "meant"),
    [
        ("the leftmost cube", "a", "the rightmost cube", "d"),
        ("the cube on the right", "d", "the cube on the left", "a"),
        ("pick up the cube closest to the left", "a", "pick up the cube closest to the right", "d"),
        ("the nearest cube", "a", "the farthest cube", "d"),
        ("the second cube from the left", "b", "the second cube from the right", "c"),
        ("take the left cube and put it on the ball", "a", "take the right cube and put it on the ball", "d"),
    ],
)  # fmt: skip
def test_the_other_end_of_the_line_is_meant(text: str, target: str, turned: str, meant: str) -> None:
    found = swap_side(scene(text, target))
    assert found is not None
    assert found.episode.text == turned
    assert [i for i in CUBES if found.expected.allows([i])] == [meant]
    assert not found.expected.allows([])


def test_the_target_says_whose_left_it_is() -> None:
    """The rightmost for the robot is the leftmost for who faces it, and only where somebody does."""
    assert swap_side(scene("the leftmost cube", "d")) is None
    found = swap_side(scene("the leftmost cube", "d", speaker=FACING))
    assert found is not None
    assert [i for i in CUBES if found.expected.allows([i])] == ["a"]


def test_both_words_of_a_corner_turn() -> None:
    table = {"a": (0.0, 7.0), "b": (7.0, 7.0), "c": (0.0, 0.0), "d": (7.0, 0.0)}
    found = swap_side(scene("the cube in the top left corner", "b", table))
    assert found is not None
    assert found.episode.text == "the cube in the bottom right corner"
    assert [i for i in table if found.expected.allows([i])] == ["c"]


@pytest.mark.parametrize(
    ("text", "target", "turned", "meant"),
    [
        ("the second cube from the left", "b", "the third cube from the left", "c"),
        ("the cube third from the right", "b", "the cube first from the right", "d"),
        ("the third nearest cube", "c", "the second nearest cube", "b"),
    ],
)  # fmt: skip
def test_another_of_the_order_is_meant(text: str, target: str, turned: str, meant: str) -> None:
    found = swap_ordinal(scene(text, target))
    assert found is not None
    assert found.episode.text == turned
    assert [i for i in CUBES if found.expected.allows([i])] == [meant]


def test_the_other_side_of_a_landmark() -> None:
    places = {"lamp": (3.0, 0.0), "a": (3.0, 1.5), "b": (3.2, -1.5), "c": (1.0, 0.1)}
    found = swap_side(scene("the cube to the left of the lamp", "a", places))
    assert found is not None
    assert [i for i in places if found.expected.allows([i])] == ["b"]
    assert swap_side(scene("the cube in front of the lamp", "c", places)) is None, "none is behind it"


@pytest.mark.parametrize(
    ("text", "target", "why"),
    [
        ("the leftmost cube", "b", "it is not the leftmost"),
        ("the second cube from the left", "c", "it is the third"),
        ("the closest cube to you", "a", "farthest to you is no English"),
        ("move the left cube to the ball", "a", "the text says where to move it"),
    ],
)
def test_a_text_that_proves_nothing(text: str, target: str, why: str) -> None:
    assert swap_side(scene(text, target)) is None, why
    assert swap_ordinal(scene(text, target)) is None, why


def test_what_is_described_has_the_size_that_is_said() -> None:
    sizes = {"a": 1.0, "b": 0.5, "c": 1.0, "d": 0.5}
    one = scene("the small cube on the left", "b")
    one = one.model_copy(update={"objects": tuple(o.model_copy(update={"size": sizes[o.id]}) for o in one.objects)})
    found = swap_side(one)
    assert found is not None
    assert [i for i in CUBES if found.expected.allows([i])] == ["d"]


def test_made_scenes_are_reproducible_and_differ_by_seed() -> None:
    assert made_episodes(9, 3) == made_episodes(9, 3)
    assert made_episodes(9, 3) != made_episodes(9, 4)


def test_what_made_scenes_say_is_so() -> None:
    """By the coordinates, read anew here."""
    seen = set()
    for one in made_episodes(240, 5):
        things = {o.id: o for o in one.objects}
        meant = things[one.target[0]]
        color = next((w for w in one.text.split() if any(w == o.color for o in one.objects)), None)
        alike = [o for o in one.objects if o.type == meant.type and color in (None, o.color)]
        left = sorted(alike, key=lambda o: -o.position[1])
        near = sorted(alike, key=lambda o: o.position[0] ** 2 + o.position[1] ** 2)
        size = sorted(alike, key=lambda o: -(o.extents or (0.0,))[0])
        for words, order in (("leftmost", left), ("rightmost", left[::-1]), ("closest to you", near)):
            if words in one.text and not {"second", "third", "fourth"} & set(one.text.split()):
                assert order[0] == meant
                seen.add(words)
        for words, order in (("from the left", left), ("third biggest", size), ("third nearest", near)):
            if words in one.text:
                ordinals = [k for k, w in enumerate(("first", "second", "third", "fourth")) if w in one.text]
                assert order[ordinals[0]] == meant
                seen.add(words)
    assert seen >= {"leftmost", "rightmost", "closest to you", "from the left"}
