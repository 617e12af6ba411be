"""Short ways to make the values that the tests of the model's rooms hand around, and strategies that draw them."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
import torch
from hypothesis import strategies as st
from oracle import Oracle

from dcg_torch.fitting.psi import LogLinearFactor
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.features import FeatureSet, Group
from dcg_torch.learning.commit_first import CommitFirst
from dcg_torch.learning.word_posterior import WordPosterior
from dcg_torch.model import GroundingModel
from dcg_torch.simulator import FakeRobot
from dcg_torch.types import (
    Child,
    Correspondence,
    DriveResult,
    Example,
    Object,
    ParseTree,
    Percept,
    Phrase,
    PhraseKind,
    Symbol,
    WorldModel,
)
from dcg_torch.world.files import RobotStart, World, WorldObject

KNOWN = ("cube", "sphere", "cylinder")
NOVEL = ("fire hydrant", "drill", "mailbox", "door handle", "traffic cone")
COLORS = ("red", "green", "blue")

VARIANTS = {
    "dcg": frozenset({Group.DCG}),
    "dcg_upup": frozenset({Group.DCG, Group.UNKNOWN}),
    "dcg_upup_away": frozenset({Group.DCG, Group.UNKNOWN, Group.HYPOTHETICAL}),
    "dcg_upup_away_color": frozenset({Group.DCG, Group.UNKNOWN, Group.HYPOTHETICAL, Group.COLOR}),
}


def noun_phrase(noun: str | None, color: str | None = None, words: tuple[str, ...] = ()) -> Phrase:
    return Phrase(PhraseKind.NOUN, noun or "one", words, noun=noun, color=color)


def verb_phrase(*words: str) -> Phrase:
    return Phrase(PhraseKind.VERB, " ".join(words), words)


def preposition_phrase(word: str) -> Phrase:
    return Phrase(PhraseKind.PREPOSITION, word, (word,))


def command_tree(
    noun: str | None, color: str | None = None, *, verb: tuple[str, ...] = ("go",), preposition: str | None = "to"
) -> ParseTree:
    """The tree of "go to the red cube"."""
    below = ParseTree(noun_phrase(noun, color))
    if preposition is not None:
        below = ParseTree(preposition_phrase(preposition), (below,))
    return ParseTree(verb_phrase(*verb), (below,))


def percept(text: str, at: tuple[float, float] = (2.0, 0.0), *, name: str | None = None) -> Percept:
    """A percept from "red fire hydrant"."""
    color, _, kind = text.partition(" ")
    return Percept(name or text, kind, color, (*at, 0.0))


def world_file(*objects: tuple[str, float, float], name: str = "made") -> World:
    """A world with the robot at the origin, looking along +x, from ("red cube", x, y) triples."""
    return World(
        name=name,
        robot=RobotStart(),
        objects=tuple(
            WorldObject(id=text.replace(" ", "_"), type=text.partition(" ")[2], color=text.split()[0], position=(x, y))
            for text, x, y in objects
        ),
    )


def saw(model: GroundingModel, *texts: str) -> WorldModel:
    """What `model` makes of seeing the objects named, in this order."""
    return model.world_model([percept(t, name=f"{k} {t}") for k, t in enumerate(texts)])


@dataclass(frozen=True)
class Read:
    """A command that has been read, without a parser."""

    tree: ParseTree | None
    problem: str | None = None
    text: str = ""
    log_weight: float = 0.0
    rules: tuple[str, ...] = ()

    @property
    def readings(self) -> Sequence[Any]:
        return () if self.tree is None else (self,)

    @property
    def noun(self) -> str | None:
        return None if self.tree is None else [t.phrase.noun for t in self.tree.walk()][-1]

    @property
    def color(self) -> str | None:
        return None if self.tree is None else [t.phrase.color for t in self.tree.walk()][-1]


def read(text: str, vocabulary: Collection[str] = ()) -> Read:
    """ "red, fire hydrant" as "go to the red fire hydrant"."""
    color, _, noun = text.rpartition(", ")
    return Read(command_tree(noun, color or None))


class SpyRobot(FakeRobot):
    """Notes what it is told."""

    def __init__(self) -> None:
        super().__init__()
        self.told: list[str] = []

    def spin(self, angle: float) -> None:
        self.told.append("spin")
        super().spin(angle)

    def drive_to(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        self.told.append(f"drive to {target}")
        return DriveResult.ARRIVED

    def drive_away(self, target: str, percepts: Sequence[Percept]) -> DriveResult:
        self.told.append(f"drive away from {target}")
        return DriveResult.ARRIVED


def chosen(model: GroundingModel, tree: ParseTree, world: WorldModel) -> Object:
    obj = model.ground(tree, world).object
    assert obj is not None
    return obj


def memory(model: GroundingModel) -> CommitFirst:
    """A model's learner, where it is the paper's."""
    assert isinstance(model.learner, CommitFirst)
    return model.learner


def words_of(model: GroundingModel) -> WordPosterior:
    """A model's learner, where it holds a posterior over words."""
    assert isinstance(model.learner, WordPosterior)
    return model.learner


