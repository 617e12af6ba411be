"""What stands on the boards of racks and bookcases that are there with their extents, and what stands in things."""

from __future__ import annotations

import pytest
from asked import meant

from dcg_torch.scene.bodies import boards
from dcg_torch.types import Object, Percept

HEIGHTS = (0.2, 0.65, 1.1, 1.55)


def _jar(id_: str, y: float, z: float, type_: str = "jar", color: str | None = None) -> Percept:
    return Percept(id_, type_, color, (3.0, y, z), (0.1, 0.1, 0.2))


RACKS = [  # two racks of one name with four boards each, a jar on each board
    *(Percept(f"rack {side}", "rack", None, (3.1, y, 0.0), (0.5, 1.0, 1.9)) for side, y in (("l", 0.8), ("r", -0.8))),
    *(_jar(f"{side}{k}", y + 0.2 * (k % 2), z) for side, y in (("l", 0.8), ("r", -0.8)) for k, z in enumerate(HEIGHTS)),
]
CASE = [  # one bookcase; three tins on each of its boards
    Percept("case", "bookcase", None, (3.1, 0.0, 0.0), (0.5, 2.0, 1.9)),
    *(_jar(f"{k}{j}", 0.6 - 0.6 * j, z, "tin") for k, z in enumerate(HEIGHTS[:3]) for j in range(3)),
]


@pytest.mark.parametrize(
    ("text", "things", "ids"),
    [
        ("take the jar from the top board of the left rack", RACKS, {"l3"}),
        ("the jar on the second shelf from the bottom of the right rack", RACKS, {"r1"}),
        ("the jar on the bottom board of the rack on the right", RACKS, {"r0"}),
        ("all the jars on the left rack", RACKS, {"l0", "l1", "l2", "l3"}),
        ("the highest jar on the right rack", RACKS, {"r3"}),
        ("the lowest jar on the left rack", RACKS, {"l0"}),
        ("the jar at the top of the right rack", RACKS, {"r3"}),
        ("the jar at the bottom of the left rack", RACKS, {"l0"}),
        ("the second tin from the left on the middle shelf", CASE, {"11"}),
        ("the tin at the right end of the bottom shelf", CASE, {"02"}),
        ("the tin at the left of the top shelf", CASE, {"20"}),
        ("the middle tin on the top shelf of the bookcase", CASE, {"21"}),
        ("all tins on the middle board", CASE, {"10", "11", "12"}),
    ],
)
def test_boards_of_a_rack_are_numbered_in_it(text: str, things: list[Percept], ids: set[str]) -> None:
    assert meant(text, things) == ids


def test_what_stands_under_and_on_a_table_makes_no_boards_of_it() -> None:
    table = Object("table", "table", True, position=(2.0, 0.0, 0.0), size=(1.0, 1.0, 0.7))
    below = [Object(f"b{k}", "box", True, position=(2.0, 0.2 * k, 0.0), size=(0.1, 0.1, 0.1)) for k in range(2)]
    above = Object("on", "box", True, position=(2.0, 0.0, 0.7), size=(0.1, 0.1, 0.1))
    assert boards([table, *below, above]) == {}
    rack = Object("rack", "rack", True, position=(2.0, 0.0, 0.0), size=(1.0, 1.0, 1.4))
    assert boards([rack, *below, above]) == {"rack": {"b0": 0.0, "b1": 0.0, "on": 0.7}}
