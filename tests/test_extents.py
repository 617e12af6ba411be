"""Things that say how large they are: what is on a bed, beside it, under a table."""

from __future__ import annotations

import numpy as np
import pytest
from asked import grounded

from dcg_torch.lessons.furniture import furnished_scene
from dcg_torch.lessons.sized_things import THING
from dcg_torch.lessons.table_tops import table_top_scene
from dcg_torch.scene.frames import seen_facing
from dcg_torch.scene.layout_making import layout
from dcg_torch.scene.relation_names import RELATION_NAMES
from dcg_torch.scene.relations import Relations
from dcg_torch.types import Object, Percept, Pose, WorldModel

Three = tuple[float, float, float]
BED, TABLE = (2.0, 1.6, 0.5), (1.4, 0.9, 0.75)
CUP = (0.1, 0.1, 0.1)


def thing(id_: str, position: Three, size: Three | None) -> Object:
    return Object(id_, id_, known=True, position=position, size=size)


def told(mark: Object, other: Object, yaw: float = 0.0) -> set[str]:
    """What is told of the second to the first, in a world whose neighbours are 0.7 m apart."""
    where = layout(WorldModel((mark, other), robot=Pose(-3.0, 0.0, yaw), unit=0.7))
    found = Relations(where).to([(0,)], "all")[:, 0, 1]
    return {RELATION_NAMES[k].removeprefix("relation: ") for k in found.tolist() if k >= 0}


@pytest.mark.parametrize("feet", [False, True])
def test_what_lies_at_the_end_of_a_bed_is_on_it(feet: bool) -> None:
    down = 1.0 if feet else 0.0  # a position is a thing's middle, or its foot
    bed = thing("bed", (1.0, 0.0, 0.25 - 0.25 * down), BED)
    pillow = thing("pillow", (1.8, 0.6, 0.57 - 0.07 * down), (0.4, 0.4, 0.14))
    assert "vertical, on top" in told(bed, pillow)
    assert "distance, to 0.6" in told(bed, pillow)


def test_a_turned_robot_sees_the_same() -> None:
    bed, pillow = thing("bed", (1.0, 0.0, 0.25), BED), thing("pillow", (1.8, 0.0, 0.57), (0.4, 0.4, 0.14))
    assert "vertical, on top" in told(bed, pillow, np.pi / 2)
    beyond = thing("pillow", (1.0, 1.3, 0.07), (0.4, 0.4, 0.14))
    assert "vertical, level" in told(bed, beyond, np.pi / 2)


def test_small_things_side_by_side_are_no_stack() -> None:
    one, other = thing("one", (1.0, 0.0, 0.05), CUP), thing("other", (1.0, 0.15, 0.08), (0.1, 0.1, 0.16))
    assert "vertical, level" in told(one, other)
    assert "vertical, on top" in told(thing("one", (1.0, 0.0, 0.05), None), thing("other", (1.0, 0.15, 0.08), None))


def test_what_stands_below_a_table_is_under_it() -> None:
    table, bin_ = thing("table", (1.0, 0.0, 0.375), TABLE), thing("bin", (1.3, 0.2, 0.15), (0.3, 0.3, 0.3))
    assert "vertical, right under" in told(table, bin_)
    assert "vertical, on top" in told(bin_, table)


def test_where_no_size_is_known_nothing_changes() -> None:
    world = WorldModel((thing("bed", (1.0, 0.0, 0.25), None),), robot=Pose(0.0, 0.0))
    assert layout(world).bodies is None


def test_who_faces_a_thing_sees_with_other_eyes() -> None:
    bed, lamp = thing("bed", (-3.0, 0.0, 0.0), None), thing("lamp", (-3.0, 2.0, 0.0), None)
    world = WorldModel((bed, lamp, thing("door", (3.0, 0.0, 0.0), None)), robot=Pose(0.0, 0.1, 0.0), unit=0.7)
    seen = seen_facing(world, bed)
    assert seen is not None
    assert layout(world).position[1, 1] > 0.0  # the lamp is on the robot's left
    assert layout(seen).position[1, 1] < 0.0  # and on the right of who has turned to the bed


@pytest.mark.parametrize("maker", [furnished_scene, table_top_scene])
def test_lessons_mean_what_is_there(maker: object) -> None:
    assert callable(maker)
    rng = np.random.default_rng(0)
    scenes = [maker(rng) for _ in range(40)]
    assert sum(bool(scene.commands) for scene in scenes) > 20
    for scene in scenes:
        kinds = {o.id: o.type for o in scene.objects}
        for text, meant in scene.commands:
            assert meant
            assert all(kinds[i] in text or {*text.split()} & {*THING} for i in meant)


@pytest.mark.parametrize("text", ["the nightstand with the lamp on it", "the nightstand with a lamp on top of it"])
def test_what_has_a_thing_on_it_is_under_it(text: str) -> None:
    stands = [Percept(f"n{k}", "nightstand", None, (3.0, 1.5 - 3.0 * k, 0.3), (0.4, 0.4, 0.6)) for k in range(2)]
    lamps = [
        Percept("l0", "lamp", None, (3.0, -1.5, 0.8), (0.2, 0.2, 0.4)),
        Percept("l1", "lamp", None, (2.4, 1.5, 0.2), (0.2, 0.2, 0.4)),
    ]
    answer = grounded(text, [*stands, *lamps], looked=True)
    assert answer.object is not None
    assert answer.object.id == "n1"
