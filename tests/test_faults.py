"""Examples of faults that strangers found, each beside two of our own; `docs/reliability.md` lists all kinds."""

from __future__ import annotations

import pytest
import torch

import dcg_torch
from dcg_torch import GroundingModel, Percept, Pose
from dcg_torch.language import Parser

ROW = [  # four cubes from left to right, of different sizes, and a ball at the left end
    Percept("a", "cube", "red", (2.0, 1.5, 0.0), (0.1, 0.1, 0.1)),
    Percept("b", "cube", "red", (2.0, 0.5, 0.0), (0.3, 0.3, 0.3)),
    Percept("c", "cube", "red", (2.0, -0.5, 0.0), (0.2, 0.2, 0.2)),
    Percept("d", "cube", "red", (2.0, -1.5, 0.0), (0.4, 0.4, 0.4)),
]
ROUND = [  # barrels before and behind the robot; those behind stand farther to the sides
    Percept("left behind", "barrel", "red", (-2.0, 2.0, 0.0)),
    Percept("left", "barrel", "red", (2.0, 0.5, 0.0)),
    Percept("right", "barrel", "red", (2.0, -0.5, 0.0)),
    Percept("right behind", "barrel", "red", (-2.0, -2.0, 0.0)),
]


@pytest.fixture(scope="module")
def model() -> GroundingModel:
    return dcg_torch.pretrained()


def meant(model: GroundingModel, text: str, things: list[Percept]) -> list[str]:
    answer = model.ground(text, model.world_model(things, robot=Pose(0.0, 0.0, 0.0)))
    return [thing.id for thing in answer.objects]


def pair(type_: str, color: str, other: str, other_color: str) -> list[Percept]:
    return [Percept("it", type_, color, (2.0, 1.0, 0.0)), Percept("other", other, other_color, (2.0, -1.0, 0.0))]


@pytest.mark.parametrize(
    ("text", "things"),
    [
        ("go to the red cube", pair("Cube", "Red", "Sphere", "Blue")),
        ("go to the coffee table", pair("CoffeeTable", "brown", "Table", "brown")),
        ("go to the gray cube", pair("cube", "grey", "cube", "red")),
    ],
)
def test_10_names_are_one_however_they_are_written(model: GroundingModel, text: str, things: list[Percept]) -> None:
    assert meant(model, text, things) == ["it"]


@pytest.mark.parametrize("id_", ["hypothetical cube", "hypothetical unknown", "hypothetical sphere"])
def test_12_a_real_thing_is_found_whatever_it_is_called(model: GroundingModel, id_: str) -> None:
    things = [Percept(id_, "cube", "red", (2.0, 1.0, 0.0)), Percept("other", "sphere", "blue", (2.0, -1.0, 0.0))]
    answer = model.ground("go to the red cube", model.world_model(things))
    assert [(thing.id, thing.hypothetical) for thing in answer.objects] == [(id_, False)]


@pytest.mark.parametrize("text", ["say hello", "count the cups", "tell me the time", "follow me"])
def test_13_no_order_about_a_thing_is_refused_and_teaches_nothing(model: GroundingModel, text: str) -> None:
    known = dict(model.symbols)
    answer = model.ground(text, model.world_model(pair("traffic cone", "red", "mug", "blue")))
    assert answer.problem
    model.learn(answer)
    assert model.symbols == known


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("go to the second biggest cube", "b"),
        ("go to the second smallest cube", "c"),
        ("go to the second last cube from the left", "c"),
    ],
)
def test_14_an_ordinal_counts_from_the_superlative(model: GroundingModel, text: str, id_: str) -> None:
    assert meant(model, text, ROW) == [id_]


@pytest.mark.parametrize(
    ("text", "id_"),
    [
        ("go to the leftmost barrel in front of the robot", "left"),
        ("go to the rightmost barrel in front of you", "right"),
        ("go to the rightmost barrel behind you", "right behind"),
    ],
)
def test_15_a_rank_is_among_what_the_rest_describes(model: GroundingModel, text: str, id_: str) -> None:
    assert meant(model, text, ROUND) == [id_]


@pytest.mark.parametrize("noun", ["can", "stand", "light", "tea", "cherry", "wine glass", "coffee table"])
def test_16_nouns_may_be_other_words_too(parser: Parser, noun: str) -> None:
    parse = parser.parse(f"go to the {noun}", ())
    assert (parse.noun, parse.color) == (noun, None)


@pytest.mark.parametrize(
    ("noun", "known"), [("cola", ["cola", "colon"]), ("uber", []), ("id card", []), ("umber", ["uber"])]
)
def test_17_a_word_that_is_one_is_not_mended(parser: Parser, noun: str, known: list[str]) -> None:
    assert parser.parse(f"go to the {noun}", known).noun == noun


def test_17_a_learned_noun_leaves_the_verbs_alone(parser: Parser) -> None:
    for text in ("pick up the orange block", "pick the orange block up"):
        parse = parser.parse(text, ["pickup", "up", "pick"])
        assert (parse.noun, parse.color) == ("block", "orange")


@pytest.mark.parametrize(
    ("text", "noun", "color", "words"),
    [
        ("go to cube 3", "cube", None, ("3",)),
        ("drive to crate number 4", "crate", None, ("4",)),
        ("go to the red_cube", "cube", "red", ()),
        ("go to the extra large clamp", "clamp", None, ("large",)),
    ],
)
def test_18_numbers_and_names_with_underscores_are_read(
    parser: Parser, text: str, noun: str, color: str | None, words: tuple[str, ...]
) -> None:
    tree = parser.parse(text, ()).tree
    assert tree is not None
    target = [t.phrase for t in tree.walk()][-1]
    assert (target.noun, target.color, target.words) == (noun, color, words)


def test_19_no_call_changes_the_number_of_threads() -> None:
    before = torch.get_num_threads()
    try:
        torch.set_num_threads(2)
        own = dcg_torch.pretrained()
        assert torch.get_num_threads() == 2
        answer = own.ground("go to the mug", own.world_model(pair("mug", "red", "cube", "blue")))
        assert torch.get_num_threads() == 2
        own.learn(answer)
        assert torch.get_num_threads() == 2
    finally:
        torch.set_num_threads(before)
