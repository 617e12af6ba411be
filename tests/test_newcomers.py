"""What people say in scanned rooms, on streets, of shapes, at home and over maps. Scenes and commands are ours."""

from __future__ import annotations

import functools
import math

import pytest

from dcg_torch.model import GroundingModel
from dcg_torch.model.pretrain import pretrained
from dcg_torch.names.evidence import evidence
from dcg_torch.names.weights import log_odds
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

HERE = Pose(0.0, 0.0)


@functools.cache
def _model() -> GroundingModel:
    return pretrained()


def meant(text: str, things: list[Percept], robot: Pose | None = HERE) -> list[str]:
    """The ids of what a command means in a scene that is seen as a whole."""
    world = _model().world_model(things, robot=robot, looked=True, workspace=Workspace.of(things))
    return sorted(o.id for o in _model().ground(text, world).objects)


def thing(
    id_: str, type_: str, x: float, y: float, color: str | None = None, z: float = 0.0, **keys: object
) -> Percept:
    """A thing in metres; `keys` are its attributes, but for `size`, `rgb`."""
    size, rgb = keys.pop("size", None), keys.pop("rgb", None)
    given = frozenset(f"{key}: {value}" for key, value in keys.items())
    return Percept(id_, type_, color, (x, y, z), size=size, rgb=rgb, attributes=given)  # type: ignore[arg-type]


FARMLAND = [
    thing("dam", "reservoir", 0.0, 0.0, size=(20.0, 20.0, 0.0)),
    *(
        thing(f"mast {name}", "mast", x, y)
        for name, x, y in [("n", 40.0, 3.0), ("se", -22.0, -24.0), ("e", 6.0, -16.0)]
    ),
    thing("silo n", "silo", 60.0, 30.0),
    thing("silo s", "silo", -60.0, -5.0),
    thing("truck w", "tractor", 2.0, 45.0),
    thing("truck sw", "tractor", -33.0, 30.0),
    thing("chapel", "chapel", 70.0, -40.0),
    thing("stone", "boulder", 80.0, 0.0),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("fly to the mast north of the reservoir", "mast n"),
        ("the mast to the southeast of the reservoir", "mast se"),
        ("hover over the mast east of the reservoir", "mast e"),
        ("the tractor south west of the reservoir", "truck sw"),
        ("the tractor just west of the reservoir", "truck w"),
        ("the silo farthest south", "silo s"),
        ("the northernmost building", "chapel"),
        ("the building farthest south", "silo s"),
    ],
)
def test_on_a_map_the_direction_is_what_is_told(text: str, id_: str) -> None:
    assert meant(text, FARMLAND, Pose(-90.0, 0.0)) == [id_]


KERB = [
    *(thing(f"bollard{k}", "bollard", 8.0 + 6.0 * k, 6.0 + 0.2 * k) for k in range(4)),
    thing("other", "bollard", 20.0, -9.0),
    thing("tram", "tram", 30.0, 0.0, "green", size=(20.0, 2.5, 3.5)),
    thing("van", "van", 14.0, -4.0, "orange", size=(5.0, 2.0, 2.2)),
    thing("lorry", "lorry", 22.0, -4.0, "orange", size=(8.0, 2.4, 3.2)),
    thing("waiter", "waiter", 12.0, 9.0, shirt="purple"),
    thing("walker", "pedestrian", 25.0, -8.0, shirt="grey"),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("stop by the second bollard on the left", "bollard1"),
        ("the last bollard on your left", "bollard3"),
        ("pull over to the right behind the orange van", "van"),
        ("merge left behind the green tram", "tram"),
        ("look out for the van", "van"),
        ("stop beside the guy in the purple shirt", "waiter"),
        ("wait for the woman in grey", "walker"),
        ("stop next to the lorry after the orange van", "lorry"),
    ],
)
def test_on_a_street(text: str, id_: str) -> None:
    assert meant(text, KERB) == [id_]


AVENUE = [
    thing("kiosk1", "kiosk", 14.0, -5.0),
    thing("kiosk2", "kiosk", 30.0, -5.5),
    thing("own lane", "scooter", 10.0, -0.2),
    thing("scooter1", "scooter", 18.0, -4.0),
    thing("scooter2", "scooter", 26.0, -4.2),
    thing("kiosk3", "kiosk", 22.0, 6.0),
    thing("arch", "arch", 50.0, 0.0),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("stop at the second kiosk on the right", "kiosk2"),
        ("the first kiosk on your right", "kiosk1"),
        ("park by the first scooter on the right", "scooter1"),
        ("the last scooter on the right", "scooter2"),
    ],
)
def test_what_is_in_the_own_lane_is_on_no_side_of_a_street(text: str, id_: str) -> None:
    assert meant(text, AVENUE) == [id_]


