"""Ends and sides of what has extents, and who is compared by name."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from asked import grounded

from dcg_torch.model.pretrain import pretrained
from dcg_torch.types import Percept, Pose

Three = tuple[float, float, float]
SEAT = (0.4, 0.4, 0.5)


def percept(id_: str, type_: str, x: float, y: float, size: Three, z: float | None = None) -> Percept:
    return Percept(id_, type_, None, (x, y, size[2] / 2.0 if z is None else z), size)


BENCH_ROOM = [  # a workbench along y, stools around it, a sink beyond one long side and a gate beyond one end
    percept("workbench", "workbench", 4.0, 2.0, (1.0, 3.0, 0.9)),
    *(percept(f"east{k}", "stool", 4.8, 1.2 + 0.8 * k, SEAT) for k in range(3)),
    *(percept(f"west{k}", "stool", 3.2, 1.2 + 0.8 * k, SEAT) for k in range(3)),
    percept("north", "stool", 4.0, 3.8, SEAT),
    percept("south", "stool", 4.0, 0.2, SEAT),
    percept("spare", "stool", 0.5, 4.5, SEAT),
    percept("sink", "sink", 7.5, 2.0, (0.5, 0.6, 0.9)),
    percept("gate", "gate", 4.2, 6.5, (1.2, 0.1, 2.0)),
    percept("locker", "locker", 0.3, 0.3, (0.5, 0.5, 1.8)),
]


def meant(text: str, things: list[Percept]) -> dict[str, float]:
    answer = grounded(text, things, None, looked=True)
    return {id_: p for id_, p in answer.probabilities.items() if not id_.startswith("hypothetical")}


def likeliest(text: str, things: list[Percept], count: int) -> set[str]:
    """The so many likeliest things, where the last of them is far likelier than the next."""
    found = sorted(meant(text, things).items(), key=lambda one: -one[1])
    (_, last), (_, after) = list(pairwise(found))[count - 1]
    assert last > 1.5 * after, found[: count + 2]
    return {id_ for id_, _ in found[:count]}


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("the stool at the end of the workbench", {"north", "south"}),
        ("the stool at the head of the workbench closest to the gate", {"north"}),
        ("the stool on the sink side of the workbench", {"east0", "east1", "east2"}),
        ("a stool on the side of the workbench closest to the sink", {"east0", "east1", "east2"}),
        ("the stool on the side of the workbench near the gate", {"north"}),
        ("the stool on the other side of the workbench from the sink", {"west0", "west1", "west2"}),
        ("the stool on the sink side of the workbench, nearest the gate", {"east2"}),
        ("the stool on the gate side", {"north"}),
    ],
)
def test_ends_and_sides_of_a_long_thing(text: str, ids: set[str]) -> None:
    assert likeliest(text, BENCH_ROOM, len(ids)) == ids


def test_all_on_a_side_are_meant() -> None:
    answer = grounded("the stools on the sink side of the workbench", BENCH_ROOM, None, looked=True)
    assert {thing.id for thing in answer.objects} == {"east0", "east1", "east2"}


def test_what_is_as_long_as_wide_has_no_ends() -> None:
    square = [percept("workbench", "workbench", 4.0, 2.0, (1.6, 1.6, 0.9)), *BENCH_ROOM[1:]]
    found = meant("the stool at the end of the workbench", square)
    assert found["north"] < 2.0 * found["east1"]


def test_what_goes_by_another_name_is_not_compared() -> None:
    """A crate may be called a box, but not where there are boxes."""
    yard = [Percept("b1", "box", None, (2.0, 1.0, 0.0)), Percept("b2", "box", None, (2.5, -1.0, 0.0))]
    crates = [Percept("c1", "crate", None, (2.2, 2.0, 0.0)), Percept("c2", "crate", None, (2.4, -2.0, 0.0))]
    model, robot = pretrained(), Pose(0.0, 0.0, 0.0)

    def found(text: str, things: list[Percept]) -> list[str | None]:
        return [o.id for o in model.ground(text, model.world_model(things, robot=robot, looked=True)).objects]

    assert found("the left box", yard + crates) == ["b1"]
    assert found("the rightmost box", yard + crates) == ["b2"]
    assert found("the left crate", yard + crates) == ["c1"]
    assert found("the left box", crates) == ["c1"]


def test_kinds_that_are_named_by_their_head_are_compared() -> None:
    """An office chair is a chair, whatever else is called just that."""
    chairs = [Percept("a", "chair", None, (2.0, 0.0, 0.0)), Percept("b", "office chair", None, (2.0, 1.5, 0.0))]
    model = pretrained()
    world = model.world_model([*chairs, Percept("c", "chair", None, (2.0, -1.0, 0.0))], robot=Pose(0.0, 0.0, 0.0))
    assert model.ground("the chair", world).probabilities["b"] < 0.2
    kitchen = [Percept("k", "kitchen cabinet", None, (2.0, 1.0, 0.0)), Percept("s", "sink", None, (2.0, 0.0, 0.0))]
    answer = model.ground("the cabinet", model.world_model(kitchen, robot=Pose(0.0, 0.0, 0.0), looked=True))
    assert [o.id for o in answer.objects] == ["k"]
    assert answer.probability is not None
    assert answer.probability > 0.5


GARAGE = [  # four carts: one with a radio, one with two helmets, one bare, one with a helmet, and a bucket beside it
    *(percept(f"cart{k}", "cart", 2.0 * k, 0.0, (0.9, 0.6, 0.8)) for k in range(4)),
    percept("radio", "radio", 0.1, 0.1, (0.3, 0.2, 0.2), 0.9),
    percept("helmet0", "helmet", 1.8, 0.0, (0.25, 0.25, 0.2), 0.9),
    percept("helmet1", "helmet", 2.25, 0.0, (0.25, 0.25, 0.2), 0.9),
    percept("helmet2", "helmet", 6.0, 0.1, (0.25, 0.25, 0.2), 0.9),
    percept("bucket", "bucket", 6.0, 0.6, (0.3, 0.3, 0.3)),
    percept("rag", "rag", 4.1, 1.6, (0.3, 0.3, 0.05)),
    *(percept(f"can{k}", "oil can", 2.0 * k + 0.1, -0.5, (0.15, 0.15, 0.3)) for k in range(4)),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the cart with the radio", "cart0"),
        ("the cart with two helmets", "cart1"),
        ("the cart with a bucket", "cart3"),
        ("the cart with the helmet and the bucket", "cart3"),
        ("the oil can by the cart with two helmets", "can1"),
        ("the oil can next to the cart that has a radio", "can0"),
        ("the helmet on the cart with the bucket", "helmet2"),
    ],
)
def test_what_a_thing_has_on_it_or_at_it(text: str, id_: str) -> None:
    assert likeliest(text, GARAGE, 1) == {id_}


def test_what_has_none_of_it() -> None:
    found = meant("the cart without a helmet", GARAGE)
    assert min(found["cart0"], found["cart2"]) > 5.0 * max(found["cart1"], found["cart3"])


STUDY = [  # walls at x 0 and 6, y 0 and 5; a bureau at the wall y = 0, a cabinet at x = 6, a rug table in the room
    percept("bureau", "bureau", 3.0, 0.35, (1.4, 0.7, 0.75)),
    percept("stool0", "stool", 3.0, 1.1, SEAT),
    percept("stool1", "stool", 4.2, 0.3, SEAT),
    percept("stool2", "stool", 1.8, 0.3, SEAT),
    percept("case", "display case", 5.7, 3.2, (0.6, 1.4, 1.2)),
    percept("basket0", "basket", 5.7, 4.4, (0.4, 0.4, 0.5)),
    percept("basket1", "basket", 5.7, 2.0, (0.4, 0.4, 0.5)),
    percept("basket2", "basket", 4.9, 3.2, (0.4, 0.4, 0.5)),
    percept("heater", "heater", 0.2, 4.8, (0.4, 0.4, 0.6)),
    percept("harp", "harp", 0.3, 1.0, (0.5, 0.5, 1.6)),
    percept("globe", "globe", 3.0, 4.8, (0.3, 0.3, 0.4)),
    percept("table", "table", 2.4, 2.8, (1.2, 0.8, 0.7)),
    percept("jar", "jar", 2.4, 2.5, (0.1, 0.1, 0.2), 0.8),
    percept("lantern", "lantern", 2.2, 2.9, (0.15, 0.15, 0.3), 0.85),
    percept("bench0", "bench", 2.4, 2.1, (0.9, 0.3, 0.4)),
    percept("bench1", "bench", 2.4, 3.5, (0.9, 0.3, 0.4)),
]


@pytest.mark.parametrize("quarters", range(4))
@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the stool in front of the bureau", "stool0"),
        ("the stool to the left of the bureau", "stool1"),
        ("the stool to the right of the bureau", "stool2"),
        ("the basket left of the display case", "basket0"),
        ("the basket right of the display case", "basket1"),
        ("the basket in front of the display case", "basket2"),
        ("the bench in front of the jar", "bench0"),
    ],
)
def test_where_nobody_stands_sides_are_told_with_ones_face_to_the_wall(text: str, id_: str, quarters: int) -> None:
    """However the axes of the room are laid."""
    x, y = ((1, 0), (0, 1), (-1, 0), (0, -1))[quarters], ((0, 1), (-1, 0), (0, -1), (1, 0))[quarters]
    turned = []
    for one in STUDY:
        assert one.position is not None
        assert one.size is not None
        at, (wide, deep, tall) = one.position, one.size
        size = (wide, deep, tall) if quarters % 2 == 0 else (deep, wide, tall)
        place = (at[0] * x[0] + at[1] * y[0], at[0] * x[1] + at[1] * y[1], at[2])
        turned.append(Percept(one.id, one.type, None, place, size))
    assert likeliest(text, turned, 1) == {id_}


def test_the_other_two_are_of_the_kind_of_what_is_meant() -> None:
    things = [percept(f"urn{k}", "urn", 1.5 * k, 0.1 * k, (0.4, 0.4, 0.6)) for k in range(3)]
    room = [*things, percept("clock", "clock", 1.5, 2.0, (0.3, 0.1, 0.3)), percept("post", "post", 5.0, 2.0, SEAT)]
    assert likeliest("the urn in between the other two", room, 1) == {"urn1"}
    assert likeliest("the urn between the two others", room, 1) == {"urn1"}


@pytest.mark.parametrize("seed", range(4))
def test_the_other_two_are_not_two_of_another_kind(seed: int) -> None:
    """The first urn stands between two posts, which nobody has named."""
    rng = np.random.default_rng(seed)
    urns = [percept(f"urn{k}", "urn", 1.0 + 1.5 * k, 0.0, (0.4, 0.4, 0.6)) for k in range(3)]
    posts = [percept(f"post{k}", "post", 1.0, y, (0.3, 0.3, 1.0)) for k, y in enumerate((-1.2, 1.2))]
    spots = zip(
        ("clock", "sink", "lamp", "bin", "desk", "rug"), rng.uniform((0.0, 1.5), (6.0, 4.0), (6, 2)), strict=True
    )
    others = [percept(type_, type_, float(x), float(y), (0.3, 0.3, 0.4)) for type_, (x, y) in spots]
    found = meant("the urn between the other two", [*urns, *posts, *others])
    assert max(found, key=found.__getitem__) == "urn1"


def test_what_is_nearly_as_near_as_the_nearest_is_as_near() -> None:
    """Two barrels stand at the gate, a hand's breadth apart in distance; what else is said picks one."""
    yard = [
        percept("gate", "gate", 0.0, 0.0, (0.1, 3.0, 2.0)),
        percept("barrel0", "barrel", 2.0, 1.5, (0.6, 0.6, 0.9)),
        percept("barrel1", "barrel", 2.1, -1.5, (0.6, 0.6, 0.9)),
        percept("barrel2", "barrel", 7.0, 1.0, (0.6, 0.6, 0.9)),
        percept("ladder", "ladder", 2.6, 2.6, (0.5, 0.2, 2.0)),
        percept("tub", "tub", 6.0, -2.0, (1.0, 0.6, 0.6)),
    ]
    found = meant("the barrel near the gate", yard)
    assert found["barrel1"] > 0.4 * found["barrel0"]
    assert found["barrel2"] < 0.1 * found["barrel0"]
    assert likeliest("the barrel that is close to the gate and not near the ladder", yard, 1) == {"barrel1"}


