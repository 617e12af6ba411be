"""Whose left is meant: one frame of reference for a command, with a probability that is learned."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import pytest

import dcg_torch
from dcg_torch import GroundingModel, Percept, Pose
from dcg_torch.grounding.frames import views
from dcg_torch.grounding.solution import Solution
from dcg_torch.learning.census import FrameCounts
from dcg_torch.learning.landmarks import Lesson
from dcg_torch.scene.frames import seen_by_speaker
from dcg_torch.scene.layout_making import layout
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import WorldModel

ROBOT, ACROSS = Pose(0.0, 0.0), Pose(6.0, 0.0)
THINGS = [Percept(f"{k}", "cube", "red", (3.0, 1.0 - k, 0.0)) for k in range(3)]  # 0 is at the robot's left


def _world(model: GroundingModel, speaker: Pose | None = ACROSS, things: Sequence[Percept] = THINGS) -> WorldModel:
    return model.world_model(things, robot=ROBOT, speaker=speaker, looked=True, workspace=Workspace())


def _with(model: GroundingModel, robot: float, speaker: float) -> GroundingModel:
    """The model after so many commands in the robot's and in the speaker's frame."""
    other = model.copy()
    other.learner = other.learner.with_frames(FrameCounts(robot, speaker))
    return other


def _meant(solution: Solution) -> str:
    assert solution.object is not None
    return solution.object.id


def test_across_the_table_left_is_right_and_far_is_near(model: GroundingModel) -> None:
    world = _world(model)
    other = seen_by_speaker(world)
    assert other is not None
    mine, theirs = layout(world), layout(other)
    there = [0, 1, 2]
    assert theirs.position[there, 1] == pytest.approx(-mine.position[there, 1])
    names = {place.id: place.attributes for place in other.places}
    assert names["place: left side edge"] == {"right side"}
    assert names["place: near side right side corner"] == {"far side", "left side"}
    assert names["place: left side of robot direction"] == {"left side", "of speaker"}  # they have changed places


def test_what_belongs_to_somebody_is_in_one_place_to_both_viewers(model: GroundingModel) -> None:
    world = _world(model, speaker=Pose(3.0, 5.0))
    other = seen_by_speaker(world)
    assert other is not None
    for side in ("left", "right"):
        at = next(j for j, o in enumerate(world.things) if o.id == f"place: {side} side of robot direction")
        one, two = layout(world), layout(other)
        ahead = [(where.position[:3, :2] - where.position[at, :2]) @ where.heading[at] for where in (one, two)]
        assert ahead[0] == pytest.approx(ahead[1])


def test_one_view_where_both_look_the_same_way(model: GroundingModel) -> None:
    for speaker in (None, ROBOT, Pose(-2.0, 0.5)):
        assert seen_by_speaker(_world(model, speaker)) is None


@pytest.mark.parametrize(
    ("text", "robots", "speakers"),
    [
        ("take the leftmost cube", "0", "2"),
        ("take the cube on the right", "2", "0"),
        ("take the cube on your right", "2", "2"),
        ("take the first cube from my left", "2", "2"),
    ],
)
def test_the_frame_that_speakers_use_decides(model: GroundingModel, text: str, robots: str, speakers: str) -> None:
    assert _meant(_with(model, 50.0, 1.0).ground(text, _world(model))) == robots
    assert _meant(_with(model, 1.0, 50.0).ground(text, _world(model))) == speakers


def test_an_open_frame_lowers_the_certainty(model: GroundingModel) -> None:
    sure, torn = (_with(model, n, 2.0).ground("take the leftmost cube", _world(model)) for n in (200.0, 2.0))
    assert sure.probability is not None
    assert torn.probability is not None
    assert torn.probability < 0.6 < sure.probability


def test_the_views_share_what_is_probable(model: GroundingModel) -> None:
    world = _world(model)
    for text in ("the left cube", "the cube on my left", "the cube on your left"):
        found = views(text, world, 0.3)
        assert sum(2.718281828459045**p for _, p in found) == pytest.approx(1.0)
    assert [views(t, world, 0.3)[1][1] for t in ("on my left", "on the left")] > [views("your left", world, 0.3)[1][1]]
    assert views("the left cube", world, None) == [(world, 0.0)]


def test_commands_tell_whose_frame_it_is(model: GroundingModel) -> None:
    """Only one of the cubes is to the right of the ball with the speaker's eyes, none with the robot's."""
    things = [
        Percept("a", "cube", "red", (3.0, 2.0, 0.0)),
        Percept("b", "ball", "blue", (3.0, -2.0, 0.0)),
    ]
    world, learner = _world(model, things=things), model.copy()
    shares = []
    for _ in range(3):
        solution = learner.ground("take the cube right of the ball", world)
        learner.learn(solution)
        assert learner.learner.frames is not None
        shares.append(learner.learner.frames.speakers)
    assert all(one < other for one, other in pairwise([FrameCounts().speakers, *shares]))


def test_lessons_tell_whose_frame_it_is(model: GroundingModel) -> None:
    taught = model.copy()
    parsed = dcg_torch.language.parse_command("take the leftmost cube")
    lessons = [Lesson(parsed.readings[0].tree, _world(model), frozenset({"2"})) for _ in range(6)]
    taught.teach(lessons, rounds=1)
    assert taught.learner.frames is not None
    assert taught.learner.frames.speakers > 0.6
    assert _meant(taught.ground("take the rightmost cube", _world(taught))) == "0"


def test_counts_are_kept_with_the_model(model: GroundingModel, tmp_path: object) -> None:
    counted = replace(FrameCounts(), speaker=7.5)
    other = model.copy()
    other.learner = other.learner.with_frames(counted)
    other.save(str(tmp_path))
    assert dcg_torch.load(str(tmp_path)).learner.frames == counted
