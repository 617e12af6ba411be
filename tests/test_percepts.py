"""What a robot of others may say it perceives, and what is refused by name."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from dcg_torch.scene.percepts import checked
from dcg_torch.scene.upsilon import with_known, world_model
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import Percept, Pose

MUG = Percept("m1", "mug", "blue", (1.0, 0.5, 0.0))


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"position": (1.0, 0.0)}, "position"),
        ({"position": (math.nan, 0.0, 0.0)}, "position"),
        ({"position": (math.inf, 0.0, 0.0)}, "position"),
        ({"position": (1e200, 0.0, 0.0)}, "position"),
        ({"position": None}, "position"),
        ({"position": "x"}, "position"),
        ({"position": "123"}, "position"),
        ({"size": (1.0, 1.0)}, "size"),
        ({"size": (1.0, 1.0, -1.0)}, "size"),
        ({"rgb": (1.0, 0.0)}, "rgb"),
        ({"rgb": (0.0, 0.0, 256.0)}, "rgb"),
        ({"id": 3}, "id"),
        ({"id": ""}, "id"),
        ({"type": 3}, "type"),
        ({"type": None}, "type"),
        ({"type": " "}, "type"),
        ({"color": ["red"]}, "color"),
        ({"attributes": "held"}, "attributes"),
        ({"attributes": [["held"]]}, "attributes"),
        ({"attributes": 3}, "attributes"),
    ],
)
def test_what_makes_no_sense_is_refused_in_one_line_that_names_it(changed: dict[str, Any], says: str) -> None:
    with pytest.raises(ValueError, match=f"^percept .*: .*{says}") as error:
        world_model([replace(MUG, **changed)], ())
    assert "\n" not in str(error.value)
    assert len(str(error.value)) < 250


@pytest.mark.parametrize("pose", [Pose(math.nan, 0.0), Pose(0.0, math.inf), Pose(0.0, 0.0, math.nan), (0.0, 0.0, 0.0)])
@pytest.mark.parametrize("who", ["robot", "speaker"])
def test_a_place_that_is_none_is_refused(who: str, pose: Any) -> None:
    with pytest.raises(ValueError, match=f"^{who} is .*not a Pose"):
        world_model([MUG], (), **{who: pose})


def test_percepts_are_no_world() -> None:
    with pytest.raises(TypeError, match="world_model"):
        with_known([MUG], ())  # type: ignore[arg-type]


@pytest.mark.parametrize("unit", [0.0, -1.0, math.nan, math.inf])
def test_a_unit_is_a_length(unit: float) -> None:
    with pytest.raises(ValueError, match="unit"):
        Workspace(None, unit)


def test_bounds_are_in_order() -> None:
    assert Workspace((0.0, 1.0, -1.0, 1.0)).unit == 1.0
    for bounds in ((1.0, 0.0, -1.0, 1.0), (0.0, 1.0, 1.0, -1.0), (math.nan, 1.0, 1.0, -1.0)):
        with pytest.raises(ValueError, match="bounds"):
            Workspace(bounds)


def test_two_objects_of_one_id_are_refused() -> None:
    with pytest.raises(ValueError, match="'m1': two objects have this id"):
        world_model([MUG, replace(MUG, color="red")], ())


def test_a_thing_may_be_called_what_the_robot_calls_its_guesses() -> None:
    real = [replace(MUG, id=id_) for id_ in ("hypothetical mug", "hypothetical unknown", "hypothetical mug*")]
    found = world_model(real, ("mug",)).objects
    assert len({o.id for o in found}) == len(found) == 5
    assert [o.hypothetical for o in found] == [False, False, False, True, True]


def test_lists_arrays_and_sets_come_into_one_form() -> None:
    given_: dict[str, Any] = {"position": [1.0, 0.5, 0.0], "size": np.array([0.1, 0.1, 0.2]), "attributes": {"held"}}
    (found,) = checked([replace(MUG, **given_)])
    assert found == replace(MUG, size=(0.1, 0.1, 0.2), attributes=frozenset({"held"}))
    hash(found)


def test_a_dict_of_attributes_is_what_an_episode_says_of_its_keys() -> None:
    given_: Any = {
        "held": True,
        "glasses": False,
        "material": "wood",
        "row": 1,
        "number": 7,
        "price": 3.5,
        "owner": None,
    }
    (found,) = checked([replace(MUG, attributes=given_)])
    assert found.attributes == {"held", "glasses: no", "material: wood", "number: 7"}  # a row and a price are no facts
    (plain,) = checked([replace(MUG, attributes=["held", "material: wood"])])
    assert plain.attributes == {"held", "material: wood"}


@pytest.mark.parametrize("number", [np.float32, np.int64, torch.tensor])
def test_numbers_of_arrays_become_plain_ones(number: Any) -> None:
    position: Any = (number(1), number(2), number(0))
    (found,) = checked([replace(MUG, position=position)])
    assert found.position == (1.0, 2.0, 0.0)
    assert {type(v) for v in found.position} == {float}


@pytest.mark.parametrize("no_percept", [{"id": "m1", "type": "mug"}, "mug", None])
def test_what_is_no_percept_is_told_what_one_is(no_percept: Any) -> None:
    with pytest.raises(ValueError, match=r"is no percept; make one: Percept\(id, type, color, position\)"):
        world_model([no_percept], ())


@given(st.tuples(*[st.floats(-1e6, 1e6)] * 3), st.none() | st.tuples(*[st.floats(0.0, 1e3)] * 3))
def test_what_makes_sense_stays_as_it_is(
    position: tuple[float, float, float], size: tuple[float, float, float] | None
) -> None:
    percept = replace(MUG, position=position, size=size)
    (found,) = checked([percept])
    assert found is percept
