"""What people wear, as values in a list under one key: "guy in red far left", "the girl in the green shirt"."""

from __future__ import annotations

import pytest
from seen_whole import meant

from dcg_torch import Percept
from dcg_torch.names.keys import attributes_of, is_used


def test_texts_in_a_list_are_each_a_value_of_the_key() -> None:
    given = {"wears": ["red shirt", "jeans"], "tags": [], "box": [1.0, 2.0], "mixed": ["a", 1]}
    assert attributes_of(given) == {"wears: red shirt", "wears: jeans"}
    assert [is_used(key, value) for key, value in given.items()] == [True, True, False, False]


def person(id_: str, type_: str, left: float, *worn: str) -> Percept:
    """One of a row, so many metres to the left of the middle of a picture."""
    return Percept(
        id_, type_, None, (2.0, left, 1.0), size=(0.1, 0.4, 1.0), attributes=attributes_of({"wears": [*worn]})
    )


_STREET = [
    person("far red", "man", 1.5, "red shirt", "jeans"),
    person("blue", "woman", 0.6, "blue coat"),
    person("near red", "man", -0.4, "red jacket"),
    person("black", "man", -1.2, "black suit", "tie"),
    person("green", "girl", -1.8, "green shirt"),
]


def test_the_colour_of_a_thing_is_not_what_somebody_wears() -> None:
    car = Percept("car", "car", "red", (2.0, 0.1, 2.0), size=(0.1, 0.6, 0.3))
    other = Percept("other", "car", "white", (2.0, 1.1, 2.0), size=(0.1, 0.6, 0.3))
    assert meant("the red car", [*_STREET, car, other]) == ["car"]
    assert meant("the guy in the red jacket", [*_STREET, car, other]) == ["near red"]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("man in red on the far left", "far red"),
        ("man in red far right", "near red"),
        ("the guy in the black suit", "black"),
        ("the guy wearing the red jacket", "near red"),
        ("the woman in the blue coat", "blue"),
        ("the girl in green", "green"),
        ("man in jeans", "far red"),
    ],
)
def test_who_wears_it_is_meant(text: str, id_: str) -> None:
    assert meant(text, _STREET) == [id_]
