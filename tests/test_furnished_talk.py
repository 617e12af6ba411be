"""What people say in rooms, on table-tops and in several turns: commands that we wrote."""

from __future__ import annotations

import asked
import pytest

from dcg_torch.language import default_parser
from dcg_torch.names.weights import log_odds
from dcg_torch.scene.layout_making import layout
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Object, Percept, Pose, WorldModel


def meant(text: str, percepts: tuple[Percept, ...], at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> set[str]:
    """The ids of what a text means among things of a room."""
    return asked.meant(text, percepts, Pose(*at), looked=True, workspace=Workspace(None, 0.5))


def thing(
    id_: str, type_: str, at: tuple[float, float, float], size: tuple[float, float, float], color: str | None = None
) -> Percept:
    return Percept(id_, type_, color, at, size)


STUDY = (
    thing("desk", "desk", (3.0, 1.5, 0.37), (1.4, 0.7, 0.74)),
    thing("other desk", "desk", (3.0, -1.6, 0.37), (1.4, 0.7, 0.74)),
    thing("sofa", "sofa", (1.0, 2.6, 0.4), (1.8, 0.9, 0.8)),
    thing("on desk", "lamp", (3.4, 1.6, 0.95), (0.2, 0.2, 0.42)),
    thing("on floor", "lamp", (0.2, -2.5, 0.8), (0.35, 0.35, 1.6)),
    thing("below", "bin", (3.1, 1.5, 0.2), (0.3, 0.3, 0.4)),
    thing("at wall", "bin", (0.3, -0.9, 0.2), (0.3, 0.3, 0.4)),
    thing("tall", "plant", (0.3, 0.9, 0.8), (0.4, 0.4, 1.6)),
    thing("short", "plant", (4.4, -0.1, 0.25), (0.3, 0.3, 0.5)),
    thing("stool", "stool", (1.5, -1.2, 0.25), (0.35, 0.35, 0.5)),
)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("the desk lamp", "on desk"),
        ("the bin under the desk", "below"),
        ("there is a tall plant and a short one, the short one", "short"),
        ("there's a tall plant and a short plant. bring me the tall one", "tall"),
        ("something to sit on that is not a stool", "sofa"),
        ("the lamp that isn't on any desk", "on floor"),
        ("the bin that is not under a desk", "at wall"),
    ],
)
def test_what_people_say_in_a_study(text: str, wanted: str) -> None:
    assert meant(text, STUDY) == {wanted}


def test_a_desk_does_not_rest_on_the_bin_below_it() -> None:
    def body(id_: str, z: float, size: tuple[float, float, float]) -> Object:
        return Object(id_, id_, True, position=(2.0, 0.0, z), size=size)

    under = WorldModel((body("desk", 0.37, (1.4, 0.7, 0.74)), body("bin", 0.2, (0.3, 0.3, 0.4))), unit=0.5)
    stacked = WorldModel((body("can", 0.45, (0.2, 0.2, 0.1)), body("box", 0.2, (0.3, 0.3, 0.4))), unit=0.5)
    lit = WorldModel((body("lamp", 0.84, (0.2, 0.2, 0.2)), body("desk", 0.37, (1.4, 0.7, 0.74))), unit=0.5)
    assert not layout(under).near.covered.any()
    assert not layout(lit).near.covered.any()  # a lamp is in nobody's way
    assert layout(stacked).near.covered.tolist() == [False, True]


BEDROOM = (
    thing("bed", "bed", (0.0, 3.5, 0.27), (1.6, 2.0, 0.55)),
    thing("left", "pillow", (-0.4, 4.2, 0.62), (0.5, 0.35, 0.15)),
    thing("right", "pillow", (0.4, 4.2, 0.62), (0.5, 0.35, 0.15)),
    thing("elsewhere", "pillow", (2.5, 0.5, 0.5), (0.4, 0.4, 0.15)),
    thing("armchair", "armchair", (2.5, 0.5, 0.4), (0.8, 0.8, 0.8)),
    thing("stand", "nightstand", (-1.1, 4.2, 0.3), (0.45, 0.45, 0.6)),
    thing("lamp", "lamp", (-1.1, 4.2, 0.8), (0.25, 0.25, 0.4)),
    thing("far lamp", "lamp", (-2.6, -0.6, 0.8), (0.3, 0.3, 1.6)),
    thing("rug", "rug", (0.0, 1.2, 0.01), (1.6, 1.0, 0.02)),
)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("facing the bed, the pillow on the right", "right"),
        ("when you face the bed, the pillow on the left", "left"),
        ("the bedside lamp", "lamp"),
    ],
)
def test_who_faces_a_bed_means_what_is_by_it(text: str, wanted: str) -> None:
    assert meant(text, BEDROOM, (-2.0, -1.0, 0.0)) == {wanted}


HOME = (
    thing("stove", "stove", (4.0, 2.5, 0.45), (0.6, 0.6, 0.9)),
    thing("table", "kitchen table", (2.8, 2.0, 0.37), (1.2, 0.8, 0.74)),
    thing("cup", "mug", (2.8, 2.1, 0.8), (0.09, 0.09, 0.1)),
    thing("fridge", "fridge", (4.0, 1.4, 0.9), (0.7, 0.7, 1.8)),
    thing("bed", "bed", (3.0, -3.5, 0.27), (1.6, 2.0, 0.55)),
    thing("stand", "nightstand", (4.2, -4.2, 0.3), (0.45, 0.45, 0.6)),
    thing("other cup", "mug", (4.2, -4.2, 0.65), (0.09, 0.09, 0.1)),
)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("the kitchen mug", {"cup"}),
        ("where i sleep there is a mug, get it", {"other cup"}),
        ("all the mugs in the house", {"cup", "other cup"}),
    ],
)
def test_rooms_that_are_named_before_a_thing_or_by_what_is_done_there(text: str, wanted: set[str]) -> None:
    assert meant(text, HOME) == wanted


