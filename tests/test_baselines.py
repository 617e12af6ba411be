from __future__ import annotations

import importlib.util
from typing import Any

import numpy as np
import pytest

from dcg_torch.evaluation.baselines import BASELINES, Guess, make_baseline, run_baseline
from dcg_torch.evaluation.baselines.base import BaselineError, fit_temperature, probabilities
from dcg_torch.evaluation.baselines.learned import sides
from dcg_torch.evaluation.baselines.words import Outcomes, overlap
from dcg_torch.evaluation.episodes import Episode
from dcg_torch.names import embedding


def episode(text: str, things: str, target: str = "0", **keys: Any) -> Episode:
    """Things such as "red cube, blue ball" from near to far, with their places as ids; robot at the origin."""
    objects = []
    for k, thing in enumerate(things.split(", ")):
        color, _, name = thing.rpartition(" ")
        objects.append({"id": str(k), "type": name, "color": color or None, "position": (1.0 + k, 0.0, 0.0)})
    robot = {"x": 0.0, "y": 0.0}
    return Episode.model_validate(
        {"id": text, "text": text, "objects": objects, "target": tuple(target), "robot": robot, **keys}
    )


def guess(name: str, one: Episode) -> Guess:
    return make_baseline(name, lambda text: "").predict(one)


@pytest.mark.parametrize(
    ("text", "things", "chosen"),
    [
        ("take the lamp", "cube, lamp, ball", {"1"}),
        ("take the red cube", "blue cube, red cube, red ball", {"1"}),
        ("the grey box", "gray ball, gray cube, blue cube", {"1"}),
        ("the cube by the ball", "ball, cube", {"1"}),
        ("both cubes", "cube, ball, cube", {"0", "2"}),
        ("the three cubes", "cube, cube, ball, cube", {"0", "1", "3"}),
        ("the floor lamp", "table lamp, floor lamp", {"1"}),
    ],
)
def test_overlap(text: str, things: str, chosen: set[str]) -> None:
    assert set(guess("overlap", episode(text, things)).objects) == chosen


def test_overlap_says_how_many_are_equal() -> None:
    one, of = guess("overlap", episode("the cube", "cube, ball")), guess("overlap", episode("the cube", "cube, cube"))
    assert one.probability > 0.9
    assert of.probability == pytest.approx(0.5, abs=0.02)


def test_equals_are_not_always_the_first() -> None:
    chosen = {guess("overlap", episode("the cube", "cube, cube, cube", id=str(k))).objects for k in range(30)}
    assert chosen == {("0",), ("1",), ("2",)}


def test_nearest_is_the_nearest_of_those_named() -> None:
    assert guess("nearest", episode("the cube", "ball, cube, cube")).objects == ("1",)
    assert guess("nearest", episode("the cube", "ball, cube, cube", robot={"x": 9.0, "y": 0.0})).objects == ("2",)


def test_outcomes_learn_a_word_from_targets() -> None:
    """A word that no class has: it speaks for the type that it was said of."""
    baseline = make_baseline("outcomes", lambda text: "")
    baseline.fit([episode(f"take the wug {k}", "lamp, ball, cone", "1", id=str(k)) for k in range(6)])
    assert baseline.predict(episode("go to the wug", "cone, lamp, ball")).objects == ("2",)
    assert baseline.predict(episode("go to the cone", "cone, lamp, ball")).objects == ("0",)


def test_outcomes_learn_a_word_from_their_own_choices() -> None:
    baseline = Outcomes()
    for k in range(6):
        one = episode(f"take the wug {k}", "ball, ball", id=str(k))
        baseline.learn(one, Guess(("0",), 0.9))
        other = episode(f"take the blick {k}", "lamp, ball", id=f"other {k}")
        baseline.learn(other, Guess(("0",), 0.9))
    assert baseline.predict(episode("the blick", "ball, lamp")).objects == ("1",)


def test_the_overlap_of_a_text_without_names_is_none() -> None:
    assert not overlap(episode("go there", "red cube, lamp")).any()


def test_probabilities_are_one_together_and_never_zero() -> None:
    share = probabilities(np.array([0.0, 1000.0, 5.0]), 1.0)
    assert share.sum() == pytest.approx(1.0)
    assert share.min() > 0.0
    assert share.argmax() == 1


