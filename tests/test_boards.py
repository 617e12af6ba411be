"""Places, ranks and groups on a board of blocks that look alike. All commands here were written for this project."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import asked
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch.interpretation.plain_sets import of_its_members
from dcg_torch.language import parse_command
from dcg_torch.model.pretrain import pretrained
from dcg_torch.scene.clusters import clusters
from dcg_torch.scene.places import side_middles
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Phrase, PhraseKind, Pose

STEP = 0.15
EDGES = (1.0, 2.5, -0.75, 0.75)
ROBOT = Pose(0.0, 0.0)
Spots = dict[str, tuple[float, float, int]]


def meant(text: str, spots: Spots) -> set[str]:
    """What a command means on a board of ten by ten blocks: id -> (columns to the right, rows up, level)."""
    things = [
        Percept(name, "block", None, (1.0 + STEP * up, 0.75 - STEP * right, STEP * level), (STEP, STEP, STEP))
        for name, (right, up, level) in spots.items()
    ]
    return asked.meant(text, things, ROBOT, workspace=Workspace(EDGES, STEP))


def scattered(seed: int) -> Spots:
    """Eight blocks in eight rows and eight columns, and one on one of the lower half."""
    rng = np.random.default_rng(seed)
    columns, rows = rng.permutation(10)[:8].tolist(), sorted(rng.permutation(10)[:8].tolist(), reverse=True)
    spots = {f"b{k}": (column, row, 0) for k, (column, row) in enumerate(zip(columns, rows, strict=True))}
    below = f"b{int(rng.integers(5, 8))}"
    return {**spots, "over": (*spots[below][:2], 1)}


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("word", "place"), [("second", 1), ("third", 2), ("fourth", 3)])
def test_the_second_highest_block_is_so_on_the_board(seed: int, word: str, place: int) -> None:
    """Two levels have no second, third and fourth: the rows of the board do. Blocks are named from the top row down."""
    for text in (f"take the {word} highest block", f"the {word} highest block on the board moves one space down"):
        assert meant(text, scattered(seed)) == {f"b{place}"}, text


def test_the_highest_of_many_kinds_is_the_top_of_the_stack() -> None:
    """Only where all are of one kind are heights mere stacks."""
    books = [Percept(f"book {k}", "book", None, (1.5, 0.2, 0.04 * k), (0.2, 0.15, 0.04)) for k in range(3)]
    mugs = [Percept(f"mug {k}", "mug", None, (1.2 + 0.2 * k, -0.4, 0.0), (0.08, 0.08, 0.1)) for k in range(4)]
    model = pretrained()
    world = model.world_model([*books, *mugs], ROBOT, workspace=Workspace(EDGES, 0.25))
    assert [o.id for o in model.ground("take the highest book", world).objects] == ["book 2"]


@pytest.mark.parametrize("place", ["in the grid", "on the board", "in the picture", "of the scene", "on the screen"])
def test_what_is_in_the_picture_is_anywhere_in_it(place: str) -> None:
    for seed in range(4):
        spots = scattered(seed)
        assert meant(f"move the top block {place} to the left", spots) == {"b0"}
        rightmost = max((s for s in spots if s != "over"), key=lambda s: spots[s][0])
        if spots[rightmost][:2] != spots["over"][:2]:
            assert meant(f"take the rightmost block {place}", spots) == {rightmost}


MIDDLES: Spots = {
    **{"top": (5, 9, 0), "bottom": (4, 0, 0), "left": (0, 5, 0), "right": (9, 4, 0), "center": (5, 5, 0)},
    **{"nw": (0, 9, 0), "ne": (9, 9, 0), "sw": (0, 0, 0), "se": (9, 0, 0)},
}


@pytest.mark.parametrize("side", ["top", "bottom", "left", "right"])
@pytest.mark.parametrize(
    "text",
    [
        "take the {side} middle block",
        "take the middle {side} block",
        "move the block in the middle of the {side} side",
        "pick up the block at the {side} center",
    ],
)
def test_the_middle_of_a_side_is_a_place(side: str, text: str) -> None:
    assert meant(text.format(side=side), MIDDLES) == {side}


def test_the_middle_one_of_many_strewn_about_is_at_the_middle() -> None:
    """Where one is plainly the nearest to the middle of the board."""
    plain = 0
    for seed in range(30):
        spots = {name: spot for name, spot in scattered(seed).items() if name != "over"}
        away = {name: math.dist(spot[:2], (5.0, 5.0)) for name, spot in spots.items()}
        first, second = sorted(away.values())[:2]
        if second > 1.3 * first:
            plain += 1
            assert meant("take the middle block", spots) == {min(away, key=away.__getitem__)}, seed
    assert plain > 10


@given(box=st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=4, unique=True))
def test_the_middle_of_a_side_is_that_of_the_box_around_what_is_there(box: list[float]) -> None:
    near, far = sorted(box[:2])
    right, left = sorted(box[2:])
    at = {tuple(o.attributes): o.position[:2] for o in side_middles((near, far, right, left), ROBOT) if o.position}
    middle = ((near + far) / 2.0, (right + left) / 2.0)
    expected = {
        ("near side",): (near, middle[1]),
        ("far side",): (far, middle[1]),
        ("left side",): (middle[0], left),
        ("right side",): (middle[0], right),
    }
    assert at.keys() == expected.keys()
    assert all(math.dist(at[side], expected[side]) < 1e-9 for side in expected)


@pytest.mark.parametrize(("end", "row"), [("top", 9), ("bottom", 0)])
@pytest.mark.parametrize(("side", "column"), [("left", 0), ("right", 9)])
def test_the_top_of_a_side_is_a_corner(end: str, row: int, side: str, column: int) -> None:
    name = next(n for n, spot in MIDDLES.items() if spot == (column, row, 0))
    assert meant(f"take the block at the {end} of the {side} side", MIDDLES) == {name}


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(
    "text", ["of the two blocks on the right take the {} one", "there are two blocks on the right. take the {} one"]
)
def test_of_two_on_a_side_one_is_picked(seed: int, text: str) -> None:
    spots = {name: spot for name, spot in scattered(seed).items() if name != "over"}
    lower, upper = sorted(sorted(spots, key=lambda name: -spots[name][0])[:2], key=lambda name: spots[name][1])
    assert meant(text.format("upper"), spots) == {upper}
    assert meant(text.format("lower"), spots) == {lower}


COLUMN: Spots = {
    **{"first": (1, 9, 0), "second": (2, 7, 0), "third": (0, 3, 0), "fourth": (2, 0, 0)},
    **{"a": (6, 8, 0), "b": (9, 6, 0), "c": (8, 4, 0), "d": (7, 1, 0)},
}


@pytest.mark.parametrize("number", ["first", "second", "third"])
@pytest.mark.parametrize(
    "text", ["take the {} block from the top on the left side", "on the left, the {} block from the top"]
)
def test_an_ordinal_on_a_side_counts_through_it(number: str, text: str) -> None:
    """Those on the left side are not its leftmost one alone."""
    assert meant(text.format(number), COLUMN) == {number}


ROW: Spots = {
    **{"row 1": (2, 5, 0), "row 2": (3, 5, 0), "row 3": (4, 5, 0), "left": (0, 5.4, 0), "above": (3, 7, 0)},
    **{"foot": (8, 8, 0), "head": (8, 8, 1), "by": (6, 8, 0), "far": (9, 1, 0)},
}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("take the block to the left of the three-block line", {"left"}),
        ("take the block left of the line of three blocks", {"left"}),
        ("move the block above the three block row", {"above"}),
        ("take the top of the two-story tower", {"head"}),
        ("take the top of the tower", {"head"}),
        ("take the top block of the two block tower", {"head"}),
    ],
)
def test_what_is_named_by_its_members_is_a_group(text: str, expected: set[str]) -> None:
    assert meant(text, ROW) == expected


@pytest.mark.parametrize(
    ("text", "noun", "count", "there", "expected"),
    [
        ("the three block line", "block line", 3, ["block"], ("block", ("line", "of 3"))),
        ("the two story building", "story building", 2, ["block"], (None, ("stack", "of 2"))),
        ("the block tower", "block tower", None, ["block"], ("block", ("tower",))),
        ("the block tower", "block tower", None, ["block", "tower"], ("block tower", ())),
        ("the washing line", "washing line", None, ["shirt"], ("washing line", ())),
        ("the two book stacks", "book stack", 2, ["book"], ("book stack", ())),
    ],
)
def test_only_groups_are_made_of_their_members(
    text: str, noun: str, count: int | None, there: list[str], expected: tuple[str | None, tuple[str, ...]]
) -> None:
    """A class of that name is meant itself, and several groups are no group of several."""
    phrase = of_its_members(Phrase(PhraseKind.NOUN, text, noun=noun, count=count), frozenset(there))
    assert (phrase.noun, phrase.words) == expected


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(2, 9))
def test_a_pair_is_two_that_are_each_others_nearest(seed: int, count: int) -> None:
    points = np.random.default_rng(seed).uniform(0.0, 20.0, (count, 3))
    apart = np.linalg.norm(points[:, None, :2] - points[None, :, :2], axis=2) + np.diag([np.inf] * count)
    nearest = apart.argmin(axis=1).tolist()
    pairs = {(i, j) for i, j in itertools.combinations(range(count), 2) if nearest[i] == j and nearest[j] == i}
    wide = {pair for pair in pairs if apart[pair] > 0.7}  # what is closer is one spot
    code = np.zeros(count, dtype=np.int64)
    found = {tuple(sorted(of)) for of in clusters(points, code, pairs=True) if len(of) == 2}
    assert wide <= found <= pairs
    assert not [of for of in clusters(points, code) if len(of) == 2]


@pytest.mark.parametrize("word", ["single", "lone", "solitary"])
@pytest.mark.parametrize(
    ("place", "turn"),
    [
        ("at the bottom", lambda x, y: (x, y)),
        ("at the top", lambda x, y: (x, 9 - y)),
        ("on the left", lambda x, y: (y, x)),
        ("on the right", lambda x, y: (9 - y, x)),
    ],
)
def test_what_stands_alone_is_in_no_stack(word: str, place: str, turn: Callable[[int, int], tuple[int, int]]) -> None:
    """The stack is nearest to the edge, but no block of it is a single one. Three stand together at the other edge."""
    spots = {"under": (4, 0, 0), "over": (4, 0, 1), "one": (8, 1, 0), "a": (0, 9, 0), "b": (1, 8, 0), "c": (2, 9, 0)}
    turned: Spots = {name: (*turn(x, y), level) for name, (x, y, level) in spots.items()}
    assert meant(f"move the {word} block {place} onto the stack", turned) == {"one"}


def test_what_stands_on_a_table_may_stand_alone() -> None:
    """Only of its kind nothing is there: the table is not of the lamp's."""
    things = [
        Percept("table", "table", None, (1.5, 0.9, 0.0), (0.8, 0.8, 0.7)),
        Percept("on it", "lamp", None, (1.5, 0.9, 0.7), (0.2, 0.2, 0.4)),
        *(Percept(f"lamp {k}", "lamp", None, (2.0, -0.6 - 0.3 * k, 0.0), (0.2, 0.2, 0.4)) for k in range(3)),
    ]
    assert asked.meant("take the single lamp on the left", things, ROBOT) == {"on it"}


@pytest.mark.parametrize(
    ("short", "long", "block"),
    [
        ("the bottom left table corner", "the bottom left corner of the table", "a"),
        ("the top right board corner", "the top right corner of the board", "d"),
        ("the grid center", "the center of the grid", "e"),
    ],
)
def test_a_table_corner_is_a_corner_of_the_table(short: str, long: str, block: str) -> None:
    spots: Spots = {"a": (0, 0, 0), "b": (9, 1, 0), "c": (1, 9, 0), "d": (9, 8, 0), "e": (5, 4, 0)}
    assert meant(f"take the block closest to {short}", spots) == {block}
    one, other = (parse_command(f"take the block closest to {words}").tree for words in (short, long))
    assert one == other


def test_a_table_center_piece_is_no_center_of_the_table() -> None:
    tree = parse_command("take the table center piece").tree
    assert tree is not None
    assert all(node.phrase.noun != "center" for node in tree.walk())
