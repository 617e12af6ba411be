"""Baselines by their names."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from dcg_torch.evaluation.baselines.base import Baseline, BaselineError
from dcg_torch.evaluation.baselines.learned import BagOfWords, MiniLM, NounPhrase
from dcg_torch.evaluation.baselines.words import Outcomes, Scored, nearest, overlap

_POINTS = 3.0  # points of overlap to a nat, before there was any training

BASELINES: Final[Mapping[str, Callable[[NounPhrase], Baseline]]] = {
    "overlap": lambda _: Scored(overlap, _POINTS),
    "nearest": lambda _: Scored(nearest, _POINTS),
    "outcomes": lambda _: Outcomes(_POINTS),
    "bow": lambda _: BagOfWords(),
    "minilm": MiniLM,
}


def make_baseline(name: str, noun_phrase: NounPhrase) -> Baseline:
    """A baseline that has learned nothing yet.

    Args:
        noun_phrase: what a text says of the object meant; only `minilm` asks for it.

    Raises:
        BaselineError: there is none of this name, or its extra is not installed.
    """
    if name not in BASELINES:
        raise BaselineError(f"baseline={name}: there is no such baseline; choose from {', '.join(BASELINES)}")
    return BASELINES[name](noun_phrase)
