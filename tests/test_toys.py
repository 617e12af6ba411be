"""Toys of many shapes: a block is any of them, a shape is anything, and who is by a thing is nearer than others of it.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch import Percept
from dcg_torch.language.lexicon import SETS
from dcg_torch.names.relations import listed

BOARD = [  # a table before the robot: x is away from it, y to its left
    *(
        Percept(f"{color} {shape}", shape, color, (*at, 0.02), size=(0.04, 0.04, 0.04))
        for shape, color, at in (
            ("star", "red", (0.9, 0.4)),
            ("hexagon", "red", (0.5, -0.3)),
            ("moon", "blue", (0.55, -0.1)),
            ("heart", "green", (0.9, -0.45)),
            ("cylinder", "green", (0.4, 0.45)),
            ("pentagon", "yellow", (0.85, 0.2)),
        )
    ),
]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the leftmost red block", {"red star"}),
        ("push the red block closest to the moon to the left", {"red hexagon"}),
        ("take the red shape by the moon", {"red hexagon"}),
        ("slide the red piece next to the pentagon down", {"red star"}),
        ("push the green block that is not the heart away", {"green cylinder"}),
        ("not the red star, the other red block", {"red hexagon"}),
        ("the other green block, not the green cylinder", {"green heart"}),
        ("push all the red blocks together", {"red star", "red hexagon"}),
        ("group the green shapes", {"green heart", "green cylinder"}),
        ("line up the red blocks", {"red star", "red hexagon"}),
        ("make the heart touch the moon", {"green heart"}),
        ("push against the moon so it moves left", {"blue moon"}),
        ("scoot the moon towards the red star", {"blue moon"}),
        ("you see the moon? move the red shape nearest it to the heart", {"red hexagon"}),
        ("the block farthest left should go to the moon", {"green cylinder"}),
    ],
)
def test_blocks_of_any_shape(text: str, expected: set[str]) -> None:
    assert {o.id for o in grounded(text, BOARD).objects} == expected


def test_a_block_is_a_cube_where_no_class_is_an_outline() -> None:
    solids = [
        Percept("cube", "cube", "red", (1.0, 0.3, 0.1), size=(0.2, 0.2, 0.2)),
        Percept("sphere", "sphere", "red", (1.0, -0.3, 0.1), size=(0.2, 0.2, 0.2)),
        Percept("cylinder", "cylinder", "red", (1.4, 0.0, 0.1), size=(0.2, 0.2, 0.2)),
    ]
    assert [o.id for o in grounded("the red block", solids).objects] == ["cube"]


def test_language_and_names_agree_on_what_may_have_any_shape() -> None:
    """The parser knows no scene, so it has a list of its own of what "not the heart" may be said of."""
    assert SETS["toys"] <= listed("toy of any shape") | listed("whatever there is")