def test_one_line_across_is_no_street() -> None:
    across = [thing(f"bollard{k}", "bollard", 9.0, 9.0 - 3.0 * k) for k in range(3)]
    assert meant("the second bollard on the left", [*across, thing("post", "bollard", 9.0, -4.0)]) != ["post"]


def test_whoever_it_is_may_be_called_a_man_and_no_thing_is() -> None:
    assert min(log_odds("guy", name) for name in ("waiter", "policeman", "pedestrian", "construction worker")) > 0.0
    assert max(log_odds("guy", name) for name in ("bollard", "tram", "girl")) < 0.0
    assert evidence("waiter", "policeman")[1] != "kind: same"


SHAPES = [
    thing("big", "tile", 0.8, 0.3, "orange", shape="triangle", size=(0.25, 0.25, 0.02)),
    thing("small", "tile", 0.5, -0.3, "orange", shape="triangle", size=(0.1, 0.1, 0.02)),
    thing("oval", "tile", 0.3, 0.1, "white", shape="oval", size=(0.15, 0.15, 0.02)),
    thing("square", "tile", 0.2, -0.2, "black", shape="square", size=(0.15, 0.15, 0.02)),
]
ROUND = [
    thing("far", "circle", 0.9, 0.1, "pink"),
    thing("near", "circle", 0.2, 0.2, "pink"),
    thing("far box", "square", 0.8, -0.3, "grey"),
    thing("near box", "square", 0.1, -0.1, "grey"),
]


@pytest.mark.parametrize(
    ("text", "id_"), [("the large orange triangle", "big"), ("small triangle", "small"), ("the white oval", "oval")]
)
def test_a_noun_that_is_the_value_of_a_key_is_not_what_the_key_names(text: str, id_: str) -> None:
    assert meant(text, SHAPES) == [id_]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("circle at the bottom", "near"),
        ("circle all the way at the top", "far"),
        ("topmost square", "far box"),
        ("bottom square", "near box"),
    ],
)
def test_a_shape_that_is_a_verb_as_well(text: str, id_: str) -> None:
    assert meant(text, ROUND) == [id_]


PAINTED = [
    thing("dark", "brick", 0.8, 0.3, "green", rgb=(10, 80, 20), size=(0.1, 0.1, 0.1)),
    thing("pale", "brick", 0.5, 0.1, "green", rgb=(150, 235, 150), size=(0.1, 0.1, 0.1)),
    thing("can", "cylinder", 0.3, -0.3, "green", rgb=(20, 120, 30), size=(0.1, 0.1, 0.1)),
    *(
        thing(f"sun{k}", "brick", 0.2, 0.3 - 0.5 * k, "yellow", rgb=(240, 230, 30), size=(0.1, 0.1, 0.1))
        for k in (0, 1)
    ),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the green brick no the lighter one", "pale"),
        ("the green brick wait no, the lighter brick", "pale"),
        ("the green one, not the brick but the cylinder", "can"),
        ("slide the light green brick between the two yellow ones", "pale"),
    ],
)
def test_what_is_taken_back_keeps_its_colour(text: str, id_: str) -> None:
    assert meant(text, PAINTED) == [id_]


SALOON = [
    thing("door", "door", 0.05, 1.0, z=1.0, size=(0.1, 0.9, 2.0)),
    thing("near left", "stool", 1.5, 2.6, z=0.4, size=(0.4, 0.4, 0.8)),
    thing("near right", "stool", 2.0, 0.3, z=0.4, size=(0.4, 0.4, 0.8)),
    thing("stage", "piano", 6.9, 2.5, z=0.6, size=(0.6, 1.5, 1.2)),
    thing("bar n", "table", 4.0, 4.2, z=0.4, size=(1.2, 0.8, 0.8)),
    thing("bar s", "table", 4.0, 0.8, z=0.4, size=(1.2, 0.8, 0.8)),
    *(thing(f"lamp{k}", "lamp", 1.0 + 2.5 * k, 4.9, z=2.0, size=(0.3, 0.2, 0.3)) for k in range(3)),
    thing("rug", "rug", 3.5, 2.5, z=0.01, size=(2.0, 1.5, 0.02)),
    thing("clock", "clock", 3.5, 0.03, z=2.2, size=(0.4, 0.05, 0.4)),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("if you stand at the door looking in, the stool on your left", "near left"),
        ("when you walk in through the door, the stool to your right", "near right"),
        ("coming in through the door, the table on the left", "bar n"),
        ("when you enter through the door the stool is on your right", "near right"),
        ("facing the piano, the table on the right", "bar s"),
        ("facing the piano, this is the table on your left", "bar n"),
        ("standing at the door facing the piano, the table on the right", "bar s"),
    ],
)
def test_in_a_room_the_sides_are_of_who_is_told_to_stand_there(text: str, id_: str) -> None:
    assert meant(text, SALOON, None) == [id_]


