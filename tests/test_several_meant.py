"""Several that are meant: all on a side, all between two, those at the ends, of two colours; what is asked for.

Scenes and commands are ours.
"""

from __future__ import annotations

import pytest
from asked import meant, standing

from dcg_torch.language import default_parser

YARD = (  # id, class, colour, x, y
    ("u0", "urn", "red", 2.0, 2.9),
    ("u1", "urn", "brown", 2.2, 1.6),
    ("u2", "urn", "brown", 1.9, 0.4),
    ("u3", "urn", "green", 2.1, -2.8),
    ("bench", "bench", "white", 2.0, -0.9),
    ("pump", "pump", "white", 2.1, 2.2),
)


def _meant(text: str) -> set[str]:
    return meant(text, standing(*YARD), looked=True)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("all the urns left of the bench", {"u0", "u1", "u2"}),
        ("the urns that are right of the pump", {"u1", "u2", "u3"}),
        ("everything left of the bench", {"u0", "u1", "u2", "pump"}),
        ("the urns between the bench and the pump", {"u1", "u2"}),
        ("every urn that is between the pump and the bench", {"u1", "u2"}),
    ],
)
def test_all_that_stand_so_are_meant_and_not_the_nearest_alone(text: str, meant: set[str]) -> None:
    assert _meant(text) == meant


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the urns at both ends", {"u0", "u3"}),
        ("the two outer urns", {"u0", "u3"}),
        ("take the urns at either end", {"u0", "u3"}),
        ("the outermost brown urns", {"u1", "u2"}),
        ("all the urns but the ones at the ends", {"u1", "u2"}),
        ("the inner urns", {"u1", "u2"}),
    ],
)
def test_the_ends_are_two(text: str, meant: set[str]) -> None:
    assert _meant(text) == meant


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the red or purple urn", {"u0"}),
        ("the purple or green urn", {"u3"}),
        ("every red or brown urn", {"u0", "u1", "u2"}),
        ("all the green and brown urns", {"u1", "u2", "u3"}),
        ("the urn that is neither brown nor green", {"u0"}),
        ("neither the brown nor the red urn", {"u3"}),
        ("an urn, not brown, not red", {"u3"}),
        ("take the pump. take the two brown urns too.", {"pump", "u1", "u2"}),
    ],
)
def test_one_colour_or_another(text: str, meant: set[str]) -> None:
    assert _meant(text) == meant


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("which urn is closest to the bench?", {"u2"}),
        ("which one of the urns is nearest the bench?", {"u2"}),
        ("what is the leftmost urn?", {"u0"}),
        ("which urn is second from the right?", {"u2"}),
        ("which is the green urn?", {"u3"}),
        ("show me which urn is the rightmost", {"u3"}),
        ("is it an urn? yes. is it red? no. is it brown? no. is it on the right? yes.", {"u3"}),
        ("is it white? yes. is it the bench? no.", {"pump"}),
    ],
)
def test_what_is_asked_for_is_meant(text: str, meant: set[str]) -> None:
    assert _meant(text) == meant


@pytest.mark.parametrize("text", ["what is the time?", "which way is north?", "tell me what is the largest urn"])
def test_a_question_for_words_stays_one(text: str) -> None:
    assert default_parser().parse(text).refused
