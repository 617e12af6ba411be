"""Rooms of one file in which nobody stands: each has walls, corners and sides of its own."""

from __future__ import annotations

import pytest
from asked import meant

from dcg_torch import Percept
from dcg_torch.evaluation.episodes import Episode, workspace
from dcg_torch.scene.room_walls import room_walls
from dcg_torch.scene.workspace import Workspace

_WASHROOM = [  # 3 m x 3 m; who stands before the basins looks along y, and has low x on the left
    *(Percept(f"basin {n}", "basin", None, (x, 2.8, 0.9), size=(0.5, 0.4, 0.2)) for n, x in ((1, 0.8), (2, 1.8))),
    *(Percept(f"hook {n}", "hook", None, (x, 2.95, 1.8), size=(0.1, 0.1, 0.1)) for n, x in ((1, 0.8), (2, 1.8))),
    Percept("door", "door", None, (2.95, 1.5, 1.0), size=(0.1, 0.9, 2.0)),
    Percept("tub", "bathtub", None, (1.5, 0.4, 0.3), size=(1.6, 0.8, 0.6)),
    Percept("mat", "mat", None, (1.5, 1.4, 0.0), size=(0.8, 0.5, 0.02)),
    Percept("bin", "bin", None, (0.2, 2.7, 0.2), size=(0.3, 0.3, 0.4)),
    Percept("stool", "stool", None, (2.2, 1.0, 0.2), size=(0.3, 0.3, 0.4)),
    Percept("shelf", "shelf", None, (0.1, 1.5, 1.5), size=(0.2, 0.8, 0.05)),
    Percept("towel", "towel", None, (0.05, 0.3, 1.0), size=(0.1, 0.4, 0.8)),
]
_OF_ALL = Workspace((0.0, 12.0, 0.0, 9.0), 0.6)
"""Bounds of the largest room in a file."""


def _episode(id_: str, things: list[Percept]) -> Episode:
    listed = [{"id": t.id, "type": t.type, "position": t.position, "size": t.size} for t in things]
    return Episode.model_validate({"id": id_, "text": "the door", "objects": listed, "target": [things[0].id]})


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the left basin", "basin 1"),
        ("the basin on the right", "basin 2"),
        ("the hook over the left basin", "hook 1"),
    ],
)
@pytest.mark.parametrize("workspace_", [None, _OF_ALL])
def test_sides_are_those_of_the_own_walls(text: str, id_: str, workspace_: Workspace | None) -> None:
    assert meant(text, _WASHROOM, None, looked=True, workspace=workspace_) == {id_}


def test_rooms_have_no_bounds_in_common_and_boards_have() -> None:
    hall = [Percept(t.id, t.type, None, (4.0 * t.position[0], 3.0 * t.position[1], 0.0)) for t in _WASHROOM]
    board = [Percept(f"p{k}", "cube", None, (float(k % 4), float(k // 4), 0.0)) for k in range(12)]
    assert room_walls(_WASHROOM) is not None
    assert room_walls(board) is None
    assert room_walls(_WASHROOM[:9]) is None
    assert workspace([_episode("a", _WASHROOM), _episode("b", hall)]).bounds is None
    assert workspace([_episode("a", board), _episode("b", board[:4])]).bounds == (0.0, 3.0, 0.0, 2.0)
