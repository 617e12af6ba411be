"""Descriptions of three sentences are about what the first names: "This is a desk. There is a lamp on it. It ..."."""

from __future__ import annotations

import pytest

from dcg_torch import parse


@pytest.mark.parametrize(
    ("text", "noun", "relations"),
    [
        ("This is a grey stool. There is a cup on it. It is left of the oven.", "stool", ["with", "left of"]),
        ("The shelf is tall. A vase stands on it. It is near the oven.", "shelf", ["with", "near"]),
        ("It is a low bench. There is a bag on it. It is right of the sofa.", "bench", ["with", "right of"]),
        ("There is a white table. It has a radio on it. It is behind the sofa.", "table", ["with", "behind"]),
        ("The bench is grey. There is a bag and a hat on it.", "bench", ["with"]),
        ("The bench is grey. On top of it are two bags and a hat. It is near the oven.", "bench", ["with", "near"]),
        ("This is a crate. There is a jar on top. It is next to the oven.", "crate", ["with", "next to"]),
    ],
)
def test_it_is_what_was_told_of_first(text: str, noun: str, relations: list[str]) -> None:
    told = parse(text).readings[0].tree.children[0]
    assert told.phrase.noun == noun
    assert [child.phrase.words[0] for child in told.children] == relations


@pytest.mark.parametrize(
    ("text", "noun"),
    [
        ("Go to the bench. On it there is a jar. Bring it.", "jar"),
        ("The pan is dirty. It is on the table. Wash it.", "pan"),
    ],
)
def test_an_order_is_about_what_was_told_of_last(text: str, noun: str) -> None:
    assert parse(text).readings[0].tree.children[0].phrase.noun == noun