def test_a_pair_of_what_is_named_in_the_plural_is_one_thing() -> None:
    hall = [
        percept("boots0", "boots", 0.5, 0.5, (0.3, 0.3, 0.3)),
        percept("boots1", "boots", 3.0, 2.0, (0.3, 0.3, 0.3)),
        percept("stove", "stove", 3.2, 2.4, (0.6, 0.6, 0.9)),
        percept("coat", "coat", 0.2, 2.2, (0.3, 0.3, 1.0)),
    ]
    answer = grounded("the pair of boots next to the stove", hall, None, looked=True)
    assert [thing.id for thing in answer.objects] == ["boots1"]
    cushions = [percept(f"cushion{k}", "cushion", 1.0 + 0.4 * k, 1.0, (0.3, 0.3, 0.1)) for k in range(2)]
    answer = grounded("the pair of cushions", [*hall, *cushions], None, looked=True)
    assert {thing.id for thing in answer.objects} == {"cushion0", "cushion1"}


def test_what_is_on_a_thing_is_a_set_to_rank_in() -> None:
    yard = [*GARAGE, percept("gate", "gate", 8.5, 0.0, (0.1, 1.5, 2.0))]
    assert likeliest("the helmet closest to the gate", yard, 1) == {"helmet2"}
    assert likeliest("of the helmets on the cart with two helmets, the one closest to the gate", yard, 1) == {"helmet1"}


def test_what_nobody_says_how_large_it_is_stays_comparable() -> None:
    """One cup has no extents: how near it is to the counter's far side is not known, and no score becomes NaN."""
    cups = [percept(f"cup{k}", "cup", 2.0 + 0.8 * k, 0.0, (0.1, 0.1, 0.1)) for k in range(2)]
    lost = Percept("lost", "cup", None, (2.4, 0.5, 0.0))
    counter = percept("counter", "counter", 2.4, 0.0, (0.6, 2.0, 0.9))
    model = pretrained()
    world = model.world_model([*cups, lost, counter], robot=Pose(0.0, 0.0), looked=True)
    with np.errstate(invalid="raise"):
        answer = model.ground("take the cup on the far side of the counter", world)
    assert [o.id for o in answer.objects] == ["cup1"]
    assert np.isfinite(list(answer.probabilities.values())).all()
