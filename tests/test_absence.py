"""That nothing there is meant: it is judged by name and colour, once all has been seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

import dcg_torch
from dcg_torch import GroundingModel, Percept, Pose
from dcg_torch.grounding.solution import Solution
from dcg_torch.interpretation.factor_tree import to_factor_tree
from dcg_torch.language import parse_command
from dcg_torch.learning.landmarks import Lesson
from dcg_torch.types import OPAQUE


def _things(*said: str) -> list[Percept]:
    """Things as "colour class", the class of one word, side by side."""
    return [
        Percept(f"{k}", text.split()[-1], text.split()[0] if " " in text else None, (2.0, 1.0 - k, 0.0))
        for k, text in enumerate(said)
    ]


def _ground(model: GroundingModel, text: str, things: Sequence[Percept], *, looked: bool = True) -> Solution:
    return model.ground(text, model.world_model(things, robot=Pose(0.0, 0.0), looked=looked))


def _absent(solution: Solution) -> float:
    """The probability that nothing there is meant."""
    return sum(solution.probabilities[o.id] for o in solution.world.objects if o.hypothetical)


@pytest.mark.parametrize(
    ("text", "things"),
    [
        ("take the white ball", ["red ball", "green ball", "blue cube"]),  # no such colour
        ("take the biggest white ball", ["red ball", "green ball", "blue cube"]),  # a rank changes nothing
        ("take the black cube left of the ball", ["red cube", "green cube", "blue ball"]),  # nor does a landmark
        ("take the red ball", ["green ball", "red cube"]),  # the colour of one and the class of the other
        ("get me the apple", ["lamp", "desk", "sofa"]),  # no such class
        ("take the two red balls", ["green ball", "blue ball", "blue cube"]),
        ("the left one of the two cubes", ["red ball", "green ball", "blue lamp"]),  # one of what is not there
        ("take the middle one of the three cubes", ["red ball", "green ball", "blue lamp"]),
        ("frbl zwt the gnrx", ["red ball", "green ball"]),  # several words that nobody knows
    ],
)
def test_what_is_not_there_is_not_meant(model: GroundingModel, text: str, things: list[str]) -> None:
    solution = _ground(model, text, _things(*things))
    assert all(o.hypothetical for o in solution.objects)
    assert _absent(solution) > 0.5


@pytest.mark.parametrize(
    ("noun", "meant"),
    [("bell", "1"), ("bill", "1"), ("wall", None), ("bowl", None), ("lump", None)],
)
def test_a_word_that_is_a_name_but_for_a_letter_may_be_meant_for_it(
    model: GroundingModel, noun: str, meant: str | None
) -> None:
    """Two letters, or the first one, are no slip; nor is what has another colour meant."""
    solution = _ground(model, f"take the red {noun}", _things("blue cube", "red ball", "green lamp"))
    assert [o.id for o in solution.objects if not o.hypothetical] == ([] if meant is None else [meant])


def test_what_is_called_by_quite_another_name_is_absent_with_doubt(model: GroundingModel) -> None:
    """People call what is there by odd names, too; a name and a colour that are both odd leave less doubt."""
    things = _things("red ball", "green ball", "blue cube")
    one, both = (_absent(_ground(model, f"take the {said}", things)) for said in ("piano", "purple piano"))
    assert 0.5 < one < 0.9 < both


def test_knowing_more_types_makes_absence_no_likelier_where_colours_are_shown(model: GroundingModel) -> None:
    shades = [(40, 60, 200), (150, 170, 230), (200, 40, 40)]
    patches = [Percept(f"{k}", "patch", None, (1.0, 1.0 - k, 0.0), rgb=rgb) for k, rgb in enumerate(shades)]
    learned = model.copy()
    for k in range(40):
        learned.learner = learned.learner.told(f"gnrx{k}", f"gadget {k}")
    learned.train()
    few, many = (_ground(one, "the pale blue one", patches) for one in (model, learned))
    assert sum(o.hypothetical for o in many.world.objects) > sum(o.hypothetical for o in few.world.objects) + 30
    assert _absent(many) == pytest.approx(_absent(few), abs=0.02)


def test_a_class_met_elsewhere_does_not_change_what_is_said_of_a_place(model: GroundingModel) -> None:
    """Who has met tables still hears of the middle of the one that the cubes stand on; unless one may stand unseen."""
    travelled = model.copy()
    travelled.learner = travelled.learner.told("table", "table")
    command = parse_command("take the cube in the middle of the table").readings[0].tree
    landmarks = []
    for one, looked in ((model, True), (travelled, True), (travelled, False)):
        world = one.world_model(_things("red cube", "red cube"), robot=Pose(0.0, 0.0), looked=looked)
        assert ("table" in world.classes) == (one is travelled and not looked)
        landmarks.append([node.phrase.noun for node in to_factor_tree(command, world).walk()][-1])
    assert landmarks == ["middle", "middle", "table"]


@pytest.mark.parametrize(
    ("text", "things", "meant"),
    [
        ("take the red ball", ["red ball", "green ball", "blue cube"], {"0"}),
        ("take the couch", ["lamp", "sofa", "desk"], {"1"}),  # a synonym
        ("take the lamp", ["desk", "FloorLamp"], {"1"}),  # the head
        ("take the thing on the right", ["lamp", "sofa", "desk"], {"2"}),  # names nothing
        ("take the red one", ["red lamp", "green sofa"], {"0"}),
        ("take the red piece", ["red lamp", "green sofa"], {"0"}),
        ("take the sky blue ball", ["cyan ball", "green ball"], {"0"}),  # people exchange some names of colours
        ("take the leftmost ball", ["red ball", "green ball", "blue ball"], {"0"}),
        ("take the balls", ["red ball", "green ball", "blue cube"], {"0", "1"}),
    ],
)
def test_what_is_there_is_found(model: GroundingModel, text: str, things: list[str], meant: set[str]) -> None:
    solution = _ground(model, text, _things(*things))
    assert {o.id for o in solution.objects} == meant
    assert _absent(solution) < 0.2


@pytest.mark.parametrize("carts", [2, 3, 5])
def test_one_of_many_that_it_may_be_is_meant_and_not_nothing(model: GroundingModel, carts: int) -> None:
    """Each cart is less likely than that none is, all together are likelier: "which one?", not "it is not here"."""
    things = [
        Percept(f"{kind} {k}", f"{kind} cart", None, (2.0 + k, side, 0.0))
        for kind, side in (("tool", 1.0), ("food", -1.0))
        for k in range(carts)
    ]
    solution = _ground(model, "take the laundry cart", things)
    assert [o.hypothetical for o in solution.objects] == [False]
    absent = _absent(solution)
    assert absent < 1.0 / 3.0
    if carts > 2:
        assert (solution.probability or 1.0) < absent
    assert solution.runner_up is not None
    assert solution.runner_up.meant != solution.object


def test_a_new_word_may_name_what_is_there(model: GroundingModel) -> None:
    assert _absent(_ground(model, "go to the blicket", _things("pallet", "crate"))) < 0.5


def test_a_word_that_is_known_and_names_no_thing_is_no_new_name(model: GroundingModel) -> None:
    things = _things("red cube", "blue ball", "green lamp")
    assert _absent(_ground(model, "the zorp", things)) < 0.5 < _absent(_ground(model, "the weather", things))


def test_a_class_without_a_name_may_be_anything(model: GroundingModel) -> None:
    things = [Percept("a", f"{OPAQUE}7", None, (2.0, 0.0, 0.0))]
    assert _absent(_ground(model, "go to the pallet", things)) < 0.5


def test_the_shares_of_what_is_there_do_not_change(model: GroundingModel) -> None:
    """The absent take their share of all others alike: of two equal things none gains."""
    solution = _ground(model, "take the white ball", _things("red ball", "red ball"))
    assert solution.probabilities["0"] == pytest.approx(solution.probabilities["1"], rel=1e-9)
    assert sum(solution.probabilities.values()) == pytest.approx(1.0)


def test_what_is_ruled_out_is_not_what_was_meant(model: GroundingModel) -> None:
    world = model.world_model(_things("red ball", "green cube"), robot=Pose(0.0, 0.0), looked=True)
    assert _absent(model.ground("take the red ball", world)) < 0.1
    others = frozenset(o.id for o in world.objects if o.id != "0")
    assert _absent(model.ground("take the red ball", replace(world, meant=others))) > 0.5


def test_before_a_look_round_and_without_names_nothing_is_said_of_it(model: GroundingModel) -> None:
    things = _things("red ball", "green ball")
    for of, looked in ((model, False), (dcg_torch.pretrained(opaque=True), True)):
        assert _absent(_ground(of, "take the white ball", things, looked=looked)) < 0.9


def test_a_word_taught_where_all_is_of_one_type_is_not_absent(model: GroundingModel) -> None:
    """No choice among widgets tells that "crate" names them, and yet each lesson says so."""
    taught = model.copy()
    things = _things("red widget", "green widget", "blue widget")
    world = taught.world_model(things, robot=Pose(0.0, 0.0), looked=True)
    lessons = []
    for k, color in enumerate(("red", "green", "blue")):
        tree = parse_command(f"take the {color} crate").tree
        assert tree is not None
        lessons += [Lesson(tree, world, frozenset({f"{k}"}))] * 4
    taught.teach(lessons, rounds=1)
    solution = _ground(taught, "take the green crate", things)
    assert [o.id for o in solution.objects] == ["1"]
    assert _absent(solution) < 0.1


@pytest.mark.parametrize(
    "text", ["the cup next to the piano", "the cup closest to the bicycle", "the cup left of the hammer"]
)
def test_a_landmark_that_is_not_there_makes_it_likelier_that_nothing_is_meant(model: GroundingModel, text: str) -> None:
    several = _things("red cup", "red cup", "red cup", "blue lamp")
    there = text.replace("piano", "lamp").replace("bicycle", "lamp").replace("hammer", "lamp")
    assert _absent(_ground(model, text, several)) > 0.15  # it was 0.007
    assert _absent(_ground(model, there, several)) < 0.02
    one = _ground(model, text, _things("red cup", "green jug", "blue lamp"))
    assert [o.id for o in one.objects] == ["0"]
    assert _absent(one) < 0.02  # there is one cup alone, whatever it stands beside


def test_what_a_robot_is_is_no_landmark_that_is_not_there(model: GroundingModel) -> None:
    drums = [
        Percept(f"{k}", "drum", "blue", (x, y, 0.0)) for k, (x, y) in enumerate([(4, 0), (-3, 1), (1, 5), (0, -4)])
    ]
    assert [o.id for o in _ground(model, "the drum in front of the forklift", drums).objects] == ["0"]
