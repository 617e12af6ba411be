"""Words that tell no colour where things show theirs: names of classes, and small words of listed colours' names.

Scenes and commands are ours.
"""

from __future__ import annotations

import numpy as np
import pytest
from asked import grounded

from dcg_torch.names.colors import color_features
from dcg_torch.types import Percept

GREEN, RED, BROWN, PURPLE = (20, 110, 40), (190, 30, 30), (120, 70, 30), (110, 40, 150)


def _meant(text: str, things: tuple[tuple[str, str, float, float, tuple[int, int, int]], ...]) -> tuple[str, ...]:
    percepts = [Percept(id_, kind, None, (x, y, 0.0), rgb=rgb) for id_, kind, x, y, rgb in things]
    return tuple(o.id for o in grounded(text, percepts, looked=True).objects)


@pytest.mark.parametrize("kind", ["bottle", "tree", "egg", "wine bottle"])
def test_the_name_of_a_class_is_no_colour(kind: str) -> None:
    for left, right in ((GREEN, RED), (RED, GREEN), (BROWN, PURPLE)):
        things = (("l", kind, 3.0, 1.5, left), ("r", kind, 3.0, -1.5, right))
        assert _meant(f"take the {kind} on the right", things) == ("r",)
        assert _meant(f"take the {kind} on the left", things) == ("l",)


def test_colours_beside_the_name_are_heard() -> None:
    things = (("l", "bottle", 3.0, 1.5, GREEN), ("r", "bottle", 3.0, -1.5, RED))
    assert _meant("the green bottle", things) == ("l",)
    assert _meant("take the red bottle", things) == ("r",)


@pytest.mark.parametrize("words", ["the bigger of the two", "one with a ring", "a large and heavy one", "medium sized"])
def test_small_words_of_colour_names_tell_none(words: str) -> None:
    colors = np.array([GREEN, RED, BROWN, PURPLE], dtype=np.float64)
    assert not color_features(words.split(), colors).any()
    assert color_features(["a", "hint", "of", "purple"], colors)[:, 0].argmax() == 3


@pytest.mark.parametrize("words", ["blue/grey", "the blue/grey patch", "gray blue", "the blueish gray blue one"])
def test_two_colours_together_name_neither(words: str) -> None:
    """All are there, so one of them is meant, though neither word is the name that its colour is given."""
    shades = {"bluish": (100, 115, 150), "plain": (135, 132, 122), "leaf": (40, 190, 60)}
    named = {"bluish": "grey", "plain": "grey", "leaf": "green"}
    patches = [
        Percept(id_, "patch", named[id_], (1.0, y, 0.0), rgb=shades[id_])
        for id_, y in zip(shades, (-0.3, 0.0, 0.3), strict=True)
    ]
    assert [o.id for o in grounded(words, patches, looked=True).objects] == ["bluish"]


@pytest.mark.parametrize(
    ("words", "looks"),
    [("the duller green", "dull"), ("dull green", "dull"), ("the bluish green patch", "dull"), ("green", "vivid")],
)
def test_a_shade_is_judged_by_looking_and_a_plain_name_by_names_too(words: str, looks: str) -> None:
    """What is a dull bluish green may be called gray, or blue, by who knows but few names."""
    for name in ("grey", "blue"):
        patches = [
            Percept("dull", "patch", name, (1.0, 0.3, 0.0), rgb=(70, 165, 135)),
            Percept("vivid", "patch", "green", (1.0, 0.0, 0.0), rgb=(60, 200, 50)),
            Percept("other", "patch", "red", (1.0, -0.3, 0.0), rgb=RED),
        ]
        assert [o.id for o in grounded(words, patches, looked=True).objects] == [looks]


def test_a_middle_shade_may_stand_anywhere_and_the_middle_one_may_have_any() -> None:
    shades = {"l": (150, 220, 160), "m": (15, 60, 25), "r": (50, 140, 70)}
    patches = [
        Percept(id_, "patch", "green", (1.0, y, 0.0), rgb=shades[id_])
        for id_, y in zip(shades, (0.3, 0.0, -0.3), strict=True)
    ]
    for words, id_ in (("the middle shade", "r"), ("the medium green patch", "r"), ("the middle patch", "m")):
        assert [o.id for o in grounded(words, patches, looked=True).objects] == [id_], words
