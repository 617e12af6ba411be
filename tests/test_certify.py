from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

import pytest

from dcg_torch.evaluation.certify import certify
from dcg_torch.evaluation.episodes import Episode
from dcg_torch.evaluation.perturbations import (
    PERTURBATIONS,
    garble,
    swap_absent_color,
    swap_color,
    swap_noun,
    take_away,
)
from dcg_torch.evaluation.target_descriptions import Perturbed
from dcg_torch.evaluation.turned_texts import swap_ordinal, swap_side


def episode(text: str, things: str, target: str = "0", **keys: Any) -> Episode:
    """Things such as "red cube, blue ball" in a row from left to right, with their places as ids."""
    objects = []
    for k, thing in enumerate(things.split(", ")):
        color, _, name = thing.rpartition(" ")
        objects.append({"id": str(k), "type": name, "color": color or None, "position": (2.0, -float(k), 0.0)})
    return Episode.model_validate({"id": text, "text": text, "objects": objects, "target": tuple(target), **keys})


def change(function: Callable[[Episode], Perturbed | None], *of: str) -> Perturbed:
    found = function(episode(*of))
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("function", "of", "text", "right", "wrong"),
    [
        (swap_color, ("the red cube", "red cube, blue cube, green ball"), "the blue cube", ["1"], ["", "0", "2"]),
        (swap_color, ("red block", "red cube, blue cube, blue cube"), "blue block", ["1", "2", "12"], ["", "0"]),
        (swap_color, ("red cube by the ball", "red cube, blue cube, ball"), "blue cube by the ball", ["1", ""], ["0"]),
        (swap_noun, ("the red cube", "red cube, red ball, blue ball"), "the red ball", ["1"], ["0", "2", ""]),
        (swap_noun, ("the red cube", "red cube, blue ball"), "the red ball", ["1", ""], ["0"]),
        (swap_noun, ("the table lamp", "LampTable, TableLamp, Spoon", "1"), "the spoon", ["2"], ["1", "0", ""]),
        (swap_side, ("the left cube", "cube, cube"), "the right cube", ["1", ""], ["0"]),
        (swap_side, ("the rightmost cube", "cube, cube", "1"), "the leftmost cube", ["0"], ["1"]),
        (swap_side, ("cube closest to the lamp", "cube, cube, lamp", "1"), "cube farthest from the lamp", ["0"], ["1"]),
        (swap_side, ("cube furthest away from you", "cube, cube"), "cube closest to you", ["1"], ["0"]),
        (swap_side, ("the cube in front of the lamp", "cube, lamp, cube"), "the cube behind the lamp", ["2"], ["0"]),
        (swap_side, ("the ball right behind the top lamp", "ball, ball, lamp"), None, [], []),
        (swap_ordinal, ("second cube from left", "cube, cube, cube", "1"), "third cube from left", ["2"], ["1"]),
        (swap_ordinal, ("cube second from left", "cube, cube, cube", "1"), "cube third from left", ["0"], ["1"]),
        (take_away, ("red cube", "red cube, blue cube, red ball, red cube"), "red cube", [""], ["1", "2", "12"]),
        (take_away, ("the couch", "sofa, lamp"), "the couch", [""], ["1"]),
    ],
)  # fmt: skip
def test_changes(
    function: Callable[[Episode], Perturbed | None],
    of: tuple[str, ...],
    text: str | None,
    right: list[str],
    wrong: list[str],
) -> None:
    """Answers are written as the ids one after another, "" for none."""
    found = function(episode(*of))
    assert (found and found.episode.text) == text
    if found is not None:
        assert found.episode.target == ()
        assert all(found.expected.allows(tuple(answer)) for answer in right)
        assert not any(found.expected.allows(tuple(answer)) for answer in wrong)


def test_an_absent_color_means_nothing() -> None:
    found = change(swap_absent_color, "the red cube", "red cube, light blue cube")
    assert found.episode.text.split()[1] not in ("red", "blue")
    assert found.expected.allows(())
    assert not found.expected.allows(("1",))


