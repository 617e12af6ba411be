"""What is said before a model is taught lessons, and that it is said just where that is so."""

from __future__ import annotations

from dataclasses import replace

import pytest

from dcg_torch.experiment import factory
from dcg_torch.experiment.lessons_note import lessons_note
from dcg_torch.grounding.features import Group
from dcg_torch.model.pretrain import LESSONS, VARIANT
from dcg_torch.settings import LearnerKind, ModelSettings

OPEN_WORLD = ModelSettings(
    name="open_world",
    groups=["dcg", "unknown", "hypothetical", "color", "open", "relation"],
    lessons=LESSONS,
    beam=12,
    learner=LearnerKind.word_posterior,
)


@pytest.mark.parametrize(
    "model",
    [OPEN_WORLD, replace(OPEN_WORLD, l2=0.1), replace(OPEN_WORLD, beam=8), replace(OPEN_WORLD, lessons=30)],
)
def test_it_is_said_where_the_shipped_model_is_not_taken(model: ModelSettings) -> None:
    chosen = factory.variant(model)
    shipped = (replace(chosen, groups=chosen.groups | {Group.NAMES}), model.lessons) == (VARIANT, LESSONS)
    note = lessons_note(model, None)
    assert (note is None) == shipped
    assert note is None or (str(model.lessons) in note and "\n" not in note)


def test_a_model_without_lessons_has_nothing_to_say() -> None:
    assert lessons_note(ModelSettings(), None) is None
    assert lessons_note(replace(OPEN_WORLD, lessons=0), None) is None


def test_other_examples_are_another_model() -> None:
    assert lessons_note(OPEN_WORLD, "mine.yaml") is not None
