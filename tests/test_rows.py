"""Rows of things that stand beside one another. All commands here were written for this project."""

from __future__ import annotations

import pytest
from asked import shipped

from dcg_torch.scene.groups import groups
from dcg_torch.types import Object, Percept, Pose, WorldModel

NUMBERS = {3: "three", 4: "four", 5: "five"}
SIZES = [(3, 5), (5, 3), (4, 3), (4, 5), (4, 4)]
HERE = Pose(0.0, 0.0)


def two_rows(left: int, right: int) -> WorldModel:
    """A row of tires on the left, one on the right and farther off one of cones, and a crate."""
    spots = [(f"a{k}", "tire", 4.0, 4.0 - 0.8 * k) for k in range(left)]
    spots += [(f"b{k}", "tire", 4.0, -1.2 - 0.8 * k) for k in range(right)]
    spots += [(f"o{k}", "cone", 7.0 + 0.8 * k, 0.5) for k in range(3)] + [("z", "crate", 6.5, 4.0)]
    things = [Percept(name, kind, None, (x, y, 0.0), (0.4, 0.4, 0.4)) for name, kind, x, y in spots]
    return shipped().world_model(things, HERE)


def meant(text: str, world: WorldModel) -> list[str]:
    return sorted(o.id for o in shipped().ground(text, world).objects)


@pytest.mark.parametrize(("left", "right"), SIZES)
def test_the_left_row_is_the_one_farthest_to_the_left(left: int, right: int) -> None:
    world = two_rows(left, right)
    assert meant("the tires in the left row", world) == [f"a{k}" for k in range(left)]
    assert meant("the tires in the right row", world) == [f"b{k}" for k in range(right)]
    assert meant("the rightmost tire in the left row", world) == [f"a{left - 1}"]
    assert meant("the leftmost tire in the right row", world) == ["b0"]
    assert meant("the tire at the right end of the left row", world) == [f"a{left - 1}"]


@pytest.mark.parametrize(("left", "right"), SIZES[:-1])
def test_two_of_a_row_of_so_many_are_two(left: int, right: int) -> None:
    """A row of three is not two of its things."""
    world = two_rows(left, right)
    assert meant(f"the two leftmost tires in the row of {NUMBERS[right]}", world) == ["b0", "b1"]
    assert meant(f"the two rightmost tires in the row of {NUMBERS[left]}", world) == [f"a{left - 2}", f"a{left - 1}"]


@pytest.mark.parametrize("count", [3, 4, 5, 6, 7])
def test_a_row_leaves_out_none_of_its_own(count: int) -> None:
    """Every other thing of a row is no row."""
    things = [Object(f"r{k}", "lamp", True, position=(2.0, 0.8 * k, 0.0)) for k in range(count)]
    things += [Object("off", "lamp", True, position=(2.0, 0.8 * (count + 1), 0.0))]
    found = [o for o in groups(things, 0.8, HERE) if "row" in o.attributes]
    for row in found:
        numbers = sorted(int(i[1:]) if i != "off" else count + 1 for i in row.members)
        assert numbers == [k for k in range(numbers[0], numbers[-1] + 1) if k != count], row.id
    assert any(len(row.members) >= count for row in found)
