"""Training on commands whose objects are known: generated lessons on relations, and corpora of people's commands."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from dcg_torch.fitting.design import DesignMatrix
from dcg_torch.fitting.fit import FitResult
from dcg_torch.fitting.psi import LogLinearFactor
from dcg_torch.grounding.choices import Choice, correspondence_signs, fit_choices
from dcg_torch.grounding.encoders import Encoders
from dcg_torch.grounding.encoding import encode, firing
from dcg_torch.grounding.features import FeatureSet, Group
from dcg_torch.grounding.graph import solver
from dcg_torch.grounding.readings import SharedSearch
from dcg_torch.grounding.solution import Solution
from dcg_torch.grounding.tables import Tables
from dcg_torch.learning.evidence import Ground
from dcg_torch.learning.frames import in_likelier_frames
from dcg_torch.learning.landmarks import (
    Lesson,
    Part,
    example_choices,
    fit_landmarks_em,
    parts_of,
    path_examples,
    said_of_words,
)
from dcg_torch.learning.learner import Experience, Learner, Taught
from dcg_torch.learning.places import place_examples
from dcg_torch.learning.readings import GroundAll, in_meant_readings
from dcg_torch.learning.trainable import taught_mask
from dcg_torch.model.variant import Variant
from dcg_torch.names.weights import log_odds
from dcg_torch.scene.upsilon import with_known
from dcg_torch.types import Example, Symbol
from dcg_torch.types.arrays import Bools, Floats

RELATION_L2 = 1.0
"""Penalty on the weights that are taught by generated lessons."""
CORPUS_L2 = 4.0
"""Penalty on what a corpus moves away from what was known before; weaker ones let one corpus undo what others need."""
_NAMED = 6.0
"""Log-odds at most by which a word that was settled on a type speaks for it before the corpus is weighed."""
_ON_THE_WAY, _SETTLED = (30, 1e-3), (150, 1e-6)
"""Steps at most of the fit in a round of lessons and the gradient at which it has arrived, and those of the last round:
of tens of thousands of factors the optimum is far, and until then the landmarks move it anyway."""


Progress = Callable[[int], None]


class Teachable(Protocol):
    """What is taught: `GroundingModel` is it, and says what each member means."""

    variant: Variant
    features: FeatureSet
    factor: LogLinearFactor
    learner: Learner
    prior: Floats | None
    held: Bools

    @property
    def known_types(self) -> tuple[str, ...]:
        """The types that are known."""
        ...

    def grow(self, features: FeatureSet) -> None:
        """Columns of zero weight for what is new."""
        ...

    def fit_weights(self, designs: Sequence[DesignMatrix], *, free: Bools | None, l2: float) -> FitResult:
        """Fit the free weights to labelled factors, in place."""
        ...

    def train(self) -> FitResult:
        """Columns for all that was learned, and a fit from the present weights."""
        ...


def teach_relations(model: Teachable, lessons: Sequence[Lesson], *, rounds: int, progress: Progress | None) -> None:
    """Teach what words for relations mean, and nothing of what things are called."""
    parts = [part for lesson in lessons for part in parts_of(lesson)]
    model.grow(model.features.extended((), said_of_words(parts, None, None).colors, _phrases(parts)))
    always = example_choices(place_examples(), model.features)
    _fit(
        model,
        _as_known(parts, model),
        Encoders(model.features),
        always,
        free=taught_mask(model.features),
        l2=RELATION_L2,
        rounds=rounds,
        progress=progress,
    )


def teach_corpus(
    model: Teachable,
    lessons: Sequence[Lesson],
    *,
    known_types: Collection[str] | None,
    known_colors: Collection[str] | None,
    rounds: int,
    progress: Progress | None,
) -> None:
    """Teach all that commands about objects tell; for the arguments see `GroundingModel.teach`."""
    lessons, readings = in_meant_readings(lessons, _all_readings(model), model.learner.readings)
    parts = [part for lesson in lessons for part in parts_of(lesson)]
    said = said_of_words(parts, known_types, known_colors)
    model.learner = model.learner.taught(said)
    nouns = [Symbol(word, of) for word, types in said.nouns.items() for of in types]
    columns = model.learner.columns(model.features)
    model.grow(columns.extended(nouns, said.colors, _phrases(parts), scenes=True))
    parts, encoders = _as_known(parts, model), Encoders(model.features)
    solve = solver(encoders, model.factor, beam=model.variant.beam)
    parts, frames = in_likelier_frames(parts, solve, model.learner.frames)
    model.learner = model.learner.with_frames(frames).with_readings(readings)
    # What was known before gives way to as much evidence as any.
    model.prior = model.factor.weight.detach().cpu().numpy() + _as_if_named(model, said)
    paths = encode(path_examples(lessons), model.features, model.factor.correspondences)
    model.fit_weights(paths, free=None, l2=CORPUS_L2)
    fired = _fit(model, parts, encoders, (), free=None, l2=CORPUS_L2, rounds=rounds, progress=progress)
    model.held |= fired | firing(paths, model.features.shape)
    model.prior = model.factor.weight.detach().cpu().numpy().copy()
    _hear(model, parts, solver(encoders, model.factor, beam=model.variant.beam))


def _all_readings(model: Teachable) -> GroundAll:
    """What grounds all readings of a lesson as the model knows words before it."""
    encoders, tables = Encoders(model.features), Tables(model.features, model.factor)

    def ground(lesson: Lesson) -> list[Solution]:
        world = with_known(lesson.world, model.known_types)
        search = SharedSearch(encoders.of(world), tables, model.variant.beam)
        return [search.ground(reading.tree, brief=True) for reading in lesson.readings]

    return ground


def _fit(
    model: Teachable,
    parts: Sequence[Part],
    encoders: Encoders,
    always: Sequence[Choice],
    *,
    free: Bools | None,
    l2: float,
    rounds: int,
    progress: Progress | None,
) -> Bools:
    """Fit the free weights to what is meant and to choices that are always there; (L, G) which features fired last."""
    fired = np.zeros(model.features.shape, dtype=np.bool_)
    prior = np.zeros(tuple(model.factor.weight.shape)) if model.prior is None else model.prior

    def fit_once(choices: list[Choice], last: bool) -> None:
        nonlocal fired
        steps, tolerance = _SETTLED if last else _ON_THE_WAY
        fired = fit_choices(
            model.factor,
            [*always, *choices],
            model.features,
            free=free,
            l2=l2,
            prior=prior,
            max_steps=steps,
            tolerance=tolerance,
        )

    def ground_now() -> Ground:
        return solver(encoders, model.factor, beam=model.variant.beam)

    fit_landmarks_em(parts, encoders, ground_now, fit_once, rounds=rounds, progress=progress)
    return fired


def _as_if_named(model: Teachable, said: Taught) -> Floats:
    """(P, L, G) what makes a type that a word was settled on as good as one that is called by the word.

    Where all that is there is of one type, no choice tells that the word names it, and yet it does. Where there was a
    choice and other types were meant it does not: "mug" in a kitchen that has mugs and cups.
    """
    features = model.features
    odds = np.zeros(features.shape)
    if Group.NAMES in features.groups:
        symbols = model.learner.symbols
        for word, type_ in ((w, symbols[w].type) for w in sorted(model.learner.settled & symbols.keys())):
            row, column = features.language.get(f"noun: {word}"), features.grounding.get(f"type: {type_}")
            if row is not None and column is not None and not said.denies(word, type_):
                odds[row, column] = min(_NAMED, log_odds(word, word) - log_odds(word, type_))
    return correspondence_signs(model.factor)[:, None, None] * odds


def _as_known(parts: Sequence[Part], model: Teachable) -> list[Part]:
    """The parts in worlds whose objects are known or not as they are to the model by now."""
    return [replace(part, world=with_known(part.world, model.known_types)) for part in parts]


def _phrases(parts: Sequence[Part]) -> list[Example]:
    """What is said, for the columns that it needs."""
    return [Example(node.phrase, part.world, ()) for part in parts for node in part.noun.walk()]


def _hear(model: Teachable, parts: Sequence[Part], solve: Ground) -> None:
    """Weigh what lessons tell of words that they did not settle, landmarks' above all, and train."""
    for part in parts:
        said = {word for node in part.noun.walk() for word in (node.phrase.noun, node.phrase.color)}
        if said - {None} <= model.learner.settled:
            continue
        told = replace(part.world, meant=part.targets)
        taught = Experience(certain=True, taught=True, source="lesson")
        model.learner, _ = model.learner.hear(solve(part.noun, told), taught, solve)
    model.train()
