"""Words learned from summed evidence: new nouns, further names, new colours; a corpus that outlives growth."""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dcg_torch.model.checkpoint import load, save
from dcg_torch.explanation import rivalry
from dcg_torch.grounding.encode import encode
from dcg_torch.grounding.features import Group
from dcg_torch.grounding.fit import objective_at
from dcg_torch.grounding.graph import FactorGraph
from dcg_torch.grounding.psi import BINARY, LogLinearFactor
from dcg_torch.grounding.statistics import CorpusEncoder
from dcg_torch.learning.commit_first import replace_unknown
from dcg_torch.lexical import LexicalModel
from dcg_torch.model import TrainingSet, Variant
from dcg_torch.relational import grouped
from dcg_torch.supervised import Lesson, teach
from dcg_torch.types import (
    Correspondence,
    Example,
    Object,
    ParseTree,
    Percept,
    Phrase,
    PhraseKind,
    Symbol,
    WorldModel,
)

VARIANT = Variant(groups=frozenset(Group) - {Group.OPEN}, hypothetical=False, ternary=False, l2=0.2, synonyms=0.8)
Thing = tuple[str, str | None]
"""Type and colour of an object."""


def take(noun: str | None, color: str | None = None, *below: ParseTree) -> ParseTree:
    said = ParseTree(Phrase(PhraseKind.NOUN, " ".join(filter(None, (color, noun))), noun=noun, color=color), below)
    return ParseTree(Phrase(PhraseKind.VERB, "take", ("take",)), (said,))


def on(noun: str, color: str | None = None) -> ParseTree:
    landmark = ParseTree(Phrase(PhraseKind.NOUN, noun, noun=noun, color=color))
    return ParseTree(Phrase(PhraseKind.PREPOSITION, "on", ("on",)), (landmark,))


def seen(model: LexicalModel, *things: Thing) -> WorldModel:
    percepts = [Percept(f"{k}", t, c, (2.0 * k + 1.0, 0.5 * k, 0.0)) for k, (t, c) in enumerate(things)]
    return model.world_model(percepts)


def lessons(model: LexicalModel) -> list[Lesson]:
    """Cubes of three colours among prisms of two others, said by noun and colour; some stand on a "wedge"."""
    rng = np.random.default_rng(5)
    found = []
    for k in range(60):
        colors = ["red", "green", "blue"]
        rng.shuffle(colors)
        things: list[Thing] = [*(("cube", c) for c in colors), ("prism", "c7"), ("prism", "c8"), ("prism", colors[0])]
        world = seen(model, *things)
        if k % 3 == 0:  # a prism as a landmark: a noun and a type that stay unknown
            base = world.objects[3]
            assert base.position is not None
            x, y, _ = base.position
            top = replace(world.objects[0], position=(x, y, 1.0))
            world = replace(world, objects=(top, *world.objects[1:]))
            found.append(Lesson(take("cube", None, on("wedge")), world, frozenset({"0"})))
        else:
            found.append(Lesson(take("cube" if k % 2 else "box", colors[1]), world, frozenset({"1"})))
    return found


@pytest.fixture(scope="module")
def schooled(training: TrainingSet) -> LexicalModel:
    model = LexicalModel.trained(training, VARIANT)
    nouns = {"cube": {"cube": 30}, "box": {"cube": 30}}
    model.taught(["cube"], nouns, {c: {c: 10} for c in ("red", "green", "blue")})
    teach(model, lessons(model), known_types=["cube"], known_colors=["red", "green", "blue"], rounds=2)
    return model


@pytest.fixture
def pupil_of(schooled: LexicalModel) -> Callable[[], LexicalModel]:
    return lambda: copy.deepcopy(schooled)


def hear(model: LexicalModel, tree: ParseTree, *things: Thing) -> tuple[Symbol | None, Object | None]:
    solution = model.ground(tree, seen(model, *things))
    return model.learn(solution), solution.object


def test_an_unknown_noun_means_the_unknown_type_and_becomes_its_name(pupil_of: Callable[[], LexicalModel]) -> None:
    model = pupil_of()
    things: list[Thing] = [("cube", "red"), ("prism", "blue"), ("cube", "green")]
    symbol, meant = hear(model, take("pyramid"), *things)
    assert meant is not None
    assert meant.type == "prism"
    assert symbol == Symbol("pyramid", "prism")
    # Now it is known: it is meant among further things of a type that was never met.
    world = seen(model, ("cone", "red"), ("prism", "blue"), ("cube", "green"))
    found = model.ground(take("pyramid"), world).object
    assert found is not None
    assert found.type == "prism"


