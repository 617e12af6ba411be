"""How tall, how high, how dark and how far apart things are; pages of pictures; a place that is said alone."""

from __future__ import annotations

import numpy as np
import pytest
from asked import grounded
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch.language import parse_command, target_phrase
from dcg_torch.lessons.looks import height_scene, lonely_scene, shelf_scene
from dcg_torch.names.colors import comparing_words
from dcg_torch.scene.neighbours import nearest_other
from dcg_torch.scene.upright_pictures import laid_flat
from dcg_torch.types import Percept


@given(st.integers(0, 2**32 - 1), st.integers(2, 400))
def test_the_nearest_other_thing(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(count, 3))
    points[rng.random(count) < 0.1] = np.nan
    found = nearest_other(points)
    there = [k for k in range(count) if np.isfinite(points[k]).all()]
    for k in range(0, count, max(1, count // 20)):
        others = [float(np.linalg.norm(points[k] - points[j])) for j in there if j != k]
        if k in there and others:
            assert found[k] == pytest.approx(min(others))
        else:
            assert np.isnan(found[k])


def test_a_full_page_of_pictures_is_laid_flat_and_two_stacks_are_not() -> None:
    page = np.array([[2.0, y, z] for z in (0.6, 1.2, 1.8) for y in (-1.0, 0.0, 1.0)])
    assert np.ptp(laid_flat(page)[:, 2]) == 0.0
    stacks = np.array([[2.0, y, z] for z in (0.0, 1.0, 2.0) for y in (-1.0, 1.0)])
    assert (laid_flat(stacks) == stacks).all()


def test_words_that_compare_colors() -> None:
    assert comparing_words(("big", "darkest", "round", "pale", "bluer")) == ("darkest", "pale", "bluer")


@pytest.mark.parametrize("maker", [height_scene, shelf_scene, lonely_scene])
def test_lessons_mean_one_thing_of_the_kind_they_say(maker: object) -> None:
    assert callable(maker)
    rng = np.random.default_rng(5)
    told = 0
    for _ in range(30):
        scene = maker(rng)
        kinds = {o.id: o.type for o in scene.objects}
        for text, meant in scene.commands:
            (one,) = meant
            assert kinds[one] in text
            told += 1
    assert told > 30


Row = tuple[str, str | None, tuple[float, float, float], tuple[float, float, float] | None]


def _things(*rows: Row) -> list[Percept]:
    return [Percept(f"o{k}", type_, color, at, size) for k, (type_, color, at, size) in enumerate(rows)]


SMALL = (0.2, 0.2, 0.2)
LAMPS = _things(
    ("lamp", None, (2.0, 1.0, 0.0), (0.3, 0.3, 0.5)),
    ("lamp", None, (3.0, 0.0, 0.0), (0.2, 0.2, 1.7)),
    ("lamp", None, (4.0, -1.0, 0.0), (0.9, 0.9, 0.9)),
    ("sofa", None, (3.0, 2.5, 0.0), (2.0, 0.9, 2.0)),
)
PICTURES = _things(
    ("picture", None, (2.0, 1.0, 1.1), None),
    ("picture", None, (3.0, 0.0, 1.9), None),
    ("picture", None, (4.0, -1.0, 0.4), None),
    ("sofa", None, (3.0, 2.5, 0.0), None),
)
DOTS = _things(
    ("dot", "black", (0.5, 0.4, 0.0), SMALL),
    ("dot", "gray", (1.0, 0.3, 0.0), SMALL),
    ("dot", "light gray", (1.5, 0.5, 0.0), SMALL),
    ("dot", "dark gray", (2.0, -2.0, 0.0), SMALL),
)


@pytest.mark.parametrize(
    ("text", "things", "meant"),
    [
        ("the tallest lamp", LAMPS, "o1"),
        ("the shortest lamp", LAMPS, "o0"),
        ("the biggest lamp", LAMPS, "o2"),
        ("the highest picture", PICTURES, "o1"),
        ("the lowest picture", PICTURES, "o2"),
        ("the second picture from the top", PICTURES, "o0"),
        ("the darkest dot", DOTS, "o0"),
        ("the lightest dot", DOTS, "o2"),
        ("the dot by itself", DOTS, "o3"),
        ("the lonely dot", DOTS, "o3"),
        ("the highest dot", DOTS, "o3"),
        ("the second dot from the bottom", DOTS, "o1"),
    ],
)
def test_the_shipped_model_compares_looks(text: str, things: list[Percept], meant: str) -> None:
    answer = grounded(text, things, looked=True)
    assert answer.object is not None
    assert answer.object.id == meant


@pytest.mark.parametrize(
    ("text", "place"), [("Top left? The black dot.", "left"), ("The black dot. In the corner.", "corner")]
)
def test_a_place_that_is_said_alone_belongs_to_the_thing(text: str, place: str) -> None:
    tree = parse_command(text).tree
    assert tree is not None
    said = target_phrase(tree)
    assert (said.phrase.noun, said.phrase.color) == ("dot", "black")
    assert [child.phrase.noun for below in said.children for child in below.children] == [place]


@pytest.mark.parametrize("text", ["top left corner", "bottom right", "the corner", "between the two dots"])
def test_of_a_thing_only_its_place_may_be_said(text: str) -> None:
    tree = parse_command(text).tree
    assert tree is not None
    assert target_phrase(tree).phrase.noun is None
    assert target_phrase(tree).children
