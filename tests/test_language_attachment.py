"""What "or", "before", a relative clause and a verb of bringing do to what stands around them."""

from __future__ import annotations

import math

import pytest

from dcg_torch.language import Reading, parse_command, target_phrase
from dcg_torch.types import ParseTree


def below(tree: ParseTree) -> list[tuple[str, list[str | None]]]:
    """The prepositions directly below the object meant, each with the nouns of its landmarks."""
    places = target_phrase(tree).children
    return [(place.phrase.words[0], [noun.phrase.noun for noun in place.children]) for place in places]


def first(text: str) -> ParseTree:
    tree = parse_command(text).tree
    assert tree is not None
    return tree


def likely(text: str, least: float) -> list[Reading]:
    """The readings of at least a probability."""
    return [reading for reading in parse_command(text).readings if math.exp(reading.log_weight) >= least]


@pytest.mark.parametrize("verb", ["bring", "deliver", "carry"])
@pytest.mark.parametrize("named", ["the plate on the shelf", "both plates on the shelf"])
def test_what_is_brought_is_rather_described(verb: str, named: str) -> None:
    assert below(first(f"{verb} {named}")) == [("on", ["shelf"])]
    assert any(not below(reading.tree) for reading in likely(f"{verb} {named}", 0.2))


@pytest.mark.parametrize(
    "text", ["put the plate on the shelf", "place the plate on the shelf", "bring it to the shelf"]
)
def test_what_is_put_has_a_destination(text: str) -> None:
    assert below(first(text)) == []


def test_what_is_taken_and_brought_elsewhere_keeps_its_destination() -> None:
    tree = first("take the jar and bring it next to the sink")
    assert below(tree) == []
    assert [child.phrase.words[0] for child in tree.children[1:]] == ["next to"]


@pytest.mark.parametrize(
    ("text", "relation", "nouns"),
    [
        ("the vase that is not on the shelf or the chair", "not on", ["shelf", "chair"]),
        ("take the vase that isn't near the lamp or the sink", "not near", ["lamp", "sink"]),
        ("the vase not in the box or the basket", "not in", ["box", "basket"]),
        ("the vase that is not on the floor, the shelf or the chair", "not on", ["floor", "shelf", "chair"]),
    ],
)
def test_or_denies_both_landmarks(text: str, relation: str, nouns: list[str]) -> None:
    assert below(first(text)) == [(relation, [noun]) for noun in nouns]
    assert all(node.phrase.words in {(), (relation,)} for node in target_phrase(first(text)).walk())


@pytest.mark.parametrize(
    ("text", "nouns"),
    [
        ("the vase on the table or the cabinet", ["table", "cabinet"]),
        ("take every plate on the table or the chair", ["table", "chair"]),
        ("the vase on the chair or the shelf", ["chair", "shelf"]),
    ],
)
def test_or_offers_landmarks(text: str, nouns: list[str]) -> None:
    assert below(first(text)) == [("on", nouns)]


def test_what_is_akin_to_the_object_is_no_landmark() -> None:
    tree = first("take the cup on the table or the glass")
    assert below(tree) == [("on", ["table"])]
    assert [child.phrase.noun for child in tree.children] == ["cup", "glass"]


@pytest.mark.parametrize("text", ["every spoon or knife", "take all spoons or knives", "bring each spoon and knife"])
def test_a_word_for_all_is_said_once(text: str) -> None:
    nouns = [child.phrase for child in first(text).children]
    assert [noun.noun for noun in nouns] == ["spoon", "knife"]
    assert nouns[0].words == nouns[1].words
    assert all(noun.plural and "or" not in noun.words for noun in nouns)


def test_or_without_a_word_for_all_is_a_choice() -> None:
    assert first("take a spoon or a knife").children[1].phrase.words == ("or",)


@pytest.mark.parametrize(
    "text",
    [
        "the thing that is not a spoon, fork or knife",
        "take the object that is not a spoon, a fork or a knife",
        "the one that is not a spoon or fork or knife",
        "take the thing that is neither a spoon nor a fork nor a knife",
    ],
)
def test_a_list_of_what_it_is_not(text: str) -> None:
    assert below(first(text)) == [("except", [noun]) for noun in ("spoon", "fork", "knife")]


@pytest.mark.parametrize(
    "text",
    [
        "before you go to the sink, take the jar",
        "take the jar before you walk to the sink",
        "before washing the plate, take the jar",
    ],
)
def test_what_comes_later_tells_not_where_the_object_is(text: str) -> None:
    tree = first(text)
    assert (target_phrase(tree).phrase.noun, below(tree)) == ("jar", [])


def test_what_comes_first_may_tell_where_the_object_is() -> None:
    assert below(first("after you go to the sink, take the jar")) == [("near", ["sink"])]


def test_before_someone_is_a_place() -> None:
    assert below(first("take the jar before you")) == [("before", ["you"])]


def test_an_order_that_is_the_only_one_is_not_late() -> None:
    assert target_phrase(first("stop before you reach the sink")).phrase.noun == "sink"


@pytest.mark.parametrize(("side", "noun"), [("left", "jar"), ("top", "plate"), ("right", "bottle")])
def test_a_rank_before_the_noun(side: str, noun: str) -> None:
    phrase = target_phrase(first(f"take the fourth from the {side} {noun}")).phrase
    assert (phrase.noun, phrase.words) == (noun, ("fourth", f"from the {side}"))


@pytest.mark.parametrize(
    "text",
    [
        "please take a photo",
        "good to see you again",
        "my name is Tom",
        "slow down a bit",
        "hurry up please",
        "watch out",
    ],
)
def test_talk_that_names_no_thing(text: str) -> None:
    assert parse_command(text).refused


@pytest.mark.parametrize("text", ["nice weather today", "what a lovely day today", "terrible weather outside"])
def test_weather_is_no_order(text: str) -> None:
    assert parse_command(text).refused is not None


def test_a_relative_clause_behind_a_landmark_has_both_readings() -> None:
    readings = likely("take the jar by the lamp that is green", 0.2)
    colors = [{node.phrase.noun: node.phrase.color for node in reading.tree.walk()} for reading in readings]
    assert sorted((said["jar"] or "", said["lamp"] or "") for said in colors) == [("", "green"), ("green", "")]


@pytest.mark.parametrize(
    ("text", "green"),
    [("take the jar by the lamps that is green", "jar"), ("take the jar by the lamps that are green", "lamp")],
)
def test_the_verb_of_a_relative_clause_agrees(text: str, green: str) -> None:
    for reading in likely(text, 0.2):
        assert [node.phrase.noun for node in reading.tree.walk() if node.phrase.color == "green"] == [green]