def log_psi(
    features: FeatureSet, model: LogLinearFactor, phrase: Phrase, world: WorldModel, children: tuple[Child, ...] = ()
) -> torch.Tensor:
    """(len(world.objects), P): the factors of one phrase under one tuple of child groundings."""
    rows = WorldEncoder(features, world).bag(Example(phrase, world, (), children))
    return model.log_psi(features.encode_phrases([phrase]), rows, np.zeros(len(rows), dtype=np.int64))


@dataclass(frozen=True)
class Pair:
    """One model, twice: as the project computes it and as the oracle does."""

    features: FeatureSet
    model: LogLinearFactor
    oracle: Oracle


def random_pair(
    groups: Collection[Group],
    correspondences: tuple[Correspondence, ...],
    seed: int,
    *,
    nouns: Mapping[str, str],
    colors: Iterable[str],
    phrases: Sequence[Phrase],
) -> Pair:
    """A model that knows `nouns` (word -> type), `colors` and the words of `phrases`, with random weights."""
    colors = tuple(colors)
    nothing = WorldModel(())
    features = FeatureSet.initial(
        groups, [Symbol(w, t) for w, t in nouns.items()], colors, [Example(p, nothing, ()) for p in phrases]
    )
    model = LogLinearFactor(features.pairs, correspondences)
    draw, pairs = random.Random(seed), features.pairs
    weight = {}
    for p, phi in enumerate(correspondences):
        for left, l in features.language.items():  # noqa: E741
            for right, g in features.grounding.items():
                if pairs[l, g]:
                    weight[phi, left, right] = draw.gauss(0.0, 1.5)
                    model.weight[p, l, g] = weight[phi, left, right]
    oracle = Oracle(
        groups=frozenset(groups),
        correspondences=correspondences,
        nouns=frozenset(nouns),
        types=frozenset(nouns.values()),
        colors=frozenset(colors),
        words=frozenset((p.kind, w) for p in phrases for w in p.words),
        weight=weight,
    )
    return Pair(features, model, oracle)


# What a drawn model may know. "wug" and "teal" are never among it; "orange" is a noun as well as a colour.
LEXICON = {"cube": "cube", "block": "cube", "cone": "cone", "orange": "orange"}
SHADES = ("red", "orange")
TRAINED = (verb_phrase("go"), verb_phrase("go", "not"), preposition_phrase("to"), noun_phrase("cube", None, ("big",)))


def objects(number: int) -> st.SearchStrategy[Object]:
    """Object number `number` of a world: of any of the four kinds, known or not, seen or not."""

    def make(kind: str, known: bool, hypothetical: bool, color: str | None) -> Object:
        unnamed = hypothetical and not known
        return Object(f"o{number}", None if unnamed else kind, known, hypothetical, color)

    kinds = st.sampled_from(["cube", "cone", "drill"])
    return st.builds(make, kinds, st.booleans(), st.booleans(), st.sampled_from([None, "red", "orange", "teal"]))


def worlds(largest: int, smallest: int = 1) -> st.SearchStrategy[WorldModel]:
    sizes = st.integers(smallest, largest)
    return sizes.flatmap(lambda n: st.tuples(*(objects(k) for k in range(n))).map(WorldModel))


nouns = st.builds(
    noun_phrase,
    st.sampled_from([None, "cube", "block", "orange", "wug"]),
    st.sampled_from([None, "red", "orange", "teal"]),
    st.sampled_from([(), ("big",), ("big", "big"), ("cube",), ("shiny", "red")]),
)
verbs = st.sampled_from([("go",), ("go", "not"), ("go", "go"), ("dance",), ()]).map(lambda words: verb_phrase(*words))
prepositions = st.sampled_from(["to", "beyond"]).map(preposition_phrase)

noun_trees = nouns.map(ParseTree)
preposition_trees = st.builds(ParseTree, prepositions, st.tuples(noun_trees))
chains = st.one_of(
    noun_trees,
    preposition_trees,
    st.builds(ParseTree, verbs, st.tuples(noun_trees)),
    st.builds(ParseTree, verbs, st.tuples(preposition_trees)),
)
trees = st.one_of(
    chains,
    st.builds(ParseTree, verbs, st.tuples(noun_trees, noun_trees)),
    st.builds(ParseTree, verbs, st.tuples(noun_trees, preposition_trees)),
)


def typed(
    capsys: pytest.CaptureFixture[str], main: Callable[[], int], program: str, *arguments: str
) -> tuple[int, str, str]:
    """A command line in this process: exit status, what it printed, its complaints."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", [program, *arguments])
        try:
            status = main()
        except SystemExit as leaving:
            status = leaving.code if isinstance(leaving.code, int) else 1
    printed = capsys.readouterr()
    return status, printed.out, printed.err
