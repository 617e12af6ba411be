"""Short descriptions of what is in a photograph, where things have a place in it and stand on no common floor."""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch.names.weights import log_odds
from dcg_torch.types import Percept


def box(id_: str, type_: str, left: float, low: float, wide: float, high: float) -> Percept:
    """Of metres from the middle of a picture's lower edge, two metres before who looks."""
    at = (2.0, left, low + high / 2.0)
    return Percept(id_, type_, None, at, (0.05, wide, high))


HARBOUR = [
    box("low canoe", "canoe", 1.4, 0.1, 0.5, 0.4),
    box("middle canoe", "canoe", 0.1, 0.5, 0.4, 0.3),
    box("high canoe", "canoe", -0.9, 1.1, 0.2, 0.15),
    box("crate1", "lobster crate", -0.2, 0.1, 0.3, 0.2),
    box("crate2", "lobster crate", -0.6, 0.1, 0.3, 0.2),
    box("crate3", "lobster crate", -0.4, 0.35, 0.3, 0.2),
    box("gull", "gull", 0.9, 1.5, 0.1, 0.1),
]
SINK = [
    Percept(
        f"vat{k}",
        "vat",
        None,
        (1.0, 0.4 - 0.4 * k, 0.9),
        (0.2, 0.2, 0.3),
        attributes=frozenset({f"fullness: {fullness}"}),
    )
    for k, fullness in enumerate(("full", "empty", "full"))
]


@pytest.mark.parametrize(
    ("text", "things", "id_"),
    [
        ("canoe closest to camera", HARBOUR, "low canoe"),
        ("nearest canoe", HARBOUR, "low canoe"),
        ("canoe farthest from the camera", HARBOUR, "high canoe"),
        ("crate on top of the other two", HARBOUR, "crate3"),
        ("vat with nothing in it", SINK, "vat1"),
        ("the vat without anything in it", SINK, "vat1"),
    ],
)
def test_what_is_meant(text: str, things: list[Percept], id_: str) -> None:
    answer = grounded(text, things, looked=True)
    assert [o.id for o in answer.objects] == [id_]


def test_a_package_is_of_the_kind_of_what_it_holds() -> None:
    assert log_odds("soda", "Pepsi bottle") > 1.0
    assert log_odds("soda", "ink bottle") < 0.0


@pytest.mark.parametrize(("noun", "name"), [("cake wedge", "cake"), ("melon slice", "melon"), ("sunshade", "umbrella")])
def test_a_portion_of_a_thing_is_called_by_it(noun: str, name: str) -> None:
    assert log_odds(noun, name) > 3.0
    assert log_odds(noun, "lamp") < 0.0
