"""Landmarks called by "one" alone: in a room of many kinds of the kind of what is meant, on a board of any."""

from __future__ import annotations

import pytest
from seen_whole import meant

from dcg_torch.types import Percept

_ROOM = [  # three posters on the wall in the north; who looks at them has the west on the left
    *(
        Percept(n, "poster", None, (x, 4.97, 1.6), size=(w, 0.04, 0.7 * w))
        for n, x, w in (("west", 1.0, 0.4), ("middle", 2.5, 1.2), ("east", 4.0, 0.4))
    ),
    Percept("bench", "bench", None, (2.5, 2.5, 0.3), size=(2.0, 0.6, 0.5)),  # bigger than any of them
    Percept("door", "door", None, (5.95, 2.0, 1.0), size=(0.1, 0.9, 2.0)),
    Percept("stove", "stove", None, (0.3, 0.4, 0.5), size=(0.6, 0.6, 0.9)),
    Percept("lamp", "lamp", None, (5.5, 0.4, 0.8), size=(0.3, 0.3, 1.6)),
    Percept("mat", "mat", None, (2.0, 1.0, 0.0), size=(1.0, 0.6, 0.02)),
]


@pytest.mark.parametrize(
    ("text", "id_"), [("the poster left of the big one", "west"), ("the poster to the right of the large one", "east")]
)
def test_the_big_one_is_of_the_kind_that_is_meant(text: str, id_: str) -> None:
    assert meant(text, _ROOM, robot=None) == [id_]


def test_on_a_board_the_big_one_may_be_of_another_kind() -> None:
    board = [
        Percept("big cube", "cube", None, (1.0, 0.0, 0.1), size=(0.3, 0.3, 0.3)),
        Percept("near ball", "ball", None, (1.0, 0.4, 0.05), size=(0.1, 0.1, 0.1)),
        Percept("far ball", "ball", None, (1.0, -0.9, 0.05), size=(0.12, 0.12, 0.12)),
    ]
    assert meant("the ball next to the big one", board) == ["near ball"]
