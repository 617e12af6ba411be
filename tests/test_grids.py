"""Rows, columns and neighbours in racks and boards of things. The commands are ours, no person's."""

from __future__ import annotations

import pytest

from dcg_torch import GroundingModel
from dcg_torch.evaluation.episodes import Episode
from dcg_torch.evaluation.protocol import answers
from dcg_torch.interpretation.grids import by_cells
from dcg_torch.language import default_parser, parse_command
from dcg_torch.scene.grids import grid_of
from dcg_torch.types import Object, WorldModel

COLORS = ["white blue white green blue", "green white red white green", "blue green white blue white",
          "white blue green white green"]  # fmt: skip
"""By row and column; a thing's id is its row and its column from 1."""


def _rack(text: str, *, empty: tuple[str, ...] = ()) -> Episode:
    objects = [
        {"id": f"{r + 1}{c + 1}", "type": "drawer", "color": color, "position": [1.5, 0.5 - 0.25 * c, 1.0 - 0.2 * r]}
        for r, row in enumerate(COLORS)
        for c, color in enumerate(row.split())
    ]
    objects = [thing for thing in objects if thing["id"] not in empty]
    robot = {"x": 0.0, "y": 0.0, "yaw": 0.0}
    return Episode.model_validate({"id": "a", "text": text, "objects": objects, "target": [], "robot": robot})


def _meant(model: GroundingModel, episode: Episode) -> set[str]:
    (answer,) = answers(model, [episode], default_parser().parse)
    return set(answer.predicted)


ADDRESSES = [
    ("the drawer in the second row and third column", "23"),
    ("row two column three", "23"),
    ("row 3, column 2", "32"),
    ("third column second row", "23"),
    ("second column, bottom drawer", "42"),
    ("the third drawer from the left in the bottom row", "43"),
    ("top row, second from the right", "14"),
    ("the bottom drawer in the middle column", "43"),
    ("green drawer in the second lowest row", "32"),
    ("second row from the bottom, green", "32"),
    ("the blue drawer in the third row on the left", "31"),
    ("the last drawer of the first row", "15"),
    ("the drawer in the lower left corner", "41"),
    ("bottom right", "45"),
    ("open the third drawer down in the rightmost column", "35"),
    ("second box from the left, third from the top", "32"),
    ("in row 4 the third one from the right", "43"),
    ("row: 2, column: 4", "24"),
    ("bottom row, middle", "43"),
    ("far right, second row", "25"),
]
STEPS = [
    ("directly under the red one", "33"),
    ("just above the red one", "13"),
    ("the one immediately left of the red one", "22"),
    ("to the right of the red one", "24"),
    ("two to the right of the red one", "25"),
    ("two drawers below the red one", "43"),
    ("the second drawer to the left of the red one", "21"),
    ("diagonally down right of the red one", "34"),
    ("one down and one right from the red one", "34"),
    ("the blue one to the right of the green one below a blue one", "34"),
]


@pytest.mark.parametrize(("text", "meant"), [*ADDRESSES, *STEPS[:-1]])
def test_cells(model: GroundingModel, text: str, meant: str) -> None:
    assert _meant(model, _rack(text)) == {meant}


@pytest.mark.parametrize(("text", "meant"), [ADDRESSES[1], ADDRESSES[2], STEPS[0], STEPS[3], ADDRESSES[10]])
def test_cells_where_some_are_empty(model: GroundingModel, text: str, meant: str) -> None:
    assert _meant(model, _rack(text, empty=("11", "25", "44"))) == {meant}


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("my keys are in the red drawer", "23"),
        ("the scissors are in the red drawer", "23"),
        ("the scissors are in the last drawer of the first row", "15"),
        ("I keep my socks in the last drawer of the first row", "15"),
        ("put this letter into the red drawer", "23"),
        ("open the drawer red", "23"),
    ],
)
def test_what_holds_what_is_not_there(model: GroundingModel, text: str, meant: str) -> None:
    assert _meant(model, _rack(text)) == {meant}