def test_a_further_noun_for_a_known_type_becomes_its_name(pupil_of: Callable[[], LexicalModel]) -> None:
    """No type is unknown; the colours say what is meant, never the same one."""
    model = pupil_of()
    for color in ("red", "green", "blue"):
        hear(model, take("pyramid", color), ("cube", "red"), ("cube", "green"), ("cube", "blue"), ("prism", color))
    for color in ("red", "green", "blue"):
        others: list[Thing] = [("prism", c) for c in ("red", "green", "blue") if c != color]
        hear(model, take("brick", color), ("cube", color), *others)
    assert model.symbols["brick"].type == "cube"
    found = model.ground(take("brick"), seen(model, ("prism", "red"), ("cube", "blue"))).object
    assert found is not None
    assert found.type == "cube"


def test_what_the_rest_of_a_command_does_not_tell_teaches_nothing(pupil_of: Callable[[], LexicalModel]) -> None:
    """All types have names, and the command says nothing but the new word."""
    model = pupil_of()
    hear(model, take("pyramid", "red"), ("prism", "red"), ("cube", "green"))
    for _ in range(5):
        symbol, _ = hear(model, take("gizmo"), ("cube", "red"), ("prism", "red"))
        assert symbol is None
    assert "gizmo" not in model.symbols


def test_a_wrong_lesson_is_outweighed(pupil_of: Callable[[], LexicalModel]) -> None:
    model = pupil_of()
    symbol, _ = hear(model, take("pyramid", "red"), ("cube", "red"), ("prism", "c7"))  # a slip of the tongue
    wrong = symbol is not None and symbol.type == "cube"
    for color in ("red", "green", "blue"):
        others: list[Thing] = [("cube", c) for c in ("red", "green", "blue") if c != color]
        hear(model, take("pyramid", color), ("prism", color), *others)
    assert model.symbols["pyramid"].type == "prism"
    found = model.ground(take("pyramid"), seen(model, ("cube", "red"), ("prism", "blue"))).object
    assert found is not None
    assert found.type == "prism"
    assert wrong or model.words.nouns.posterior.best("pyramid")[1] > 0.8


def test_no_lesson_rests_on_itself(pupil_of: Callable[[], LexicalModel]) -> None:
    """However much a word is believed to mean a type already, a command is the same evidence."""
    model = pupil_of()
    hear(model, take("pyramid", "red"), ("prism", "red"), ("cube", "green"))
    world = seen(model, ("prism", "green"), ("cube", "green"), ("cube", "red"))
    solution = model.ground(take("pyramid", "green"), world)
    told = []
    for strength in (1.0, -3.0):
        model.factor.weight[:, model.features.language["noun: pyramid"]] *= strength
        model.words = replace(model.words, nouns=model.words.nouns.forget("pyramid"))
        model._hear(solution)
        told.append(dict(model.words.nouns.heard["pyramid"].more))
    assert told[0] == pytest.approx(told[1], rel=1e-12)


def test_a_new_colour_word_is_learned_from_a_colour_never_named(pupil_of: Callable[[], LexicalModel]) -> None:
    model = pupil_of()
    things: list[Thing] = [("cube", "red"), ("cube", "c7"), ("cube", "blue")]
    _, meant = hear(model, take("cube", "crimson"), *things)
    assert meant is not None
    assert meant.color == "c7"  # an unknown word meets an unknown colour
    assert model.words.color_words["crimson"] == "c7"
    found = model.ground(take("cube", "crimson"), seen(model, ("cube", "c8"), ("cube", "c7"), ("cube", "red"))).object
    assert found is not None
    assert found.color == "c7"


def test_a_further_word_for_a_known_colour(pupil_of: Callable[[], LexicalModel]) -> None:
    """Every colour in view has a name; the nouns say what is meant."""
    model = pupil_of()
    for k in range(4):
        others: list[Thing] = [("cube", "green"), ("prism", "blue"), ("prism", "green")]
        hear(model, take("cube", "scarlet"), ("cube", "red"), others[k % 3], ("prism", "blue"))
    assert model.words.color_words["scarlet"] == "red"


