"""What something holds is part of its name, and what wares come in is said for wares."""

from __future__ import annotations

import pytest
from asked import grounded, standing

from dcg_torch.interpretation.loads import by_loads
from dcg_torch.interpretation.parser_protocol import Words
from dcg_torch.language import parse_command
from dcg_torch.names.weights import log_odds
from dcg_torch.scene.upsilon import world_model
from dcg_torch.types import ParseTree, Percept, PhraseKind

YARD = standing(
    ("tires", "truck tire pallet", None, 4.0, 1.0),
    ("parts", "spare parts pallet", None, 4.0, -1.0),
    ("truck", "truck", None, 6.0, 0.0),
)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("lift the pallet with the tires", "tires"),
        ("lift the pallet of tires", "tires"),
        ("lift the pallet holding tires", "tires"),
        ("lift the pallet with tires on it", "tires"),
        ("lift the pallet with the boxes", "parts"),
        ("lift the pallet of boxes", "parts"),
        ("lift the skid of boxes", "parts"),
        ("lift the package pallet", "parts"),
        ("pick up the boxes", "parts"),
    ],
)
def test_a_pallet_is_called_by_its_load(text: str, meant: str) -> None:
    solution = grounded(text, YARD, looked=True)
    assert [o.id for o in solution.objects] == [meant]
    assert solution.probabilities[meant] > 0.5


@pytest.mark.parametrize(
    ("noun", "name", "other"),
    [
        ("box pallet", "spare parts pallet", "tire pallet"),
        ("goods pallet", "carton pallet", "tire pallet"),
        ("carton crate", "office supplies crate", "wine crate"),
    ],
)
def test_what_wares_come_in_is_said_for_them(noun: str, name: str, other: str) -> None:
    assert log_odds(noun, name) > log_odds(noun, other) + 2.0


@pytest.mark.parametrize("noun", ["box", "carton"])
def test_a_box_is_no_thing_that_has_parts(noun: str) -> None:
    assert log_odds(noun, "car parts") < 0.0  # no package by its name


def nouns(text: str, *names: str) -> list[str | None]:
    world = world_model([Percept(name, name, None, (1.0, float(k), 0.0)) for k, name in enumerate(names)], frozenset())
    tree: ParseTree = parse_command(text).readings[0].tree
    found = by_loads(tree, Words.of(tree), world)
    return [node.phrase.noun for node in found.walk() if node.phrase.kind is PhraseKind.NOUN]


def test_what_is_held_stays_a_thing_where_it_is_one() -> None:
    assert nouns("take the crate with the apples", "apple crate", "crate") == ["apple crate"]
    assert nouns("take the crate with the apples", "apple crate", "crate", "apple") == ["crate", "apple"]


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("take the crate with the red apples", ["crate", "apple"]),  # the class says nothing of red
        ("take the crate with the pears", ["crate", "pear"]),
        ("take the table with the apples", ["table", "apple"]),  # no package
    ],
)
def test_other_loads_stay_as_they_are_said(text: str, kept: list[str]) -> None:
    assert nouns(text, "apple crate", "crate", "apple table") == kept