def test_what_is_not_there_stays_absent(model: GroundingModel) -> None:
    assert _meant(model, _rack("bring me the apple in the red drawer")) == set()
    assert _meant(model, _rack("the apple in the red drawer")) == set()


PAGE = {"a": (0.5, 1.1, "red"), "b": (-0.4, 1.0, "blue"), "c": (0.1, 0.7, "red"), "d": (-0.2, 0.3, "blue"),
        "e": (0.4, 0.35, "green")}  # fmt: skip
"""On a page that stands upright: how far to the left, how high, and the colour."""


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the lowest red piece", "c"),
        ("the top blue piece", "b"),
        ("the blue piece below the other blue piece", "d"),
        ("the blue one, but not the one at the top", "d"),
        ("the red piece above the green piece", "a"),
    ],
)
def test_pages_that_stand_upright(model: GroundingModel, text: str, meant: str) -> None:
    objects = [
        {"id": k, "type": "piece", "color": color, "position": [1.0, y, z], "size": [0.02, 0.12, 0.12]}
        for k, (y, z, color) in PAGE.items()
    ]
    robot = {"x": 0.0, "y": 0.0, "yaw": 0.0}
    episode = {"id": "a", "text": text, "objects": objects, "target": [], "robot": robot}
    assert _meant(model, Episode.model_validate(episode)) == {meant}


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the corner drawers", "11 15 41 45"),
        ("open all four corner drawers", "11 15 41 45"),
        ("the drawers in the corners", "11 15 41 45"),
        ("the green corner drawer", "45"),
        ("the blue drawers in the corners", "11 41"),
        ("the red drawer on the edge", "15"),
        ("the bottom drawer in the middle", "43"),
        ("the drawer in the middle at the top", "13"),
    ],
)
def test_rims_and_corners(model: GroundingModel, text: str, meant: str) -> None:
    colors = {"11": "blue", "15": "red", "41": "blue", "45": "green"}
    episode = _rack(text)
    of = {"objects": [o.model_copy(update={"color": colors.get(o.id, o.color)}) for o in episode.objects]}
    assert _meant(model, episode.model_copy(update=of)) == set(meant.split())


def _objects(points: list[tuple[float, float, float]]) -> list[Object]:
    return [Object(f"o{k}", "block", False, position=point) for k, point in enumerate(points)]


def test_grid_of_a_rack_and_of_a_board() -> None:
    rack = [(2.0, 0.3 - 0.3 * c, 0.9 - 0.4 * r) for r in range(3) for c in range(3)]
    board = [(2.0 - 0.4 * r, 0.3 - 0.3 * c, 0.0) for r in range(3) for c in range(3)]
    for points in (rack, board):
        found = grid_of(_objects(points))
        assert found is not None
        assert (found.rows, found.columns) == (3, 3)
        assert found.cells == {f"o{k}": divmod(k, 3) for k in range(9)}


def test_no_grids() -> None:
    board = [(2.0 - 0.4 * r, 0.3 - 0.3 * c, 0.0) for r in range(3) for c in range(3)]
    assert grid_of(_objects([*board, (3.3, 0.1, 0.0)])) is None
    assert grid_of(_objects([*board[:-1], board[0]])) is None  # a stack has no cell of its own
    assert grid_of(_objects(board[:4])) is None
    assert grid_of(_objects([(0.1 * k * k, 0.3 * k, 0.0) for k in range(8)])) is None


def test_only_grids_have_cells() -> None:
    tree = parse_command("the block in the second row").tree
    assert tree is not None
    scattered = WorldModel(tuple(_objects([(0.1 * k * k, 0.3 * k, 0.0) for k in range(8)])))
    assert by_cells([tree], scattered) == [tree]
    board = WorldModel(tuple(_objects([(2.0 - 0.4 * r, 0.3 - 0.3 * c, 0.0) for r in range(3) for c in range(3)])))
    words = [word for node in by_cells([tree], board)[0].walk() for word in node.phrase.words]
    assert "cell: 2 1|2 2|2 3" in words
