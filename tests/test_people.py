"""Pictures of people, described in few words, whatever their class and keys are called. Commands that we wrote."""

from __future__ import annotations

from typing import Final

import pytest
from asked import grounded, shipped

import dcg_torch
from dcg_torch.evaluation.episodes import EpisodeObject
from dcg_torch.grounding.solution import Solution
from dcg_torch.language import default_parser
from dcg_torch.names.attributes import attribute_evidence
from dcg_torch.names.keys import attribute_key, counts
from dcg_torch.names.weights import log_odds
from dcg_torch.types import Percept, Pose

FACES = (
    {
        "gender": "male",
        "hair": "blond",
        "beard": 1,
        "glasses": 1,
        "suit": 0,
        "tie": 0,
        "shirt": "green",
        "gaze": "left",
    },
    {
        "gender": "female",
        "hair": "blond",
        "beard": 0,
        "glasses": 1,
        "suit": 0,
        "tie": 0,
        "shirt": "red",
        "gaze": "left",
    },
    {
        "gender": "male",
        "hair": "dark",
        "beard": 0,
        "glasses": 0,
        "suit": 1,
        "tie": 1,
        "shirt": "white",
        "gaze": "front",
    },
    {
        "gender": "female",
        "hair": "red",
        "beard": 0,
        "glasses": 0,
        "suit": 1,
        "tie": 0,
        "shirt": "black",
        "gaze": "left",
    },
    {"gender": "male", "hair": "dark", "beard": 0, "glasses": 0, "suit": 1, "tie": 0, "shirt": "white", "gaze": "left"},
)
MEN = (
    {"age": "old", "hairColour": "white", "bald": False, "hasBeard": True, "hasGlasses": False, "hasHat": False},
    {"age": "old", "hairColour": "white", "bald": False, "hasBeard": False, "hasGlasses": True, "hasHat": False},
    {"age": "young", "hairColour": "dark", "bald": False, "hasBeard": True, "hasGlasses": True, "hasHat": True},
    {"age": "young", "hairColour": "red", "bald": True, "hasBeard": False, "hasGlasses": False, "hasHat": False},
)


def _ground(text: str, things: tuple[dict[str, object], ...], type_: str) -> Solution:
    """Among things that hang side by side; the first is the leftmost. Their ids are their numbers."""
    places = [{"id": str(k), "type": type_, "position": [2.0, 1.0 - 0.5 * k, 1.2]} for k in range(len(things))]
    objects = [EpisodeObject.model_validate({**place, **own}) for place, own in zip(places, things, strict=True)]
    percepts = [
        Percept(o.id, o.type, o.color, (2.0, 1.0 - 0.5 * k, 1.2), attributes=o.attributes)
        for k, o in enumerate(objects)
    ]
    return grounded(text, percepts, looked=True)


def _meant(text: str, things: tuple[dict[str, object], ...], type_: str) -> list[str]:
    return [o.id for o in _ground(text, things, type_).objects if not o.hypothetical]


@pytest.mark.parametrize("type_", ["face", "portrait", "person", "img"])
@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("blonde lady in glasses", "1"),
        ("the bearded chap", "0"),
        ("a fellow in a suit looking left", "4"),
        ("picture of the woman in a suit", "3"),
        ("the bloke wearing green", "0"),
        ("the gal in black", "3"),
        ("dude in formal clothes, with a tie", "2"),
        ("he is the only one who looks straight at the camera", "2"),
        ("man, dark hair, no tie", "4"),
        ("redhead woman", "3"),
        ("one in a suit, rightmost", "4"),
    ],
)
def test_who_is_described(text: str, number: str, type_: str) -> None:
    assert _meant(text, FACES, type_) == [number]


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("the elderly gentleman with a white beard", ["0"]),
        ("old guy with specs", ["1"]),
        ("young man beard hat", ["2"]),
        ("bald lad no beard", ["3"]),
        ("photo of the youngster in a hat", ["2"]),
        ("which man has a beard and no glasses? take that one", ["0"]),
        ("the woman in a hat", []),
        ("the bald man with a beard", []),
    ],
)
def test_where_all_are_men(text: str, numbers: list[str]) -> None:
    assert _meant(text, MEN, "man") == numbers


@pytest.mark.parametrize("text", ["the woman with a beard", "bearded lady", "the woman wearing a tie"])
def test_whom_nobody_is_like_is_not_there(text: str) -> None:
    assert _meant(text, FACES, "face") == []


