"""Questions to the robot about things that are told by others, and rooms that have numbers. We wrote the commands."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from asked import grounded

from dcg_torch import Percept
from dcg_torch.dialogue.session import Session
from dcg_torch.dialogue.text import spoken
from dcg_torch.storage.resources import resource
from dcg_torch.world.files import load_world


@pytest.fixture(scope="module")
def session() -> Iterator[Session]:
    """Of a world with cubes and spheres, a fire hydrant, a mailbox and a traffic cone."""
    session = Session(load_world(resource("worlds") / "world_04.yaml"), simulator="fake")
    yield session
    session.close()


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        ("is there a cube of the same colour as the barrel?", "no barrel here"),
        ("is there a sphere next to the drill?", "no drill here"),
        ("where is the sphere behind the lamp?", "no lamp here"),
        ("how many cubes are left of the barrel?", "no barrel here"),
        ("what is left of the mug?", "no mug here"),
        ("is there a cube of the same colour as the traffic cone?", "Yes: the red cube"),
        ("how many spheres are there?", "3 spheres"),
        ("which sphere is nearest?", "The sphere is 2.8 m away"),
    ],
)
def test_what_a_thing_is_told_by_must_be_there_as_well(session: Session, question: str, answer: str) -> None:
    assert answer in " ".join(spoken(session.say(question)))


def thing(id_: str, type_: str, x: float, y: float, *attributes: str) -> Percept:
    return Percept(id_, type_, None, (x, y, 0.0), (0.1, 0.1, 0.1), frozenset(attributes))


NUMBERED = [
    thing("mug in kitchen 1", "mug", 1.0, 1.0, "room: kitchen 1"),
    thing("mug in kitchen 2", "mug", 6.0, 1.0, "room: kitchen 2"),
    thing("mug in bedroom 1", "mug", 1.0, 6.0, "room: bedroom 1"),
    thing("bed in bedroom 1", "bed", 2.0, 6.0, "room: bedroom 1"),
    thing("bed in bedroom 2", "bed", 6.0, 6.0, "room: bedroom 2"),
    thing("lamp in bedroom 2", "lamp", 6.0, 7.0, "room: bedroom 2"),
]
TIDY = [  # where things are, and where they ought to be
    thing("mug in kitchen", "mug", 1.0, 1.0, "room: kitchen", "belongs in: bedroom"),
    thing("mug in bedroom", "mug", 6.0, 1.0, "room: bedroom", "belongs in: kitchen"),
    thing("plate in bedroom", "plate", 6.0, 2.0, "room: bedroom", "belongs in: kitchen"),
]


@pytest.mark.parametrize(
    ("text", "things", "id_"),
    [
        ("the mug in kitchen 2", NUMBERED, "mug in kitchen 2"),
        ("bring me the mug in the kitchen number 1", NUMBERED, "mug in kitchen 1"),
        ("go to bedroom 2 and take the lamp", NUMBERED, "lamp in bedroom 2"),
        ("the bed in bedroom 1", NUMBERED, "bed in bedroom 1"),
        ("the mug in the kitchen", TIDY, "mug in kitchen"),
        ("take the mug from the bedroom", TIDY, "mug in bedroom"),
    ],
)
def test_rooms_have_numbers_and_are_where_things_are(text: str, things: list[Percept], id_: str) -> None:
    answer = grounded(text, things)
    assert [o.id for o in answer.objects] == [id_]