def test_a_rare_word_of_the_corpus_can_be_outweighed_and_a_common_one_not(training: TrainingSet) -> None:
    model = LexicalModel.trained(training, VARIANT)
    model.taught(["cube"], {"cube": {"cube": 9}, "crate": {"cube": 1}}, {"pink": {"yellow": 1}, "navy": {"blue": 9}})
    model.train()
    assert set(model.words.colors.settled) >= {"navy", "red"}
    for _ in range(3):
        hear(model, take("cube", "pink"), ("cube", "magenta"), ("cylinder", "yellow"))
        hear(model, take("cube", "navy"), ("cube", "magenta"), ("cylinder", "blue"))
    assert model.words.color_words["pink"] == "magenta"
    assert "navy" not in model.words.color_words


def test_growth_leaves_every_probability_as_it_was(schooled: LexicalModel) -> None:
    model = copy.deepcopy(schooled)
    world = seen(model, ("cube", "red"), ("cube", "blue"), ("cylinder", "green"), ("prism", "c7"))
    trees = [take("cube", "red"), take(None, "blue"), take("cylinder"), take("gizmo", "crimson")]
    before = [model.ground(tree, world).probabilities for tree in trees]
    features = model.features.grow(Symbol("pyramid", "prism")).name_color("mauve", "c9")
    assert features.shape > model.features.shape
    model.features = features
    model.factor.grow(features.pairs)
    assert [model.ground(tree, world).probabilities for tree in trees] == before


def test_statistics_say_what_the_examples_say_whatever_is_known(schooled: LexicalModel) -> None:
    """Against encoding all examples anew: value and gradient, with nothing, a type, a noun and a colour learned."""
    features, known = schooled.features, list(schooled.known_types)
    statistics = CorpusEncoder().statistics(schooled.corpus, features, BINARY)
    steps = [
        (features, known),
        (features.grow(Symbol("pyramid", "prism")), [*known, "prism"]),
        (features.grow(Symbol("wedge", "prism")).name_color("mauve", "c7"), [*known, "prism"]),
    ]
    rng = np.random.default_rng(2)
    values = []
    for grown, types in steps:
        factor = LogLinearFactor(grown.pairs, BINARY)
        factor.set_weight(rng.normal(size=(2, *grown.shape)) * grown.pairs)
        anew = encode(replace_unknown(schooled.corpus, types), grown, BINARY)
        expected, slope = objective_at(factor, anew, 0.2)
        value, gradient = objective_at(factor, statistics.under(grown, types), 0.2)
        assert value == pytest.approx(expected, rel=1e-12)
        assert gradient == pytest.approx(slope, abs=1e-8)
        values.append(value)
    assert len(set(values)) == 3


def test_a_feature_that_two_unknown_colours_share_fires_once(schooled: LexicalModel) -> None:
    """A row of three colours without a name, as a thing that a phrase may mean."""
    percepts = [Percept(f"{k}", "cube", c, (2.0, float(k), 0.0)) for k, c in enumerate(("c7", "c8", "c9"))]
    tree = take("row")
    world = grouped(schooled.world_model(percepts), tree)
    assert world.groups
    phrase = tree.children[0].phrase
    example = Example(phrase, world, tuple(Correspondence.ACTIVE for _ in world.meanable))
    features = schooled.features
    factor = LogLinearFactor(features.pairs, BINARY)
    factor.set_weight(np.stack([-0.3 * features.pairs, 1.0 * features.pairs]))
    anew, _ = objective_at(factor, encode([example], features, BINARY), 0.2)
    designs = CorpusEncoder().statistics([example], features, BINARY).under(features, schooled.known_types)
    assert objective_at(factor, designs, 0.2)[0] == pytest.approx(anew, rel=1e-12)


def test_statistics_are_the_same_however_often_they_are_made(schooled: LexicalModel) -> None:
    reader = CorpusEncoder()
    first = reader.statistics(schooled.corpus[:40], schooled.features, BINARY)
    reader.statistics(schooled.corpus, schooled.features, BINARY)
    again = reader.statistics(schooled.corpus[:40], schooled.features, BINARY)
    factor = LogLinearFactor(schooled.features.pairs, BINARY)
    factor.set_weight(np.random.default_rng(1).normal(size=factor.weight.shape) * schooled.features.pairs)
    values = [objective_at(factor, s.under(schooled.features, schooled.known_types), 0.2)[0] for s in (first, again)]
    assert values[0] == pytest.approx(values[1], rel=1e-12)


