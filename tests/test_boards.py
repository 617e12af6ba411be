"""Rows and columns of a whole scene, places of all that is there, and the lessons on them."""

from __future__ import annotations

import re
import sys

import numpy as np
import pytest

from dcg_torch.interpretation.factor_tree import speaks_of_lines, to_factor_tree
from dcg_torch.language import default_parser
from dcg_torch.lessons.arranged import KINDS
from dcg_torch.lessons.boards import board_scene
from dcg_torch.lessons.selections import ORDINALS
from dcg_torch.scene.groups import groups, lines_of_all
from dcg_torch.scene.layout import layout
from dcg_torch.scene.ranks import RANKS, ranks
from dcg_torch.types import Object, ParseTree, PhraseKind, Pose, WorldModel

_SEAT = Pose(-2.0, 0.0)


def _board(*places: tuple[float, float, float]) -> tuple[Object, ...]:
    return tuple(Object(f"o{k}", "cube", known=True, position=place) for k, place in enumerate(places))


def _members(objects: tuple[Object, ...], *attributes: str) -> set[str]:
    (line,) = (g for g in lines_of_all(objects, 1.0, _SEAT) if {*attributes} <= g.attributes)
    return set(line.members)


_TRIANGLE = _board(
    (5.0, 0.0, 0.0), (3.1, 1.0, 0.0), (3.0, -1.0, 0.0), (1.0, 2.0, 0.0), (1.0, 0.1, 0.0), (1.2, -2.0, 0.0)
)


@pytest.mark.parametrize(
    ("attributes", "meant"),
    [
        (("line across", "1 from the top"), {"o0"}),
        (("line across", "2 from the top"), {"o1", "o2"}),
        (("line across", "1 from the bottom"), {"o3", "o4", "o5"}),
        (("line across", "3 from the top"), {"o3", "o4", "o5"}),
        (("line across", "middle line"), {"o1", "o2"}),
        (("line along", "1 from the left"), {"o3"}),
        (("line along", "3 from the left"), {"o0", "o4"}),
        (("line along", "1 from the right"), {"o5"}),
    ],
)
def test_lines_are_counted_from_either_end(attributes: tuple[str, ...], meant: set[str]) -> None:
    assert _members(_TRIANGLE, *attributes) == meant


def test_of_a_stack_the_top_alone_is_in_a_line() -> None:
    objects = _board((2.0, 1.0, 0.0), (2.0, 1.0, 1.0), (2.0, -1.0, 0.0), (4.0, 0.0, 0.0))
    assert _members(objects, "line across", "1 from the bottom") == {"o1", "o2"}


def test_lines_are_no_rows_of_their_own() -> None:
    assert all(not {"line across", "line along"} & g.attributes for g in groups(_TRIANGLE, 1.0, _SEAT))


def _rank(objects: tuple[Object, ...], axis: str) -> str:
    found = ranks(layout(WorldModel(objects, _SEAT)))
    first = RANKS.index(f"rank: {axis} 1")
    return " ".join(o.id for o, row in zip(objects, found.tolist(), strict=True) if first in row)


def test_the_middle_of_all_is_that_of_the_box_around_it() -> None:
    crowded = _board(
        (0.0, 0.0, 0.0), (0.5, 0.5, 0.0), (0.0, 1.0, 0.0), (0.5, -0.6, 0.0), (5.0, 0.0, 0.0), (10.0, 0.0, 0.0)
    )
    assert _rank(crowded, "middle") == "o4"


def _nodes(text: str) -> str:
    tree = default_parser().parse(text, ()).tree
    assert tree is not None
    found = to_factor_tree(tree, WorldModel(_TRIANGLE, _SEAT))
    nouns = [node.phrase for node in found.walk() if node.phrase.kind is PhraseKind.NOUN]
    return "; ".join(", ".join((phrase.noun or "", *phrase.words)) for phrase in nouns)


