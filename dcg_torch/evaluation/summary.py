"""The figures of an evaluation: accuracy with its interval, calibration, and both by file and by kind of command."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Any, Protocol

import numpy as np

from dcg_torch.evaluation.episodes import Episode
from dcg_torch.evaluation.protocol import CAUSES, Answer, colors_meant, types_meant
from dcg_torch.report.calibration import calibration_error
from dcg_torch.report.intervals import wilson


class Counted(Protocol):
    """An answer, as far as figures count it; of the project or of a baseline."""

    @property
    def file(self) -> str:
        """The stem of the file that it is from."""

    @property
    def probability(self) -> float | None:
        """The probability that the answer was given."""

    @property
    def correct(self) -> bool:
        """Is it right?"""


def by_file(answers: Sequence[Counted]) -> dict[str, dict[str, Any]]:
    """The figures of each file."""
    files = {name: [a for a in answers if a.file == name] for name in dict.fromkeys(a.file for a in answers)}
    return {name: figures(of) for name, of in files.items()}


def summarise(answers: Sequence[Answer], train_seconds: float, *, by_color: bool = False) -> dict[str, Any]:
    """The figures of an evaluation; accuracies have their 95 % interval (Wilson).

    Args:
        by_color: also by the colour of the object meant.
    """
    return {
        **figures(answers),
        "no_answer": sum(not a.predicted for a in answers),
        "train_seconds": train_seconds,
        "seconds_per_command": sum(a.seconds.parse + a.seconds.ground for a in answers) / len(answers),
        "parse_ms": _milliseconds([a.seconds.parse for a in answers]),
        "ground_ms": _milliseconds([a.seconds.ground for a in answers]),
        "learn_ms": _milliseconds([a.seconds.learn for a in answers]),
        "errors": {cause: sum(a.cause == cause for a in answers) for cause in CAUSES},
        "by_kind": {
            kind: {"n": len(of), "accuracy": sum(a.correct for a in of) / len(of)}
            for kind, of in _kinds(answers, by_color=by_color).items()
            if of
        },
        "by_file": by_file(answers),
    }


def figures(answers: Sequence[Counted]) -> dict[str, Any]:
    """Number, accuracy with its interval, calibration error."""
    estimate = wilson(sum(a.correct for a in answers), len(answers))
    return {
        "n": len(answers),
        "accuracy": estimate.value,
        "ci95": [estimate.low, estimate.high],
        "calibration_error": calibration_error([a.probability for a in answers], [a.correct for a in answers]),
    }


def _kinds(answers: Sequence[Answer], *, by_color: bool) -> dict[str, list[Answer]]:
    """The answers by kind of command; a half is one of all, in their order, also where it is that of a type."""
    half = {id(a) for a in answers[: len(answers) // 2]}
    kinds = {kind: [a for a in answers if a.kind == kind] for kind in ("known", "unknown", "learned")}
    kinds |= {form: [a for a in answers if a.form == form] for form in ("plain", "relation")}
    kinds |= {"several share type and colour": [a for a in answers if a.shared > 1]}
    meant = {t: [a for a in answers if types_meant(a.episode) == {t}] for t in _sorted(answers, types_meant)}
    if by_color:
        colors = _sorted(answers, colors_meant)
        meant |= {f"color {c}": [a for a in answers if colors_meant(a.episode) == {c}] for c in colors}
    for name, of in {"": list(answers), **meant}.items():
        kinds |= {name: of} if name else {}
        for which, first in (("first half", True), ("second half", False)):
            kinds[f"{name}, {which}" if name else which] = [a for a in of if (id(a) in half) is first]
    return kinds


def _milliseconds(seconds: Sequence[float]) -> dict[str, float]:
    median, high = np.percentile(1e3 * np.array(seconds), (50, 95))
    return {"median": float(median), "p95": float(high)}


def _sorted(answers: Sequence[Answer], values: Callable[[Episode], Collection[str | None]]) -> list[str]:
    return sorted({v for a in answers for v in values(a.episode) if v is not None})
