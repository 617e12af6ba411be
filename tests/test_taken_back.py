"""Corrections that say which thing is not meant, or how much farther another is: "no, a bit further left"."""

from __future__ import annotations

import pytest

from dcg_torch import ParseTree, parse


def _told(tree: ParseTree) -> list[tuple[str, str | None]]:
    """What is meant, and the relations of all below it with their nouns."""
    found = [("", tree.phrase.noun)]
    for place in tree.children:
        denied = "not " * ("not" in place.phrase.words[1:] or place.phrase.words[0].startswith("not "))
        found += [(f"{denied}{place.phrase.words[0].removeprefix('not ')}", place.children[0].phrase.noun)]
    return found


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("open the drawer, no not the one by the stove, the other one", [("", "drawer"), ("not by", "stove")]),
        ("take the crate. no, not the crate under the bench. the other.", [("", "crate"), ("not under", "bench")]),
        ("the jar, wait, not the one on the tray, the one on the floor", [("", "jar"), ("on", "floor")]),
        ("take the jar, not the one near the sink but the one near the oven", [("", "jar"), ("near", "oven")]),
        (
            "not the jar by the oven and not the jar on the left, the other one",
            [("", "jar"), ("not by", "oven"), ("not on", "left")],
        ),
        ("take the middle jug. no, a bit further to the right", [("", "jug"), ("right of", "jug")]),
        ("the crate by the sink. no wait, slightly more left, the tall one", [("", "crate"), ("left of", "crate")]),
    ],
)
def test_what_is_left_after_a_correction(text: str, told: list[tuple[str, str | None]]) -> None:
    tree = parse(text).readings[0].tree
    noun = next(node for node in tree.walk() if node.phrase.noun is not None and node.phrase.kind.name == "NOUN")
    assert _told(noun) == told


def test_farther_to_the_side_that_was_said_is_that_side() -> None:
    tree = parse("take the jug on the left. no, a bit further left").readings[0].tree
    assert [place.phrase.words[0] for place in tree.children[0].children] == ["on"]
