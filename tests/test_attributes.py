"""What commands say of attributes by their keys: "with glasses", "the bearded man", "in the red shirt"."""

from __future__ import annotations

import pytest
from asked import grounded

from dcg_torch.evaluation.episodes import EpisodeObject
from dcg_torch.interpretation.attributes import by_attributes
from dcg_torch.language import parse_command, target_phrase
from dcg_torch.model.pretrain import pretrained
from dcg_torch.names.attributes import attribute_evidence
from dcg_torch.names.keys import named_key
from dcg_torch.types import Percept, Pose

PEOPLE = (
    {"gender: male", "glasses: yes", "beard: no", "hair: gray", "shirt: red"},
    {"gender: male", "glasses: no", "beard: yes", "hair: dark", "shirt: blue"},
    {"gender: female", "glasses: no", "beard: no", "hair: blond", "shirt: red"},
    {"gender: female", "glasses: yes", "beard: no", "hair: dark", "shirt: green"},
)
KEYS = frozenset({"gender", "glasses", "beard", "hair", "shirt"})


def _people() -> list[Percept]:
    return [
        Percept(f"p{k}", "person", None, (2.0, 0.5 * k, 0.0), attributes=frozenset(own)) for k, own in enumerate(PEOPLE)
    ]


@pytest.mark.parametrize(
    ("word", "attributes", "fact"),
    [
        ("with glasses", {"glasses: yes"}, "equal"),
        ("with glasses", {"glasses: no"}, "contrary"),
        ("not with glasses", {"glasses: no"}, "alike"),
        ("not with glasses", {"glasses: yes"}, "contrary"),
        ("with beard", {"hasBeard: no"}, "contrary"),
        ("with dark hair", {"hair_colour: brown"}, "alike"),
        ("with dark hair", {"hair: blond"}, "contrary"),
        ("with red shirt", {"shirt: red"}, "equal"),
        ("with red shirt", {"shirt: blue"}, "contrary"),
        ("with hat", {"beard: yes"}, "silent"),
        ("woman", {"gender: female"}, "alike"),
        ("woman", {"gender: male"}, "contrary"),
        ("smiling", {"smiling: no"}, "contrary"),
        ("smiling", {"smiling: yes"}, "equal"),
        ("bald", {"beard: no", "hair: dark"}, "contrary"),
        ("bald", {"beard: no", "hair: no"}, "alike"),
        ("with facial hair", {"hair: dark", "facial hair: no"}, "contrary"),
        ("bald", {"hairColour: light", "hasHair: 0"}, "alike"),
        ("bald", {"hairColour: light", "hasHair: 1"}, "contrary"),
        ("haired", {"hairColour: light"}, "alike"),
        ("clean shaven", {"hasBeard: 0"}, "alike"),
        ("clean shaven", {"hasBeard: 1"}, "contrary"),
        ("with white beard", {"hasBeard: 1", "hairColour: light"}, "alike"),
        ("with dark hair", {"hasHair: yes", "hairColour: light"}, "contrary"),
        ("with light hair", {"hasHair: yes", "hairColour: light"}, "equal"),
        ("with hair", {"hasHair: no", "hairColour: white"}, "contrary"),
        ("with dark beard", {"hasBeard: 1", "hairColour: light"}, "contrary"),
        ("with dark beard", {"hasBeard: 1", "shirt: dark"}, "silent"),
    ],
)
def test_facts_about_what_an_object_has(word: str, attributes: set[str], fact: str) -> None:
    assert attribute_evidence([word], attributes) == (f"attribute: {fact}",)


@pytest.mark.parametrize(
    ("noun", "key"), [("spectacle", "glasses"), ("necktie", "tie"), ("table", None), ("beard", "beard")]
)
def test_nouns_name_keys(noun: str, key: str | None) -> None:
    assert named_key(noun, frozenset({"glasses", "tie", "beard", "orientation"})) == key


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the man with glasses", "p0"),
        ("the bearded man", "p1"),
        ("a man who has no glasses", "p1"),
        ("the woman without glasses", "p2"),
        ("the blonde woman", "p2"),
        ("the dark-haired woman", "p3"),
        ("the woman in the red shirt", "p2"),
        ("he has a beard", "p1"),
        ("the woman wears spectacles", "p3"),
        ("the grey haired guy", "p0"),
        ("the person between the bearded man and the woman with glasses", "p2"),
    ],
)
def test_the_shipped_model_finds_people_by_what_they_have(text: str, meant: str) -> None:
    model = pretrained()
    world = model.world_model(_people(), Pose(0.0, 0.0), looked=True)
    answer = model.ground(text, world)
    assert answer.object is not None
    assert answer.object.id == meant


