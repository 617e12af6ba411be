"""What is encoded of a world is kept from command to command: while the world is the same, and no longer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from making import command_tree, saw

from dcg_torch.grounding.encoders import Encoders
from dcg_torch.model import GroundingModel


def test_equal_worlds_share_what_is_encoded_and_others_do_not(pupil: Callable[[], GroundingModel]) -> None:
    model = pupil()
    encoders = Encoders(model.features)
    first = encoders.of(saw(model, "red cube", "blue cube"))
    assert encoders.of(saw(model, "blue cube")) is not first
    assert encoders.of(saw(model, "red cube", "blue cube")) is first
    assert Encoders(model.features).of(first.world) is not first


def test_a_world_where_few_can_be_meant_is_laid_out_once_with_the_whole(pupil: Callable[[], GroundingModel]) -> None:
    model = pupil()
    encoders, world = Encoders(model.features), saw(model, "red cube", "blue cube")
    where = encoders.of(world).layout
    few = replace(world, meant=frozenset({world.objects[0].id}))
    assert encoders.of(few).world.meant == few.meant
    assert encoders.of(few).layout is where
    assert encoders.of(world).world.meant is None


def test_beyond_so_many_things_what_is_old_is_forgotten(pupil: Callable[[], GroundingModel]) -> None:
    """Room for the things of one world: the next one takes all of it."""
    model = pupil()
    world, other = saw(model, "red cube", "blue cube"), saw(model, "red cube", "red sphere")
    encoders = Encoders(model.features, most=len(world.objects))
    first = encoders.of(world)
    assert encoders.of(world) is first
    encoders.of(other)
    assert encoders.of(world) is not first


def test_columns_that_a_lesson_adds_are_seen_in_a_world_of_before(pupil: Callable[[], GroundingModel]) -> None:
    model, taught = pupil(), pupil()
    world = saw(model, "red cube", "red drill")
    tree = command_tree("drill", "red")
    model.ground(tree, world)
    for one in (model, taught):
        assert one.learn(one.ground(tree, world)).symbol is not None
    assert model.ground(tree, world).probabilities == taught.ground(tree, world).probabilities