def test_who_contradicts_two_words_is_less_sure_not_to_be_there_than_one_contradiction_twice() -> None:
    """A second contradiction tells less than the first: who misjudges one thing may misjudge two."""
    world = shipped().world_model(
        [Percept("a", "face", None, (2.0, 0.0, 1.0), attributes=frozenset({"beard: no", "hat: no", "hair: dark"}))],
        Pose(0.0, 0.0),
        looked=True,
    )
    ask = (default_parser().parse(text) for text in ("the one with a beard", "the one with a beard and a hat"))
    one, two = (sum(p for i, p in shipped().ground(c, world).probabilities.items() if i != "a") for c in ask)
    assert 0.4 < one < two < 0.9


@pytest.mark.parametrize(
    ("key", "same"), [("hasGlasses", "glasses"), ("sex", "gender"), ("smile", "smiling"), ("moustache", "mustache")]
)
def test_one_key_for_what_says_the_same(key: str, same: str) -> None:
    assert attribute_key(key) == same


def test_one_and_zero_are_yes_and_no_but_where_they_count() -> None:
    one = {"id": "a", "type": "mug", "position": [0, 0], "lid": 1, "chipped": 0, "row": 1, "number": 1, "floors": 2}
    assert EpisodeObject.model_validate(one).attributes == {"lid", "chipped: no", "number: 1"}
    assert counts("column")
    assert not counts("lid")


@pytest.mark.parametrize(
    ("word", "attribute", "fact"),
    [
        ("shiny", "material: metal", "alike"),
        ("shiny", "material: rubber", "contrary"),
        ("matte", "material: rubber", "alike"),
        ("matte", "material: metal", "contrary"),
        ("white haired", "hair: blond", "contrary"),
        ("formal", "hasSuit", "alike"),
    ],
)
def test_values_that_another_word_says(word: str, attribute: str, fact: str) -> None:
    said = "with white hair" if word == "white haired" else word
    assert attribute_evidence((said,), {attribute}) == (f"attribute: {fact}",)


def test_words_for_people() -> None:
    assert min(log_odds(noun, "man") for noun in ("chap", "fellow", "bloke", "gentleman", "lad")) > 2.0
    assert min(log_odds(noun, "person") for noun in ("lady", "dude", "kid", "gal")) > 2.0
    assert max(log_odds("woman", "man"), log_odds("man", "woman"), log_odds("lady", "boy")) < 0.0


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("the old man with glasses, a beard and a hat", "2"),  # he is not old
        ("young man with red hair, a hat and a beard", "2"),  # his hair is dark
    ],
)
def test_of_words_of_which_one_fits_nobody_the_others_count(text: str, number: str) -> None:
    ranked = _ground(text, MEN, "man").probabilities
    assert max((p, i) for i, p in ranked.items() if i.isdecimal())[1] == number


HALF_HAVE: Final = {
    "a": {"hat: none", "scarf: red"},
    "b": {"hat: blue", "scarf: red"},
    "c": {"hat: blue", "scarf: none"},
    "d": {"hat: none", "scarf: green"},
}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("the child with no hat and a red scarf", "a"),
        ("the child with no hat and a green scarf", "d"),
        ("the child with a hat and no scarf", "c"),
        ("the child who has no hat but a red scarf", "a"),
        ("the child with a blue hat and a red scarf", "b"),
    ],
)
def test_no_denies_what_it_stands_before_alone(text: str, expected: str) -> None:
    there = [
        Percept(name, "child", None, (3.0, 1.5 - k, 0.0), attributes=frozenset(has))
        for k, (name, has) in enumerate(HALF_HAVE.items())
    ]
    found = grounded(text, there, None, looked=True)
    assert [o.id for o in found.objects] == [expected]


def test_of_two_things_with_one_is_there_and_the_other_is_not() -> None:
    model = dcg_torch.pretrained()
    there = [
        Percept("t1", "table", None, (3.0, 2.0, 0.0)),
        Percept("t2", "table", None, (3.0, -2.0, 0.0)),
        Percept("t3", "table", None, (6.0, 0.0, 0.0)),
        Percept("v1", "vase", None, (3.0, 2.0, 0.8)),
        Percept("v3", "vase", None, (6.0, 0.0, 0.8)),
        Percept("s1", "stool", None, (3.0, 2.8, 0.0)),
        Percept("s2", "stool", None, (3.0, -2.8, 0.0)),
    ]
    world = model.world_model(there, looked=True)
    said = {"a vase and no stool": "t3", "no vase and a stool": "t2", "a vase and a stool": "t1"}
    assert {has: [o.id for o in model.ground(f"the table with {has}", world).objects] for has in said} == {
        has: [id_] for has, id_ in said.items()
    }
