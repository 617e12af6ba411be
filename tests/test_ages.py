"""Words for ages before the name of a kind say how large one is: "the baby elephant". Commands that we wrote."""

from __future__ import annotations

import pytest
from asked import grounded, meant
from making import percept

from dcg_torch.types import Percept


def elephant(name: str, y: float, tall: float | None) -> Percept:
    size = None if tall is None else (tall, 0.6 * tall, tall)
    return Percept(name, "elephant", None, (6.0, y, 0.0), size)


HERD = [elephant("a", 3.0, 2.9), elephant("b", 0.0, 1.0), elephant("c", -3.0, 2.7), percept("brown dog", (6.0, -5.0))]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the baby elephant", "b"),
        ("the young elephant", "b"),
        ("the mother elephant on the left", "a"),
        ("the adult elephant on the right", "c"),
        ("the grown elephants", "ac"),
    ],
)
def test_the_young_are_small(text: str, expected: str) -> None:
    assert meant(text, HERD, looked=True) == set(expected)


def test_without_sizes_it_is_any() -> None:
    same = [elephant(name, y, None) for name, y in (("a", 3.0), ("b", 0.0), ("c", -3.0))]
    found = grounded("the baby elephant", same, None, looked=True).probabilities
    assert max(found[name] for name in "abc") < 0.5


def test_what_is_called_so_is_no_size() -> None:
    things = [
        Percept("s1", "stroller", None, (2.0, 1.0, 0.0), (0.3, 0.3, 0.3)),
        Percept("s2", "baby stroller", None, (2.0, -1.0, 0.0), (0.9, 0.9, 0.9)),
    ]
    assert meant("the baby stroller", things, looked=True) == {"s2"}
