"""Things that are found out by questions with yes and no: the games are ours, with the shipped model."""

from __future__ import annotations

import pytest
from asked import meant

from dcg_torch import Percept
from dcg_torch.interpretation.guesses import told_by_answers
from dcg_torch.interpretation.turns import in_one_voice

PARK = [
    Percept("left child", "child", None, (2.0, 1.0, 0.5), (0.0, 0.3, 0.9)),
    Percept("middle child", "child", None, (2.0, 0.1, 0.5), (0.0, 0.3, 0.9)),
    Percept("right child", "child", None, (2.0, -0.9, 0.5), (0.0, 0.3, 0.9)),
    Percept("red kite", "kite", "red", (2.0, 0.6, 1.5), (0.0, 0.3, 0.3)),
    Percept("blue kite", "kite", "blue", (2.0, -0.7, 1.5), (0.0, 0.3, 0.3)),
    Percept("dog", "dog", "black", (2.0, -1.3, 0.2), (0.0, 0.4, 0.3)),
    Percept("bench", "bench", "brown", (2.0, 1.5, 0.3), (0.0, 0.8, 0.5)),
]


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("Is it a child? No. Is it an animal? Yes.", {"dog"}),
        ("is it a kite? yes. the red one? no.", {"blue kite"}),
        ("kite? yes. blue? yes", {"blue kite"}),
        ("Is it a kite? Yes. Is it the red kite? No.", {"blue kite"}),
        ("is it a child? yes. left? no. right? no.", {"middle child"}),
        ("Is it a child? Yes. Is it the child on the left? No. Is it left of the blue kite? Yes.", {"middle child"}),
        ("Q: is it a child? A: yes Q: the one on the right? A: yes", {"right child"}),
        ("Can you sit on it? Yes.", {"bench"}),
    ],
)
def test_answers_tell_what_it_is(text: str, ids: set[str]) -> None:
    assert meant(text, PARK, looked=True) == ids


FOUR = [
    Percept("reds", "person", "red", (2.2, 3.3, 0.0)),
    Percept("greens", "person", "green", (5.1, 1.5, 0.0)),
    Percept("blues", "person", "blue", (3.7, -2.2, 0.0)),
    Percept("car", "car", "red", (6.0, -2.7, 0.0)),
]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("is it a person? yes. is he wearing red? no. on the left? yes", "greens"),
        ("Is it a person? Yes. Is she in blue? No. Is she in red? No.", "greens"),
        ("the leftmost person that is not red", "greens"),
        ("the person that is neither red nor green", "blues"),
        ("the person who is wearing red", "reds"),
    ],
)
def test_a_denied_colour_rules_out_what_has_it_and_nobody_else(text: str, id_: str) -> None:
    """In a dictionary a red is a person; no colour is one where things have colours."""
    assert meant(text, FOUR, looked=True) == {id_}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("is he wearing red? no. is she dressed in blue? yes", "It is not red. It is blue."),
        ("Is he wearing a hat? No. Is it big? n/a", "It has no hat."),
        ("is he holding a leash? yes. is she carrying a bag? no", "It has a leash. It has no bag."),
        (
            "sitting? no. eating? yes. painting? no. ring? yes",
            "It is not sitting. It is eating. It is not a painting. It is a ring.",
        ),
        ("does it have wheels? yes, it does. car?\nno", "It has wheels. It is not a car."),
        ("Is it on the left half? I don't know. Is it bigger than the dog? y", "It is bigger than the dog."),
    ],
)
def test_each_answer_is_a_sentence(text: str, told: str) -> None:
    assert told_by_answers(text) == told


@pytest.mark.parametrize(
    "text",
    [
        "Take the kite. The red one? No, the blue one.",
        "can you bring me the kite? yes please",
        "is the dog there? yes",
        " ? yes",
        "the kite? yes. ? no",
        "the red one? no, the blue one",
    ],
)
def test_what_is_no_such_game_stays_as_it_is(text: str) -> None:
    assert told_by_answers(text) == text


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("It is a kite. It is not the red kite.", {"blue kite"}),
        ("It is a child. It is not the left child. It is not the right child.", {"middle child"}),
    ],
)
def test_what_is_not_meant_is_one_thing_and_not_all_of_its_kind(text: str, ids: set[str]) -> None:
    assert meant(text, PARK, looked=True) == ids


def test_what_is_on_it_is_on_the_one_that_is_told() -> None:
    text = "Go to the white bench. Which one? The one with the hat on it."
    assert in_one_voice(text) == "Go to the white bench. The one with the hat on it."