def test_learning_follows_the_optimum(pupil_of: Callable[[], LexicalModel]) -> None:
    """Ten steps a command, against a fit of everything from nothing: within 0.005 of every probability."""
    model = pupil_of()
    rng = np.random.default_rng(8)
    colors = ["red", "green", "blue", "c7", "c8"]
    words = {"red": "red", "green": "green", "blue": "blue", "c7": "crimson", "c8": "beige"}
    for k in range(40):
        rng.shuffle(colors)
        noun = ("pyramid", "cube", "tetrahedron", "brick")[k % 4]
        own = "prism" if noun in ("pyramid", "tetrahedron") else "cube"
        things: list[Thing] = [(own, colors[0]), ("cube", colors[1]), ("prism", colors[2])]
        model.learn(model.ground(take(noun, words[colors[0]]), seen(model, *things)), max_steps=10)
    trees = [take(n, c) for n in ("pyramid", "cube", "brick", None) for c in (None, "red", "crimson", "beige")]
    world = seen(model, ("cube", "red"), ("prism", "c7"), ("prism", "c8"), ("cube", "c7"), ("prism", "red"))
    followed = [model.ground(tree, world).probabilities for tree in trees]
    model.factor = LogLinearFactor(model.features.pairs, BINARY)
    assert model.train(max_steps=3000).status == "converged"
    for tree, was in zip(trees, followed, strict=True):
        assert model.ground(tree, world).probabilities == pytest.approx(was, abs=0.005)


def test_a_saved_model_grounds_and_learns_as_it_did(pupil_of: Callable[[], LexicalModel], tmp_path: Path) -> None:
    model = pupil_of()
    hear(model, take("pyramid", "red"), ("prism", "red"), ("cube", "green"))
    save(model, tmp_path)
    restored = load(tmp_path)
    assert isinstance(restored, LexicalModel)
    things: Sequence[Thing] = [("cube", "red"), ("prism", "c7"), ("cube", "blue")]
    for tree in (take("pyramid"), take("cube", "red"), take(None, "crimson")):
        worlds = (seen(model, *things), seen(restored, *things))
        assert worlds[0] == worlds[1]
        assert model.ground(tree, worlds[0]).probabilities == restored.ground(tree, worlds[1]).probabilities
    for one in (model, restored):
        hear(one, take("pyramid", "crimson"), *things)
        one.train(max_steps=2000)
    assert restored.symbols == model.symbols
    assert restored.words.color_words == model.words.color_words == {"crimson": "c7"}
    tree, world = take("pyramid", "crimson"), seen(model, *things)
    assert restored.ground(tree, world).probabilities == pytest.approx(
        model.ground(tree, world).probabilities, abs=1e-5
    )


def test_the_second_best_is_told_apart_by_what_differs(schooled: LexicalModel) -> None:
    """For a bare noun phrase the reasons add up to the difference of the two objects' log-odds."""
    world = seen(schooled, ("cube", "red"), ("cube", "blue"), ("prism", "c7"))
    noun = take("cube", "red").children[0]
    noun = schooled.readable(noun)
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
    model = LexicalModel.trained(training, VARIANT)
    model.taught(["cube"])
    rng = np.random.default_rng(3)

    def scene() -> WorldModel:
        materials = ["wood", "steel"]
        places = rng.uniform(1.0, 6.0, size=(2, 2)).tolist()
        return model.world_model(
            [
                Percept(m, "cube", "red", (x, y, 0.0), attributes=frozenset({f"material: {m}"}))
                for m, (x, y) in zip(materials, places, strict=True)
            ]
        )

    def said(word: str) -> ParseTree:
        noun = ParseTree(Phrase(PhraseKind.NOUN, f"{word} cube", (word,), "cube"))
        return ParseTree(Phrase(PhraseKind.VERB, "take", ("take",)), (noun,))

    words = {"wooden": "wood", "metal": "steel"}
    told = [Lesson(said(w), scene(), frozenset({m})) for w, m in words.items() for _ in range(15)]
    teach(model, told, rounds=1)
    assert "state: material: wood" in model.features.grounding
    for word, material in words.items():
        for _ in range(5):
            found = model.ground(said(word), scene()).object
            assert found is not None
            assert found.id == material
