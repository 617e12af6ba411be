"""What is left out of a tree is so of every equal tree, whatever is kept of the one that was met before."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from dcg_torch.grounding.exceptions import split_exceptions
from dcg_torch.grounding.solution import target_of, with_target
from dcg_torch.language import parse_command
from dcg_torch.types import ParseTree, Phrase, PhraseKind

TEXTS = ("all cups but the white one", "take everything except the mug", "neither the biggest nor the smallest jar")


def read(text: str) -> ParseTree:
    tree = parse_command(text).tree
    assert tree is not None
    return tree


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("forgotten", [split_exceptions.cache_clear, target_of.cache_clear])
def test_an_equal_tree_is_split_alike(text: str, forgotten: Callable[[], None]) -> None:
    first = read(text)
    split = split_exceptions(first)
    forgotten()
    again = read(text)
    assert again == first
    assert again is not first
    assert split_exceptions(again) == split
    assert split[1]
    assert all(not split_exceptions(out)[1] for out in split[1])


@pytest.mark.parametrize("text", ["go to the cup left of the cup", "take the cup and the cup", "the cup"])
def test_the_first_noun_phrase_alone_is_replaced(text: str) -> None:
    tree, other = read(text), ParseTree(Phrase(PhraseKind.NOUN, "the jar", noun="jar"))
    target_of(read(text))
    found = with_target(tree, other)
    assert target_of(found) is other
    below = [node.phrase.noun for node in found.walk() if node.phrase.noun is not None]
    assert below == ["jar", *(["cup"] if text.startswith("take") else [])]
