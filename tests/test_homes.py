"""Commands that we wrote in a flat of which nobody says what its rooms are, and in a room; with the shipped model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from dcg_torch import GroundingModel, Percept, Pose
from dcg_torch.scene.rooms import in_room
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Object

Thing = tuple[str, str, tuple[float, float, float], tuple[float, float, float]]
FLAT = [  # a bedroom, a bathroom and a kitchen side by side
    ("bed", "bed", (1.5, 1.0, 0.3), (2.0, 1.6, 0.6)),
    ("stand", "nightstand", (0.2, 1.0, 0.3), (0.4, 0.4, 0.5)),
    ("wardrobe", "wardrobe", (1.0, 3.5, 1.0), (1.2, 0.6, 2.0)),
    ("lamp in bedroom", "floor lamp", (0.3, 2.4, 0.8), (0.3, 0.3, 1.6)),
    ("bin in bedroom", "trash can", (2.6, 2.6, 0.2), (0.3, 0.3, 0.4)),
    ("toilet", "toilet", (7.5, 0.8, 0.4), (0.6, 0.4, 0.7)),
    ("bathtub", "bathtub", (7.0, 3.0, 0.3), (1.7, 0.7, 0.6)),
    ("bin in bathroom", "trash can", (8.2, 1.8, 0.2), (0.3, 0.3, 0.4)),
    ("towel in bathroom", "towel", (8.4, 3.2, 1.2), (0.1, 0.4, 0.7)),
    ("stove", "stove", (13.0, 0.8, 0.45), (0.6, 0.6, 0.9)),
    ("fridge", "refrigerator", (13.0, 3.0, 0.9), (0.7, 0.7, 1.8)),
    ("bin in kitchen", "trash can", (12.2, 2.0, 0.2), (0.3, 0.3, 0.4)),
    ("towel in kitchen", "towel", (13.4, 1.6, 1.1), (0.1, 0.4, 0.6)),
    ("lamp in kitchen", "floor lamp", (12.0, 3.4, 0.8), (0.3, 0.3, 1.6)),
]
ROOM = [
    ("left desk", "desk", (0.5, 5.6, 0.4), (1.4, 0.7, 0.75)),
    ("middle desk", "desk", (3.0, 3.0, 0.4), (1.4, 0.7, 0.75)),
    ("near bin", "trash can", (0.2, 0.2, 0.2), (0.3, 0.3, 0.4)),
    ("far bin", "trash can", (5.8, 3.0, 0.2), (0.3, 0.3, 0.4)),
    ("high shelf", "shelf", (5.9, 5.0, 2.2), (0.3, 0.9, 0.2)),
    ("low shelf", "shelf", (5.9, 5.0, 1.4), (0.3, 0.9, 0.2)),
    ("window", "window", (3.0, 0.0, 1.5), (1.2, 0.1, 1.3)),
    ("one chair", "chair", (3.0, 2.3, 0.4), (0.5, 0.5, 0.9)),
    ("other chair", "chair", (3.0, 3.7, 0.4), (0.5, 0.5, 0.9)),
    ("third chair", "chair", (5.5, 0.5, 0.4), (0.5, 0.5, 0.9)),
    ("east plant", "plant", (5.0, 2.6, 0.4), (0.4, 0.4, 0.8)),
    ("west plant", "plant", (1.0, 2.4, 0.4), (0.4, 0.4, 0.8)),
    ("mirror", "mirror", (0.0, 4.0, 1.5), (0.1, 0.5, 0.9)),
    ("sink", "sink", (0.3, 4.0, 0.45), (0.5, 0.6, 0.9)),
    ("other mirror", "mirror", (6.0, 1.5, 1.5), (0.1, 0.5, 0.9)),
    ("door", "door", (3.0, 6.1, 1.0), (0.9, 0.1, 2.0)),
]


def meant(
    model: GroundingModel, text: str, things: Sequence[Thing], robot: Pose, rooms: dict[str, str] | None = None
) -> list[str]:
    told = {id_: frozenset({f"room: {(rooms or {})[id_]}"} if id_ in (rooms or {}) else ()) for id_, *_ in things}
    percepts = [Percept(id_, type_, None, at, size, attributes=told[id_]) for id_, type_, at, size in things]
    return sorted(
        o.id for o in model.ground(text, model.world_model(percepts, robot, workspace=Workspace(), looked=True)).objects
    )


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("empty the bin in the bathroom", "bin in bathroom"),
        ("the kitchen bin", "bin in kitchen"),
        ("the lamp in the room where I sleep", "lamp in bedroom"),
        ("go to the kitchen and turn on the lamp", "lamp in kitchen"),
        ("go into the bathroom and bring me the towel", "towel in bathroom"),
        ("there is a trash can in the bedroom, take it", "bin in bedroom"),
        ("the towel that is not in the bathroom", "towel in kitchen"),
        ("in the bedroom there is a lamp. switch it on", "lamp in bedroom"),
        ("the bin in the room with the bathtub", "bin in bathroom"),
        ("entering the kitchen, the towel", "towel in kitchen"),
        ("kitchen. towel.", "towel in kitchen"),
    ],
)
def test_rooms_follow_from_what_stands_in_them(model: GroundingModel, text: str, id_: str) -> None:
    assert meant(model, text, FLAT, Pose(5.0, -1.0)) == [id_]


def test_rooms_that_are_given_count(model: GroundingModel) -> None:
    rooms = {"bin in bedroom": "kids room", "bin in bathroom": "home office", "bin in kitchen": "hallway"}
    for said, id_ in (("the kids' room", "bin in bedroom"), ("the office", "bin in bathroom"), ("the corridor", "")):
        found = meant(model, f"take the trash can from {said}", FLAT, Pose(5.0, -1.0), rooms)
        assert found == [id_ or "bin in kitchen"]


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("the trash can that is not in a corner", ["far bin"]),
        ("the bin in the corner of the room", ["near bin"]),
        ("the corner desk", ["left desk"]),
        ("the upper shelf", ["high shelf"]),
        ("the bottom shelf", ["low shelf"]),
        ("all the chairs around the desk in the middle of the room", ["one chair", "other chair"]),
        ("with your back to the window, the plant on the left", ["west plant"]),
        ("the plant on the right, with my back to the window", ["east plant"]),
        ("the mirror above the sink. there are other mirrors", ["mirror"]),
    ],
)
def test_parts_of_a_room(model: GroundingModel, text: str, ids: list[str]) -> None:
    assert meant(model, text, ROOM, Pose(3.0, 6.0, -1.5708)) == sorted(ids)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("go to the bedroom and bring me the lamp", "bedroom"),
        ("go to the kitchen and bring me the lamp", "kitchen"),
        ("take the lamp in the kitchen, no, the bedroom", "bedroom"),
    ],
)
@pytest.mark.parametrize("given", [False, True])
def test_a_room_that_is_given_is_a_place_as_one_that_is_guessed(
    model: GroundingModel, text: str, meant: str, *, given: bool
) -> None:
    """The value of a key `room` is no name of the things that stand there."""
    flat = [("bed", "bedroom", 4.0), ("lamp", "bedroom", 3.2), ("stove", "kitchen", -4.0), ("lamp", "kitchen", -3.2)]
    things = [
        Percept(f"{type_} {room}", type_, None, (1.0, y, 0.0), None, frozenset({f"room: {room}"} if given else ()))
        for type_, room, y in flat
    ]
    world = model.world_model(things, Pose(0.0, 0.0), looked=True)
    assert [o.id for o in model.ground(text, world).objects] == [f"lamp {meant}"]


def test_rooms_among_many_things_are_those_among_few(monkeypatch: pytest.MonkeyPatch) -> None:
    """Distances are worked out a part at a time; where the parts end changes nothing."""
    rng = np.random.default_rng(0)
    kinds = ("bed", "stove", "toilet", "lamp", "chair")
    things = [
        Object(f"o{k}", kinds[k % 5], True, position=(float(rng.uniform(0, 9)), float(rng.uniform(0, 9)), 0.0))
        for k in range(57)
    ]
    whole = in_room(things, "kitchen")
    monkeypatch.setattr("dcg_torch.scene.rooms._AT_ONCE", 100)
    assert in_room(things, "kitchen") == pytest.approx(whole, abs=1e-12)
    assert len(whole) == len(things)
