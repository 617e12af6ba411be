"""Looking before deciding: when, and where to."""

from __future__ import annotations

import math

import numpy as np
import pytest

from dcg_torch.agent.explore import LookBefore, Worth, in_sight, meanings_out_of_view, missing, next_place
from dcg_torch.grounding.solution import Solution
from dcg_torch.simulator import FakeRobot
from dcg_torch.types import Object, ParseTree, Percept, Phrase, PhraseKind, WorldModel
from dcg_torch.types.geometry import FIELD_OF_VIEW
from dcg_torch.world.files import World, WorldObject


def solution(**probabilities: float) -> Solution:
    """What was grounded: "cube" is a cube in view, "h_cube" an unseen one."""
    objects = tuple(
        Object(name, name.removeprefix("h_"), True, hypothetical=name.startswith("h_")) for name in probabilities
    )
    tree = ParseTree(Phrase(PhraseKind.NOUN, "zorp", noun="zorp"))
    return Solution(tree, WorldModel(objects), None, probabilities)


def test_what_is_believed_and_not_in_view() -> None:
    seen = solution(drill=0.5, h_drill=0.01, h_cone=0.4, h_cube=0.09)
    assert meanings_out_of_view(seen, {"drill": 0.6, "cone": 0.3, "cube": 0.1}, 0.2) == pytest.approx(0.3)
    assert missing(seen) == pytest.approx(0.5)


def test_an_object_of_another_colour_is_not_in_view() -> None:
    seen = solution(drill=0.001, h_drill=0.9)
    assert meanings_out_of_view(seen, {"drill": 1.0}, 0.01) == 1.0


def test_the_turns_cover_the_circle() -> None:
    assert LookBefore.STEP < FIELD_OF_VIEW
    assert math.tau < LookBefore.TURNS * LookBefore.STEP + FIELD_OF_VIEW


def test_seeing_all_round_sees_everything() -> None:
    things = tuple(
        WorldObject(id=str(k), type="cube", color="red", position=(2 * math.cos(a), 2 * math.sin(a)))
        for k, a in enumerate(np.linspace(0, 6.2, 40))
    )
    robot = FakeRobot()
    robot.load(World(name="ring", objects=things))
    seen = {p.id for p in robot.perceive()}
    for _ in range(LookBefore.TURNS):
        robot.spin(LookBefore.STEP)
        seen |= {p.id for p in robot.perceive()}
    assert seen == {o.id for o in things}


def test_a_disc_hides_what_is_behind_it() -> None:
    places, cells = np.array([[0.0, 0.0]]), np.array([[4.0, 0.0], [1.0, 0.0], [0.0, 4.0]])
    assert in_sight(places, cells, np.array([[2.0, 0.0]])).tolist() == [[False, True, True]]


def thing(x: float, y: float) -> Percept:
    return Percept(f"{x} {y}", "cube", "red", (x, y, 0.0))


def test_the_next_place_shows_what_was_hidden() -> None:
    wall = [thing(2.0, 0.25 * k) for k in range(-4, 5)] + [thing(5.0, 0.0)]
    place = next_place((0.0, 0.0), [(0.0, 0.0)], wall, 0.01)
    assert place is not None
    behind = np.array([[3.5, 0.0], [3.5, 0.5], [3.5, -0.5]])
    discs = np.array([p.position[:2] for p in wall])
    assert not in_sight(np.array([[0.0, 0.0]]), behind, discs).any()
    assert in_sight(np.array([place]), behind, discs).any()
    assert min(math.dist(place, p.position[:2]) for p in wall) > 0.5


def test_where_nothing_is_hidden_there_is_nowhere_to_go() -> None:
    assert next_place((0.0, 0.0), [(0.0, 0.0)], [], 0.01) is None


def settle(probabilities: dict[str, float], meanings: dict[str, float], worth: Worth | None = None) -> FakeRobot:
    """A robot after all moves that the explorer wants while the grounding stays as it is."""
    robot = FakeRobot()
    feet = {"a": (1.2, 0.0), "b": (6.0, 1.5)}
    robot.load(
        World(name="w", objects=tuple(WorldObject(id=k, type="cube", color="red", position=p) for k, p in feet.items()))
    )
    explorer = LookBefore(lambda _: meanings, worth or Worth())
    moves = 0
    percepts = [Percept(k, "cube", "red", (*p, 0.0)) for k, p in feet.items()]
    while explorer.move(_about_zorp(solution(**probabilities)), percepts, robot):
        moves += 1
        assert moves < 100
    return robot


def _about_zorp(of: Solution) -> Solution:
    from dcg_torch.grounding.hypotheses import Hypothesis
    from dcg_torch.types import Child, Grounding, GroundingKind

    assert of.tree is not None
    best = max(of.world.objects, key=lambda o: of.probabilities[o.id])
    child = Child(Grounding(GroundingKind.OBJECT, best))
    return Solution(of.tree, of.world, Hypothesis(of.tree, child, (), 0.0), of.probabilities)


def test_one_sure_candidate_needs_no_turn() -> None:
    assert settle({"cube": 0.95, "h_cube": 0.05}, {"cube": 1.0}).turned == 0.0


def test_a_rival_out_of_view_is_looked_for_once_round() -> None:
    robot = settle({"cube": 0.7, "h_cube": 0.1, "h_cone": 0.2}, {"cube": 0.5, "cone": 0.5})
    assert robot.turned == pytest.approx(LookBefore.TURNS * LookBefore.STEP)
    assert robot.path_length == 0.0


def test_the_missing_is_looked_for_behind_things_and_not_for_ever() -> None:
    robot = settle({"cube": 0.01, "h_cone": 0.99}, {"cone": 1.0})
    assert robot.path_length > 0.0
    assert robot.turned < 40.0
    assert settle({"cube": 0.01, "h_cone": 0.99}, {"cone": 1.0}, Worth(views=0)).path_length == 0.0
