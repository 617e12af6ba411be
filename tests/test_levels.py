"""Which block of which stack: stacks told by how many blocks they have. Scenes and commands are ours."""

from __future__ import annotations

import pytest
from asked import meant

from dcg_torch.types import Percept

STACKS = {"a": (1.8, 0.8, 2), "b": (2.6, -0.4, 4), "c": (1.4, -1.0, 3)}  # x, y, how many
SINGLE = (("d", 2.4, 0.5), ("e", 1.2, 0.1))


def _meant(text: str) -> set[str]:
    colors = ("red", "green", "blue", "yellow")
    percepts = [
        Percept(f"{name}{z}", "block", colors[(x > 2.0) + z - 1], (x, y, 0.04 + 0.08 * z), (0.08,) * 3)
        for name, (x, y, count) in STACKS.items()
        for z in range(count)
    ]
    percepts += [Percept(name, "block", "red", (x, y, 0.04), (0.08,) * 3) for name, x, y in SINGLE]
    return meant(text, percepts, looked=True)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the top block of the stack of two", "a1"),
        ("take the topmost one of the tower of three", "c2"),
        ("the upper block in the pile of four", "b3"),
        ("the lowest one of the stack of four", "b0"),
        ("the bottom block of the stack of two blocks", "a0"),
        ("the block at the base of the stack of three", "c0"),
        ("the block at the foot of the tower of four", "b0"),
        ("the second block from the bottom in the stack of four", "b1"),
        ("the third one from the top of the stack of four", "b1"),
    ],
)
def test_a_level_of_a_stack_that_is_told_by_its_number(text: str, meant: str) -> None:
    assert _meant(text) == {meant}
