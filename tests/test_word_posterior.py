"""Words learned after a corpus: new nouns, further names, new colours, attributes; what was taught stays."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from making import words_of

from dcg_torch.grounding.explanation import rivalry
from dcg_torch.grounding.features import PAPER, Group
from dcg_torch.grounding.graph import FactorGraph
from dcg_torch.interpretation.factor_tree import to_factor_tree
from dcg_torch.learning.landmarks import Lesson
from dcg_torch.learning.word_posterior import WordPosterior
from dcg_torch.model import Experience, GroundingModel, Learned, TrainingSet, Variant
from dcg_torch.model.checkpoint import load, save
from dcg_torch.types import Object, ParseTree, Percept, Phrase, PhraseKind, Symbol, WorldModel

VARIANT = Variant(groups=PAPER | {Group.OPEN, Group.RELATION}, hypothetical=False, ternary=False, l2=0.2)
Thing = tuple[str, str | None]
"""Type and colour of an object."""
Pupil = Callable[[], GroundingModel]


def take(noun: str | None, color: str | None = None, *below: ParseTree) -> ParseTree:
    said = ParseTree(Phrase(PhraseKind.NOUN, " ".join(filter(None, (color, noun))), noun=noun, color=color), below)
    return ParseTree(Phrase(PhraseKind.VERB, "take", ("take",)), (said,))


def seen(model: GroundingModel, *things: Thing) -> WorldModel:
    percepts = [Percept(f"{k}", t, c, (2.0 * k + 1.0, 0.5 * k, 0.0)) for k, (t, c) in enumerate(things)]
    return model.world_model(percepts, looked=True)


def lessons(model: GroundingModel) -> list[Lesson]:
    """Cubes of three colours among prisms, said by noun and colour: by "cube", and as often by "box"."""
    rng = np.random.default_rng(5)
    found = []
    for k in range(60):
        colors = ["red", "green", "blue"]
        rng.shuffle(colors)
        things: list[Thing] = [*(("cube", c) for c in colors), ("prism", "c7"), ("prism", "c8"), ("prism", colors[0])]
        found.append(Lesson(take("cube" if k % 2 else "box", colors[1]), seen(model, *things), frozenset({"1"})))
    return found


@pytest.fixture(scope="module")
def schooled(training: TrainingSet) -> GroundingModel:
    model = GroundingModel.trained(training, VARIANT, WordPosterior.start(training))
    model.teach(lessons(model), known_types=["cube"], known_colors=["red", "green", "blue"], rounds=2)
    return model


@pytest.fixture
def pupil_of(schooled: GroundingModel) -> Pupil:
    return lambda: copy.deepcopy(schooled)


def color_of(model: GroundingModel, word: str) -> str:
    return words_of(model).colors.posterior.best(word)[0]


def hear(model: GroundingModel, tree: ParseTree, *things: Thing) -> tuple[Learned, Object | None]:
    solution = model.ground(tree, seen(model, *things))
    return model.learn(solution, Experience(looked=True)), solution.object


def meant(model: GroundingModel, tree: ParseTree, *things: Thing) -> Object:
    found = model.ground(tree, seen(model, *things)).object
    assert found is not None
    return found


def test_lessons_settle_what_they_say_often(schooled: GroundingModel) -> None:
    assert {word: s.type for word, s in schooled.symbols.items() if word in ("cube", "box")} == {
        "cube": "cube",
        "box": "cube",
    }
    for noun in ("cube", "box"):
        assert meant(schooled, take(noun, "red"), ("prism", "red"), ("cube", "blue"), ("cube", "red")).id == "2"


def test_an_unknown_noun_means_the_unknown_type_and_becomes_its_name(pupil_of: Pupil) -> None:
    model = pupil_of()
    things: list[Thing] = [("cube", "red"), ("prism", "blue"), ("cube", "green")]
    learned, target = hear(model, take("pyramid"), *things)
    assert target is not None
    assert target.type == "prism"
    assert learned.symbol == Symbol("pyramid", "prism")
    # Now it is known: it is meant among further things of a type that was never met.
    assert meant(model, take("pyramid"), ("cone", "red"), ("prism", "blue"), ("cube", "green")).type == "prism"


def test_a_further_noun_for_a_known_type_becomes_its_name(pupil_of: Pupil) -> None:
    """No type is unknown; the colours say what is meant, never the same one."""
    model = pupil_of()
    for color in ("red", "green", "blue"):
        hear(model, take("pyramid", color), ("cube", "red"), ("cube", "green"), ("cube", "blue"), ("prism", color))
    for color in ("red", "green", "blue", "red"):
        others: list[Thing] = [("prism", c) for c in ("red", "green", "blue") if c != color]
        hear(model, take("brick", color), ("cube", color), *others)
    assert model.symbols["brick"].type == "cube"
    assert meant(model, take("brick"), ("prism", "red"), ("cube", "blue")).type == "cube"


def test_what_the_rest_of_a_command_does_not_tell_teaches_nothing(pupil_of: Pupil) -> None:
    """Both types have names, and the command says nothing but the new word."""
    model = pupil_of()
    model.learn(model.ground(take("cube"), seen(model, ("prism", "red"))))  # a prism is met
    model.correct("pyramid", "prism")
    assert model.symbols["pyramid"] == Symbol("pyramid", "prism")
    for _ in range(5):
        learned, _ = hear(model, take("gizmo"), ("cube", "red"), ("prism", "red"))
        assert learned.symbol is None
        assert learned.reason is not None
    beliefs = model.beliefs_of("gizmo")
    assert beliefs["cube"] == pytest.approx(beliefs["prism"])
    assert "gizmo" not in model.symbols


def test_a_wrong_lesson_is_outweighed(pupil_of: Pupil) -> None:
    model = pupil_of()
    for color in ("red", "green"):  # twice a slip of the tongue
        hear(model, take("pyramid", color), ("cube", color), ("prism", "c7"))
    assert model.beliefs_of("pyramid")["cube"] > 2 * model.beliefs_of("pyramid")["prism"]
    for color in ("red", "green", "blue") * 2:
        others: list[Thing] = [("cube", c) for c in ("red", "green", "blue") if c != color]
        hear(model, take("pyramid", color), ("prism", color), *others)
    assert model.symbols["pyramid"].type == "prism"
    assert meant(model, take("pyramid"), ("cube", "red"), ("prism", "blue")).type == "prism"


def test_no_lesson_rests_on_itself(pupil_of: Pupil) -> None:
    """However much a word is believed to mean a type already, a command is the same evidence."""
    told = []
    for strength in (1.0, -3.0):
        model = pupil_of()
        hear(model, take("pyramid", "red"), ("prism", "red"), ("cube", "green"))
        weight = model.factor.weight.numpy().copy()
        row = model.features.language["noun: pyramid"]
        assert np.abs(weight[:, row]).max() > 0.1
        weight[:, row] *= strength
        model.factor.set_weight(weight)
        model.learner = words_of(model).forget("pyramid")
        hear(model, take("pyramid", "green"), ("prism", "green"), ("cube", "green"), ("cube", "red"))
        told.append(dict(words_of(model).nouns.heard["pyramid"].more))
    assert told[0] == pytest.approx(told[1], rel=1e-12)


def test_a_new_colour_word_is_learned_from_a_colour_never_named(pupil_of: Pupil) -> None:
    model = pupil_of()
    _, target = hear(model, take("cube", "crimson"), ("cube", "red"), ("cube", "c7"), ("cube", "blue"))
    assert target is not None
    assert target.color == "c7"  # an unknown word meets an unknown colour
    assert color_of(model, "crimson") == "c7"
    assert meant(model, take("cube", "crimson"), ("cube", "c8"), ("cube", "c7"), ("cube", "red")).color == "c7"


def test_a_further_word_for_a_known_colour(pupil_of: Pupil) -> None:
    """Every colour in view has a name; the nouns say what is meant."""
    model = pupil_of()
    for k in range(6):
        others: list[Thing] = [("prism", "green"), ("prism", "blue"), ("prism", "green")]
        hear(model, take("cube", "scarlet"), ("cube", "red"), others[k % 3], ("prism", "blue"))
    assert color_of(model, "scarlet") == "red"
    assert meant(model, take("cube", "scarlet"), ("cube", "blue"), ("cube", "red")).color == "red"


def test_growth_leaves_every_probability_as_it_was(pupil_of: Pupil) -> None:
    model = pupil_of()
    world = seen(model, ("cube", "red"), ("cube", "blue"), ("cylinder", "green"), ("prism", "c7"))
    trees = [take("cube", "red"), take(None, "blue"), take("cylinder"), take("gizmo", "crimson")]
    before = [model.ground(tree, world).probabilities for tree in trees]
    features = model.features.grow(Symbol("pyramid", "wug")).include(colors=("mauve", "c9"))
    assert features.shape > model.features.shape
    model.grow(features)
    assert [model.ground(tree, world).probabilities for tree in trees] == before


def test_what_a_corpus_has_taught_is_held(pupil_of: Pupil) -> None:
    """A command about a new word moves its own weights and leaves those of the corpus, to the bit."""
    model = pupil_of()
    held, before = model.held.copy(), model.factor.weight.numpy().copy()
    assert held.any()
    hear(model, take("pyramid", "red"), ("prism", "red"), ("cube", "green"))
    rows, columns = held.shape
    after = model.factor.weight.numpy()
    assert (after[:, :rows, :columns][:, held] == before[:, held]).all()
    assert np.abs(after[:, model.features.language["noun: pyramid"]]).max() > 0.1


def test_a_saved_model_grounds_and_learns_as_it_did(pupil_of: Pupil, tmp_path: Path) -> None:
    model = pupil_of()
    hear(model, take("pyramid", "red"), ("prism", "red"), ("cube", "green"))
    save(model, tmp_path)
    restored = load(tmp_path)
    assert restored.learner == model.learner
    things: list[Thing] = [("cube", "red"), ("prism", "c7"), ("cube", "blue")]
    for tree in (take("pyramid"), take("cube", "red"), take(None, "crimson")):
        worlds = (seen(model, *things), seen(restored, *things))
        assert worlds[0] == worlds[1]
        assert model.ground(tree, worlds[0]).probabilities == restored.ground(tree, worlds[1]).probabilities
    for one in (model, restored):
        hear(one, take("pyramid", "crimson"), *things)
    assert restored.learner == model.learner
    assert color_of(restored, "crimson") == "c7"
    assert (restored.factor.weight == model.factor.weight).all()


def test_the_second_best_is_told_apart_by_what_differs(schooled: GroundingModel) -> None:
    """For a bare noun phrase the reasons add up to the difference of the two objects' log-odds."""
    world = seen(schooled, ("cube", "red"), ("cube", "blue"), ("prism", "c7"))
    noun = to_factor_tree(take("cube", "red").children[0])
    solution = FactorGraph(noun, world).solve(schooled.features, schooled.factor)
    second = rivalry(schooled, solution)
    assert second is not None
    assert second.object.color == "blue"
    assert {r.feature for r in second.reasons} >= {"color: red", "color: blue"}
    odds = np.log(solution.probabilities["0"]) - np.log(solution.probabilities["1"])
    assert second.log_odds == pytest.approx(odds, abs=1e-9)
    assert sum(r.log_odds for r in second.reasons) == pytest.approx(odds, abs=1e-9)