@pytest.mark.parametrize(
    ("text", "nouns"),
    [
        ("take the second cube in the third row", "cube, second, from the left; line across, 3 from the top"),
        (
            "take the second cube from the right in the top row",
            "cube, second, from the right; line across, 1 from the top",
        ),
        ("take the first cube from the last row", "cube, first, from the left; line across, 1 from the bottom"),
        ("take the last cube in the second column from the right", "cube, last; line along, 2 from the right"),
        ("take the cube in the middle row", "cube; line across, middle line"),
        ("take the cube in the row", "cube; row"),
        ("take the cube from the top left of the board", "cube; corner, top, left"),
        ("take the southwesternmost cube", "cube; corner, bottom, left"),
        ("take the cube closest to the corner of the table", "cube; corner"),
        ("take the single cube", "cube, alone"),
    ],
)
def test_places_of_all_in_plain_words(text: str, nouns: str) -> None:
    assert _nodes(text) == nouns


def _said(tree: ParseTree) -> str:
    words = [w for w in (*tree.phrase.words, tree.phrase.noun) if w]
    return f"{' '.join(words)}({' '.join(map(_said, tree.children))})" if tree.children else " ".join(words)


@pytest.mark.parametrize(
    ("text", "read"),
    [
        ("move the cube on the left so that it is behind the cone", "move(cube(on(left)) behind(cone))"),
        ("take the red cube on the left to form a row of three", "take(cube(on(left)))"),
        ("take the cube that is leftmost and put it on the table", "take(leftmost cube on(table))"),
        ("the top cube moves left until it is behind the cone", "move(top cube to(left))"),
        ("the bottom cube takes a neighbour from the left", "take(bottom cube from(left))"),
        ("take the third highest cube on the left", "take(third highest cube(on(left)))"),
        ("take the cube on the left that is second from the top", "take(second from the top cube(on(left)))"),
    ],
)
def test_what_comes_of_an_order_does_not_describe_its_object(text: str, read: str) -> None:
    tree = default_parser().parse(text, ()).tree
    assert tree is not None
    assert _said(tree) == read


def test_lessons_on_lines_mean_what_they_say() -> None:
    rng, counted = np.random.default_rng(3), 0
    for scene in (board_scene(rng) for _ in range(60)):
        there = {o.id for o in scene.objects}
        objects = tuple(Object(o.id, o.type, known=True, position=o.position) for o in scene.objects)
        for text, meant in scene.commands:
            assert meant <= there
            named = re.search(rf"in the ({'|'.join(ORDINALS)}) (row|column)$", text)
            if named is not None:
                counted += 1
                end, line = ("top", "line across") if named[2] == "row" else ("left", "line along")
                number = ORDINALS.index(named[1]) + 1
                lines = lines_of_all(objects, 1.0, scene.robot)
                assert any(meant <= set(g.members) for g in lines if {line, f"{number} from the {end}"} <= g.attributes)
    assert counted > 20


def test_lessons_on_boards_are_read_as_orders() -> None:
    rng, parse = np.random.default_rng(4), default_parser().parse
    for scene in (board_scene(rng) for _ in range(40)):
        for text, _ in scene.commands[:3]:
            tree = parse(text, KINDS).tree
            assert tree is not None, text
            in_line = bool(re.search(r"\b(row|column)\b", text))
            assert speaks_of_lines(to_factor_tree(tree, WorldModel(_TRIANGLE, _SEAT))) == in_line, text


def test_groups_are_the_same_when_near_things_are_found_with_a_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        points = rng.uniform(0.0, 8.0, (int(rng.integers(5, 50)), 3)) * [1.0, 1.0, 0.2]
        objects = [
            Object(f"o{k}", "cube", known=True, position=(float(p[0]), float(p[1]), float(p[2])))
            for k, p in enumerate(points)
        ]
        found = []
        for many in (512, 3):
            monkeypatch.setattr(sys.modules["dcg_torch.scene.groups"], "_MANY", many)
            found.append({group.id for group in (*groups(objects), *lines_of_all(objects))})
        assert found[0] == found[1]
