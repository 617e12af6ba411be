"""Lessons on what a hand can do are true of their scenes: checked against the heights of things alone."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from dcg_torch.grounding.features import Group
from dcg_torch.language import default_parser
from dcg_torch.learning.trainable import believed_mask, taught_mask
from dcg_torch.lessons.handling import stack_scene
from dcg_torch.model.pretrain import pretrained
from dcg_torch.types import Percept


def _told(scenes: int = 60) -> Iterator[tuple[str, Percept, list[Percept], tuple[Percept, ...]]]:
    """A command, what it means, what its words describe as well, and all that is there."""
    rng = np.random.default_rng(1)
    for _ in range(scenes):
        scene = stack_scene(rng)
        for text, ids in scene.commands:
            (meant,) = [o for o in scene.objects if o.id in ids]
            yield (
                text,
                meant,
                [o for o in scene.objects if (o.type, o.color) == (meant.type, meant.color)],
                scene.objects,
            )


def test_what_is_taken_is_the_only_one_that_nothing_lies_on() -> None:
    def top(one: Percept, things: tuple[Percept, ...]) -> bool:
        return one.position[2] == max(
            o.position[2] for o in things if o.position[:2] == one.position[:2] and not o.attributes
        )

    taken = [found for found in _told() if not found[1].attributes]
    assert len(taken) > 50
    for _, meant, alike, things in taken:
        assert [o for o in alike if not o.attributes and top(o, things)] == [meant]
        assert len(alike) > 1


def test_what_is_put_down_is_held() -> None:
    put = [found for found in _told() if found[0].startswith(("drop", "release", "put down", "set down"))]
    assert len(put) > 10
    for text, meant, alike, _ in put:
        assert meant.attributes == {"held"}, text
        assert sum("held" in o.attributes for o in alike) == 1


def test_the_words_name_the_thing_and_the_goal_is_no_part_of_it() -> None:
    parse = default_parser().parse
    for text, meant, _, _ in _told(20):
        tree = parse(text, ("cube", "sphere", "cylinder")).tree
        assert tree is not None
        noun = tree.children[0]
        assert (noun.phrase.color, noun.phrase.noun) == (meant.color, meant.type)
        assert not noun.children


@pytest.mark.parametrize("state", ["covered", "held"])
def test_lessons_teach_what_a_hand_does_and_words_do_not(state: str) -> None:
    features = pretrained().features
    assert Group.RELATION in features.groups
    cell = features.language["context: object of take"], features.grounding[f"state: {state}"]
    assert taught_mask(features)[cell]
    assert not believed_mask(features)[cell]
    for other in ("clear", "alone"):
        assert not taught_mask(features)[cell[0], features.grounding[f"state: {other}"]]
