"""Training on commands whose objects are known: generated lessons on relations, and corpora of people's commands."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from dcg_torch.grounding.choices import Choice, fit_choices
from dcg_torch.grounding.encode import encode, firing
from dcg_torch.learning.landmarks import (
    Lesson,
    Part,
    example_choices,
    fit_landmarks_em,
    parts_of,
    path_examples,
    said_of_words,
)
from dcg_torch.learning.learner import Experience, Taught
from dcg_torch.learning.places import place_examples
from dcg_torch.learning.trainable import taught_mask
from dcg_torch.scene.upsilon import with_known
from dcg_torch.types import Example, Symbol

if TYPE_CHECKING:
    from dcg_torch.model.core import GroundingModel as Teachable

RELATION_L2 = 1.0
"""Penalty on the weights that are taught by generated lessons."""
CORPUS_L2 = 1.0
"""Penalty on what a corpus moves away from what was known before; weaker ones let one corpus undo what others need."""
_ON_THE_WAY, _SETTLED = 30, 60
"""Steps of the fit in a round of lessons, and in the last: of tens of thousands of factors the optimum is far, and the
landmarks move it anyway."""


def teach(
    model: Teachable,
    lessons: Sequence[Lesson],
    *,
    relations_only: bool,
    known_types: Collection[str] | None,
    known_colors: Collection[str] | None,
    rounds: int,
    progress: Callable[[int], None] | None,
) -> None:
    """See `GroundingModel.teach`."""
    parts = [part for lesson in lessons for part in parts_of(lesson)]
    _make_room(model, parts, said_of_words(parts, known_types, known_colors), relations_only=relations_only)
    parts = [replace(part, world=with_known(part.world, model.known_types)) for part in parts]
    free, l2 = (taught_mask(model.features), RELATION_L2) if relations_only else (None, CORPUS_L2)
    kept = example_choices(place_examples(), model.features) if relations_only else []
    if not relations_only:
        # What was known before gives way to as much evidence as any.
        model.prior = model.factor.weight.detach().cpu().numpy().copy()
        paths = encode(path_examples(lessons), model.features, model.factor.correspondences)
        model.fit_weights(paths, free=None, l2=l2)
        model.held |= firing(paths, model.features.shape)

    def fit_once(choices: list[Choice], last: bool) -> None:
        steps = _SETTLED if last else _ON_THE_WAY
        fired = fit_choices(
            model.factor, [*kept, *choices], model.features, free=free, l2=l2, prior=model.prior, max_steps=steps
        )
        if last and not relations_only:
            model.held |= fired

    fit_landmarks_em(parts, model.features, model.solve, fit_once, rounds=rounds, progress=progress)
    if not relations_only:
        model.prior = model.factor.weight.detach().cpu().numpy().copy()
        _hear(model, parts)


def _make_room(model: Teachable, parts: Sequence[Part], said: Taught, *, relations_only: bool) -> None:
    """Columns for the words of lessons, and what they settle."""
    phrases = [Example(node.phrase, part.world, ()) for part in parts for node in part.noun.walk()]
    if relations_only:
        model.grow(model.features.extended((), said.colors, phrases))
        return
    model.learner = model.learner.taught(said)
    nouns = [Symbol(w, t) for w, of in said.nouns.items() for t in of]
    model.grow(model.learner.columns(model.features).extended(nouns, said.colors, phrases))


def _hear(model: Teachable, parts: Sequence[Part]) -> None:
    """Weigh what lessons tell of words that they did not settle, landmarks' above all, and train."""
    for part in parts:
        said = {word for node in part.noun.walk() for word in (node.phrase.noun, node.phrase.color)}
        if said - {None} <= model.learner.settled:
            continue
        told = replace(part.world, meant=part.targets)
        solution = model.solve(part.noun, told)
        taught = Experience(certain=True, taught=True, source="lesson")
        model.learner, _ = model.learner.hear(solution, taught, model.solve)
    model.train()