def test_where_no_attribute_is_given_nothing_changes() -> None:
    model = pretrained()
    tree = parse_command("the man with glasses in the red shirt").tree
    assert tree is not None
    bare = [Percept("a", "person", "red", (1.0, 0.0, 0.0)), Percept("b", "glasses", None, (2.0, 0.0, 0.0))]
    world = model.world_model(bare, Pose(0.0, 0.0), looked=True)
    assert by_attributes([tree], world) == [tree]


def test_a_thing_that_is_there_stays_a_landmark() -> None:
    model = pretrained()
    tree = parse_command("the person with the glasses").tree
    assert tree is not None
    world = model.world_model([*_people(), Percept("g", "glasses", None, (2.0, 0.1, 0.0))], Pose(0.0, 0.0), looked=True)
    said = target_phrase(by_attributes([tree], world)[0])
    assert [child.phrase.noun for place in said.children for child in place.children] == ["glass"]


def test_truths_of_an_episode_are_attributes() -> None:
    one = EpisodeObject.model_validate(
        {
            "id": "a",
            "type": "person",
            "position": [0, 0],
            "beard": False,
            "held": True,
            "hasTie": 1,
            "hasHair": 0,
            "row": 1,
        }
    )
    assert one.attributes == {"beard: no", "held", "hasTie", "hasHair: no"}


def _told_apart(text: str, *things: tuple[str, str | None, set[str]]) -> list[str]:
    """What the shipped model takes a command to mean; things stand from left to right, numbered from 0."""
    percepts = [
        Percept(f"o{k}", type_, color, (2.0, 1.0 - k, 0.0), attributes=frozenset(own))
        for k, (type_, color, own) in enumerate(things)
    ]
    return [o.id for o in grounded(text, percepts, looked=True).objects if not o.hypothetical]


MUG, PLATE, BOTTLE = (
    ("mug", None, {"material: steel"}),
    ("plate", None, {"material: ceramic"}),
    ("bottle", None, {"material: plastic"}),
)


@pytest.mark.parametrize("text", ["pick up the iron", "take the china"])
def test_a_thing_is_not_what_another_is_made_of(text: str) -> None:
    assert _told_apart(text, MUG, PLATE, BOTTLE) == []


@pytest.mark.parametrize("text", ["the spoon made of wood", "the wooden spoon", "the spoon that is made from wood"])
def test_what_things_are_made_of(text: str) -> None:
    assert _told_apart(text, ("spoon", None, {"material: steel"}), ("spoon", None, {"material: wood"})) == ["o1"]


def test_what_is_merely_true_is_heard() -> None:
    people = ("person", None, {"beard"}), ("person", None, {"glasses", "hat"})
    assert _told_apart("the person with glasses", *people) == ["o1"]
    assert _told_apart("the bearded one", *people) == ["o0"]


def test_a_side_is_a_place_where_things_are_turned_to_sides() -> None:
    chairs = ("chair", None, {"orientation: right"}), ("chair", None, {"orientation: left"})
    assert _told_apart("the chair on the left side", *chairs) == ["o0"]
    assert _told_apart("the chair facing left", *chairs) == ["o1"]


@pytest.mark.parametrize(
    ("way", "which"),
    [
        ("rear", "o2"),
        ("the rear", "o2"),
        ("rearward", "o2"),
        ("rearwards", "o2"),
        ("leftward", "o1"),
        ("rightwards", "o0"),
    ],
)
def test_ways_to_be_turned_have_several_names(way: str, which: str) -> None:
    chairs = [("chair", None, {f"orientation: {side}"}) for side in ("right", "left", "back")]
    assert _told_apart(f"the chair facing {way}", *chairs) == [which]


@pytest.mark.parametrize("text", ["the cube that is not red", "the non-red cube"])
def test_a_color_that_is_denied(text: str) -> None:
    assert _told_apart(text, ("cube", "red", set()), ("cube", "blue", set())) == ["o1"]


def test_a_word_that_compares_colors_makes_no_thing_of_what_is_not_there() -> None:
    assert _told_apart("the darkest unicorn", ("cube", "red", set()), ("cube", "blue", set())) == []


@pytest.mark.parametrize(("text", "ids"), [("wash the dirty blue cup", {"a"}), ("the clean blue cup", {"b"})])
def test_a_state_before_a_color_is_no_name_of_a_color(text: str, ids: set[str]) -> None:
    cups = [
        Percept("a", "cup", "blue", (1.0, 0.3, 0.0), attributes=frozenset({"state: dirty"})),
        Percept("b", "cup", "blue", (1.0, -0.3, 0.0), attributes=frozenset({"state: clean"})),
        Percept("c", "cup", "yellow", (1.2, 0.0, 0.0), attributes=frozenset({"state: dirty"})),
    ]
    solution = grounded(text, cups, looked=True)
    assert {o.id for o in solution.objects} == ids
