"""Extents: words for width, length and thickness are measured; boxes of a picture have sizes; who faces has a left."""

from __future__ import annotations

import math

import pytest
from asked import meant, shipped

from dcg_torch.evaluation.episodes import Episode
from dcg_torch.interpretation.dimensions import dimensions, measure
from dcg_torch.scene.frames import seen_facing
from dcg_torch.scene.workspace import Workspace, with_places
from dcg_torch.types import Object, Percept, WorldModel

SHELF = (  # id, class, x, y, extents
    ("slab", "crate", 1.5, 1.2, (0.9, 0.9, 0.1)),
    ("post", "crate", 2.5, 0.1, (0.2, 0.3, 0.9)),
    ("trunk", "crate", 2.0, -1.3, (0.4, 1.6, 0.5)),
    ("thermos", "thermos", 3.0, 0.9, (0.3, 0.3, 0.3)),
)


def _meant(text: str) -> set[str]:
    percepts = [Percept(id_, kind, None, (x, y, size[2] / 2.0), size=size) for id_, kind, x, y, size in SHELF]
    return meant(text, percepts, looked=True)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("take the widest crate", {"slab"}),
        ("the narrowest crate", {"post"}),
        ("the crate that is the narrowest", {"post"}),
        ("of the crates, the longest one", {"trunk"}),
        ("the long crate", {"trunk"}),
        ("the flat crate", {"slab"}),
        ("the thickest of the crates", {"trunk"}),
        ("the second widest crate", {"trunk"}),
        ("the two widest crates", {"slab", "trunk"}),
        ("the crate that is narrower than the thermos", {"post"}),
        ("the crate narrower than the other ones", {"post"}),
        ("the crate taller than the rest", {"post"}),
    ],
)
def test_words_for_extents_are_measured(text: str, meant: set[str]) -> None:
    assert _meant(text) == meant


def test_of_what_has_no_extents_nothing_is_measured() -> None:
    assert all(measure(Object("a", "crate", known=True), word) is None for word in dimensions())


def _picture(text: str, sizes: dict[str, list[float]]) -> Episode:
    """Three horses in a picture, from the left to the right, at one height."""
    things = [
        {"id": id_, "type": "horse", "color": None, "position": [2.0, 0.6 - 0.6 * k, 0.5], "size": size}
        for k, (id_, size) in enumerate(sizes.items())
    ]
    return Episode.model_validate(
        {"id": "1", "text": text, "robot": {"x": 0, "y": 0, "yaw": 0}, "objects": things, "target": []}
    )


@pytest.mark.parametrize(("text", "meant"), [("biggest horse", "b"), ("the tiny horse", "c"), ("tallest horse", "b")])
def test_boxes_without_depth_have_a_size(text: str, meant: str) -> None:
    episode = _picture(text, {"a": [0.0, 0.3, 0.2], "b": [0.0, 0.4, 0.5], "c": [0.0, 0.1, 0.1]})
    world = shipped().world_model(episode.percepts(), episode.pose, looked=True, workspace=Workspace())
    assert [o.id for o in shipped().ground(text, world).objects] == [meant]


def test_one_extent_of_zero_is_unknown_where_others_are_known() -> None:
    episode = _picture("horse", {"a": [0.2, 0.3, 0.2], "b": [0.0, 0.4, 0.5], "c": [0.0, 0.0, 0.0]})
    assert [p.size for p in episode.percepts()] == [(0.2, 0.3, 0.2), None, None]


@pytest.mark.parametrize("aslant", [0.4, 1.1, 2.2, -0.7])
def test_the_edge_on_the_left_of_who_faces_a_thing_is_on_the_left(aslant: float) -> None:
    """Whatever the walls of the room: of a ring of things, the left edge lies a quarter turn from where one looks."""
    ring = [(math.cos(aslant + k * math.pi / 6), math.sin(aslant + k * math.pi / 6)) for k in range(12)]
    things = tuple(
        Object(f"r{k}", "urn", known=True, position=(3.0 * x, 3.0 * y, 0.0)) for k, (x, y) in enumerate(ring)
    )
    seen = seen_facing(with_places(WorldModel(things), Workspace()), things[0])
    assert seen is not None
    edges = [place for place in seen.places if place.type == "edge" and "left side" in place.attributes]
    assert len(edges) == 1
    assert edges[0].position is not None
    x, y, _ = edges[0].position
    assert math.atan2(y, x) == pytest.approx(math.remainder(aslant + math.pi / 2, math.tau), abs=1e-6)


@pytest.mark.parametrize(
    "text",
    [
        "facing the rug, the urn on the left",
        "stand facing the rug; take the urn to the left",
        "with the rug in front of you, the urn on the left",
        "with the rug behind you, the urn on the right",
    ],
)
def test_whose_left_it_is_where_one_faces_a_thing(text: str) -> None:
    things = [("rug", "rug", 3.0, 3.0), ("left", "urn", -1.2, 1.0), ("right", "urn", 1.4, -1.0)]
    things += [("mop", "mop", -3.0, -2.9), ("tub", "tub", 2.4, 2.6), ("jar", "jar", -2.6, -3.0)]
    percepts = [Percept(id_, kind, None, (x, y, 0.0)) for id_, kind, x, y in things]
    world = shipped().world_model(percepts, looked=True, workspace=Workspace())
    assert [o.id for o in shipped().ground(text, world).objects] == ["left"]