def test_a_garbled_text_says_nothing_and_the_scene_stays() -> None:
    before = episode("take the red cube", "red cube, ball")
    found = garble(before)
    assert found is not None
    assert not set(found.episode.text.split()) & {"take", "the", "red", "cube"}
    assert len(found.episode.text.split()) == 4
    assert found.episode.objects == before.objects
    assert not found.expected.allows(("0",))


def test_what_was_taken_away_is_gone_and_the_rest_stays() -> None:
    found = change(take_away, "the red cube", "red cube, blue cube, red ball, red cube")
    assert [o.id for o in found.episode.objects] == ["1", "2"]


@pytest.mark.parametrize(
    ("function", "of", "why"),
    [
        (swap_color, ("the cube", "red cube, blue cube"), "no colour is said"),
        (swap_color, ("the red cube", "red cube, blue ball"), "no other colour of that class"),
        (swap_color, ("the cube by the red ball", "red cube, blue cube, red ball"), "the colour is another thing's"),
        (swap_color, ("the light red cube", "red cube, blue cube"), "another shade of another colour"),
        (swap_color, ("both red cubes", "red cube, red cube, blue cube", "01"), "several are meant"),
        (swap_noun, ("the red one", "red cube, red ball"), "no class is said"),
        (swap_side, ("to the left under a blue cube", "red cube, red cube, blue cube"), "the class is a landmark's"),
        (swap_side, ("to the left under cubes", "cube, cube, cube"), "the class is that of landmarks"),
        (swap_noun, ("by the ball the cube", "cube, ball"), "another class is said first"),
        (swap_noun, ("the cube", "cube, cube"), "no other class is there"),
        (swap_side, ("the left cube", "cube, ball"), "there is one cube: its side tells nothing"),
        (swap_side, ("the cube left of the right ball", "cube, cube, ball"), "two sides are said"),
        (swap_side, ("put the cube left of the ball", "cube, cube, ball"), "it is the side where it shall go"),
        (swap_ordinal, ("the second cube", "cube, cube"), "two of them have no third"),
        (swap_ordinal, ("the cube in the second row", "cube, cube, cube"), "the ordinal is the row's"),
        (take_away, ("the cube", "cube, cube"), "nothing would be left"),
    ],
)  # fmt: skip
def test_where_nothing_follows(function: Callable[[Episode], Perturbed | None], of: tuple[str, ...], why: str) -> None:
    assert function(episode(*of)) is None, why


def test_the_change_is_the_same_every_time() -> None:
    one = episode("the second red cube", "red cube, blue cube, red cube, red cube, green lamp", "2")
    for perturb in PERTURBATIONS.values():
        assert perturb(one) == perturb(one)


def obedient(one: Episode) -> Collection[str]:
    """Takes what has a colour and class that stand side by side in the text."""
    return [o.id for o in one.objects if f"{o.color} {o.type}" in one.text]


def stubborn(one: Episode) -> Collection[str]:
    return ["0"]


RED_CUBES = [
    episode("the red cube", "red cube, blue cube, red ball"),
    episode("the red cube", "blue cube, red cube", "1"),
]


def test_certify_counts_what_changes_as_it_should() -> None:
    counts = certify(obedient, RED_CUBES)
    assert counts["color"] == {"applicable": 2, "n": 2, "right": 2}
    assert counts["noun"] == {"applicable": 1, "n": 1, "right": 1}
    assert counts["absent color"] == counts["garbled"] == counts["taken away"] == {"applicable": 2, "n": 2, "right": 2}
    assert counts["side"] == {"applicable": 0, "n": 0, "right": 0}


def test_certify_sees_an_answer_that_stays() -> None:
    """It was right in one of the two, and that one stays."""
    counts = certify(stubborn, RED_CUBES)
    assert counts["color"] == {"applicable": 2, "n": 1, "right": 0}
    assert counts["garbled"] == {"applicable": 2, "n": 1, "right": 0}