def test_a_temperature_is_high_where_scores_mislead() -> None:
    scores = np.array([1.0, 0.0, 0.0])
    right = fit_temperature([(scores, [0])] * 10, 1.0)
    wrong = fit_temperature([(scores, [k % 3]) for k in range(9)], 1.0)
    assert right < 1.0 < wrong
    assert fit_temperature([(scores, [])], 0.7) == 0.7


needs_sklearn = pytest.mark.skipif(importlib.util.find_spec("sklearn") is None, reason="scikit-learn is not installed")


@needs_sklearn
def test_bow_learns_what_words_name() -> None:
    baseline = make_baseline("bow", lambda text: "")
    both_ways = ("ball, cone", "01"), ("cone, ball", "10")
    said = [(word, things, places[k]) for things, places in both_ways for k, word in enumerate(("wug", "blick"))]
    baseline.fit([episode(f"the {word}", things, target) for word, things, target in said * 5])
    assert baseline.predict(episode("a wug", "cone, ball")).objects == ("1",)
    assert baseline.predict(episode("a blick", "cone, ball")).objects == ("0",)


@needs_sklearn
def test_bow_without_training_is_one_line() -> None:
    with pytest.raises(BaselineError, match="give train=FILE"):
        make_baseline("bow", lambda text: "").fit([])


@pytest.mark.slow
@pytest.mark.skipif(not embedding.is_installed(), reason="the extra `embeddings` is not installed")
def test_minilm_knows_near_words_and_colors() -> None:
    baseline = make_baseline("minilm", lambda text: text.removeprefix("take the "))
    assert baseline.predict(episode("take the couch", "lamp, sofa, fork")).objects == ("1",)
    assert baseline.predict(episode("take the blue cube", "red cube, blue cube")).objects == ("1",)
    baseline.fit([episode("take the couch", "lamp, sofa, fork", "1")])
    assert 0.5 < baseline.predict(episode("take the couch", "lamp, sofa, fork")).probability <= 1.0


def test_sides_are_seen_from_the_robot() -> None:
    places = [(1.0, 1.0), (1.0, -1.0), (3.0, 1.0), (3.0, -1.0), (2.0, 0.0)]
    objects = [{"id": str(k), "type": "cube", "position": (*p, 0.0)} for k, p in enumerate(places)]
    here = episode("x", "cube", objects=objects)
    assert sides(here) == ["on the near left", "on the near right", "on the far left", "on the far right", ""]
    turned = episode("x", "cube", objects=objects, robot={"x": 4.0, "y": 0.0, "yaw": np.pi})
    assert sides(turned) == ["on the far right", "on the far left", "on the near right", "on the near left", ""]


def test_a_strange_name_and_a_missing_extra_are_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(BaselineError, match="choose from overlap, nearest, outcomes, bow, minilm"):
        make_baseline("magic", lambda text: "")
    monkeypatch.setattr(embedding, "is_installed", lambda: False)
    with pytest.raises(BaselineError, match=r"install dcg-torch\[embeddings\]"):
        make_baseline("minilm", lambda text: "")
    monkeypatch.setitem(__import__("sys").modules, "sklearn.linear_model", None)
    with pytest.raises(BaselineError, match=r"install dcg-torch\[bench\]"):
        make_baseline("bow", lambda text: "")


@pytest.mark.parametrize("name", [name for name in BASELINES if name not in ("bow", "minilm")])
def test_no_baseline_looks_at_the_target(name: str) -> None:
    one, other = (episode("the red cube", "red cube, red cube, ball", target) for target in "01")
    assert guess(name, one) == guess(name, other)


def test_a_run_goes_through_the_files_in_order() -> None:
    test = {
        "a": [episode("the cube", "cube, ball", "0")],
        "b": [episode("the ball", "cube, ball", "0"), episode("the balls", "cube, ball, ball", "12")],
    }
    outcomes = run_baseline(make_baseline("overlap", lambda text: ""), [], test)
    assert [(o.file, o.correct) for o in outcomes] == [("a", True), ("b", False), ("b", True)]