def test_attributes_that_are_met_become_features_that_words_are_learned_for(training: TrainingSet) -> None:
    """Two cubes that differ in a material alone; made up for this test."""
    model = GroundingModel.trained(training, VARIANT, WordPosterior.start(training))
    rng = np.random.default_rng(3)

    def scene() -> WorldModel:
        percepts = []
        for material, (x, y) in zip(("wood", "steel"), rng.uniform(1.0, 6.0, size=(2, 2)).tolist(), strict=True):
            cube = Percept(material, "cube", "red", (x, y, 0.0))
            percepts.append(replace(cube, attributes=frozenset({f"material: {material}"})))
        return model.world_model(percepts)

    def said(word: str) -> ParseTree:
        noun = ParseTree(Phrase(PhraseKind.NOUN, f"{word} cube", (word,), "cube"))
        return ParseTree(Phrase(PhraseKind.VERB, "take", ("take",)), (noun,))

    words = {"wooden": "wood", "metal": "steel"}
    told = [Lesson(said(w), scene(), frozenset({m})) for w, m in words.items() for _ in range(15)]
    model.teach(told, rounds=1)
    assert "state: material: wood" in model.features.grounding
    for word, material in words.items():
        found = [model.ground(said(word), scene()).object for _ in range(5)]
        assert [o.id for o in found if o is not None] == [material] * 5