ALCOVE = [
    thing("settee", "couch", 3.0, 0.5, z=0.4, size=(2.2, 0.9, 0.8)),
    thing("east cushion", "cushion", 3.7, 0.45, z=0.7, size=(0.4, 0.3, 0.3)),
    thing("west cushion", "cushion", 2.3, 0.45, z=0.7, size=(0.4, 0.3, 0.3)),
    thing("west cabinet", "cabinet", 2.0, 4.75, z=0.5, size=(0.8, 0.5, 1.0)),
    thing("middle cabinet", "cabinet", 3.2, 4.75, z=0.5, size=(0.8, 0.5, 1.0)),
    thing("east cabinet", "cabinet", 4.4, 4.75, z=0.5, size=(0.8, 0.5, 1.0)),
    thing("vase", "vase", 4.4, 4.75, z=1.15, size=(0.2, 0.2, 0.3)),
    thing("south drape", "curtain", 0.05, 1.5, z=1.2, size=(0.1, 0.3, 2.2)),
    thing("north drape", "curtain", 0.05, 3.5, z=1.2, size=(0.1, 0.3, 2.2)),
    thing("rug", "rug", 3.0, 2.5, z=0.01, size=(2.0, 1.5, 0.02)),
    thing("hook", "coat rack", 5.95, 2.5, z=1.5, size=(0.1, 0.8, 0.3)),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("the left cushion on the sofa", "east cushion"),
        ("the cushion on the right", "west cushion"),
        ("the leftmost cabinet", "west cabinet"),
        ("the second cabinet from the left", "middle cabinet"),
        ("the vase on the right cabinet", "vase"),
        ("the curtain on the left", "south drape"),
    ],
)
def test_where_nobody_stands_the_sides_are_of_who_stands_before_the_things(text: str, id_: str) -> None:
    assert meant(text, ALCOVE, None) == [id_]


def test_who_is_known_to_look_keeps_the_own_sides() -> None:
    from_the_north = Pose(3.0, 6.0, -math.pi / 2.0)
    assert meant("the leftmost cabinet", ALCOVE, from_the_north) == ["east cabinet"]


HOUSE = [
    *(thing(name, name, x, y, size=(4.0, 4.0, 2.6)) for name, x, y in [("kitchen", 2.0, 2.0), ("bedroom", 2.0, 6.0)]),
    thing("scarf", "scarf", 1.0, 6.5),
    thing("ladle", "ladle", 1.5, 2.5),
    thing("guest", "person", 2.5, 6.5, gender="female"),
    thing("tray", "tray", 3.0, 1.5),
    *(thing(f"crate{k}", "crate", 8.0, 6.0 - 2.0 * k) for k in range(5)),
    thing("hedge", "hedge", 9.0, 2.0, size=(0.5, 10.0, 1.0)),
    thing("barrow", "wheelbarrow", 12.0, 2.0),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("look for the woman in the bedroom and follow her", "guest"),
        ("give him the tray", "tray"),
        ("bring her the scarf", "scarf"),
        ("polish up the ladle", "ladle"),
        ("the row of crates by the hedge, third one", "crate2"),
        ("the row of crates along the hedge: the middle one", "crate2"),
    ],
)
def test_at_home(text: str, id_: str) -> None:
    assert meant(text, HOUSE, Pose(4.0, 4.0, math.pi)) == [id_]


def test_what_is_told_of_a_thing_by_and_has() -> None:
    things = [
        thing("plain", "kettle", 1.0, 0.5, "white"),
        thing("meant", "kettle", 1.0, -0.5, "white"),
        thing("ladle", "ladle", 1.1, -0.6, "black"),
        thing("pot", "pot", 1.4, 0.0, "black"),
    ]
    text = "the kettle is on the counter. it is white and has a ladle next to it"
    assert meant(text, things) == ["meant"]


def test_what_is_closest_is_one_of_all_that_the_name_of_a_kind_names() -> None:
    things = [
        thing("lemon", "lemon", 1.0, 0.9),
        thing("plum", "plum", 1.0, 0.3),
        thing("far plum", "plum", 1.0, -0.8),
        thing("jug", "jug", 1.0, 0.0),
        thing("fork", "fork", 1.0, 0.1),
    ]
    assert meant("the fruit closest to the jug", things) == ["plum"]
    assert meant("the fruit farthest from the jug", things) == ["lemon"]


def test_a_roll_of_it_is_it() -> None:
    assert log_odds("toilet paper roll", "toilet paper") > 0.0 > log_odds("toilet paper roll", "towel")