BOWLS = (
    thing("table", "table", (1.0, 0.0, 0.37), (0.9, 1.6, 0.74)),
    thing("bowl", "bowl", (0.9, 0.3, 0.78), (0.2, 0.2, 0.08)),
    thing("inside", "apple", (0.92, 0.3, 0.79), (0.07, 0.07, 0.07)),
    thing("outside", "apple", (1.1, -0.4, 0.78), (0.07, 0.07, 0.07)),
    thing("spoon", "spoon", (0.7, -0.1, 0.75), (0.03, 0.17, 0.02)),
)


@pytest.mark.parametrize(
    ("text", "wanted"), [("the thing in the bowl", "inside"), ("the apple outside the bowl", "outside")]
)
def test_what_holds_a_bowl_is_not_in_it(text: str, wanted: str) -> None:
    assert meant(text, BOWLS) == {wanted}


SMALL = (0.08, 0.08, 0.08)
TABLE = (
    thing("can", "soda can", (0.8, 0.4, 0.8), (0.07, 0.07, 0.12), "red"),
    thing("apple", "apple", (0.9, 0.0, 0.78), SMALL, "green"),
    thing("pear", "pear", (1.1, 0.3, 0.78), SMALL, "green"),
    thing("fork", "fork", (0.7, -0.2, 0.75), (0.18, 0.03, 0.02)),
    thing("spoon", "spoon", (1.1, -0.3, 0.75), (0.18, 0.03, 0.02)),
    thing("book", "book", (0.8, -0.5, 0.76), (0.2, 0.15, 0.03), "blue"),
    thing("car", "toy car", (1.2, 0.0, 0.77), (0.12, 0.06, 0.05), "blue"),
    thing("marker", "marker", (0.6, 0.2, 0.75), (0.13, 0.02, 0.02), "black"),
)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("bring me a coke", {"can"}),
        ("the drink", {"can"}),
        ("all the fruit", {"apple", "pear"}),
        ("the silverware", {"fork", "spoon"}),
        ("something to play with", {"car"}),
        ("i want to read something", {"book"}),
        ("something to stir my coffee with", {"spoon"}),
        ("do you have a pen? i need one", {"marker"}),
        ("a hammer, if you see one", set()),
        ("the screwdriver", set()),
    ],
)
def test_things_by_their_kinds_and_purposes(text: str, wanted: set[str]) -> None:
    assert meant(text, TABLE) == wanted


def test_a_kind_is_said_of_its_things_and_not_the_other_way_round() -> None:
    assert log_odds("vehicle", "toy_car") > 0.0
    assert log_odds("toy car", "vehicle") < log_odds("vehicle", "toy car")
    assert log_odds("apple", "pear") < 2.0 < log_odds("fruit", "pear")


LINE = tuple(
    thing(kind, kind, (1.0, 0.4 - 0.2 * k, 0.0), (0.08, 0.08, 0.04))
    for k, kind in enumerate(("moon", "heart", "star", "cross", "bell"))
)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("look for the star, then go one to the left, that is it", "heart"),
        ("see the star? one to the right of it", "cross"),
        ("start at the star and go two to the left", "moon"),
        ("the right neighbor of the heart", "star"),
        ("the one two to the left of the cross", "heart"),
    ],
)
def test_steps_from_a_thing(text: str, wanted: str) -> None:
    assert meant(text, LINE) == {wanted}


MUGS = (
    thing("by kettle", "mug", (1.0, 0.7, 0.8), (0.1, 0.1, 0.1), "red"),
    thing("by toaster", "mug", (1.1, -0.4, 0.8), (0.1, 0.1, 0.1), "blue"),
    thing("kettle", "kettle", (1.0, 0.5, 0.85), (0.18, 0.18, 0.25)),
    thing("toaster", "toaster", (1.1, -0.65, 0.85), (0.2, 0.3, 0.2)),
    thing("plate", "plate", (0.6, 0.1, 0.76), (0.24, 0.24, 0.02), "white"),
)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("there is a mug by the toaster, i need it", "by toaster"),
        ("not the red mug. the other one", "by toaster"),
        ("the toaster has a mug beside it, take that", "by toaster"),
        ("find the kettle. next to it there is a mug. that's the one i want", "by kettle"),
        ("there's a toaster and next to it a mug. that mug please", "by toaster"),
        ("A: got the mugs? B: yes. A: take the blue one", "by toaster"),
        ("A: take the plate. B: ok. A: no, the kettle", "kettle"),
        ("A: i need the mug. B: there are two of them. A: the left one.", "by kettle"),
        ("of those two mugs i'd take the left one", "by kettle"),
        ("first i wanted the plate, but now the kettle", "kettle"),
        ("is the toaster there? good. get me the mug next to it", "by toaster"),
    ],
)
def test_what_is_said_in_several_turns(text: str, wanted: str) -> None:
    assert meant(text, MUGS) == {wanted}


def test_that_is_all_orders_nothing() -> None:
    assert default_parser().parse("ok, that's all for today").refused is not None


def test_of_several_orders_the_last_goal_is_where_a_thing_is() -> None:
    parsed = default_parser().parse("enter the hall, go to the desk and pick up the cup")
    weight = {(r.tree.phrase.words or ("",))[0]: r.log_weight for r in parsed.readings}
    assert weight["pick up"] > weight.get("go", -9.0)


def test_but_those_somewhere_are_those_that_are_not_there() -> None:
    tree = default_parser().parse("all the mugs except the one in the kitchen").tree
    assert tree is not None
    assert [node.phrase.words for node in tree.walk() if node.phrase.noun is None][1:] == [("not in",)]
