"""Runs that differ in their seed alone, taken together: a configuration is measured over all its trials.

A trial's random numbers come from its seed and its number, and nothing else is shared by the trials of one seed. The
trials of five seeds are therefore as independent as those of one, and five runs of 6 trials are measured as one run
of 30: means and 95 % intervals over trials, one curve, one calibration. `by_seed` shows how far the seeds lie apart.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from dcg_torch.report.intervals import Estimate, mean_over_trials
from dcg_torch.report.measures import Measures, measure
from dcg_torch.report.runs import Run
from dcg_torch.report.summary import flatten
from dcg_torch.report.text import printable
from dcg_torch.storage.records import NO_EFFECT, Iteration

_Key = tuple[int | None, int, int]


@dataclass(frozen=True)
class Configuration:
    """Runs of the same settings but for the seed, with the measures of all their trials together."""

    name: str
    runs: tuple[Run, ...]
    measures: Measures

    @property
    def by_seed(self) -> list[float]:
        """The accuracy of each run."""
        return [run.measures.accuracy.value for run in self.runs]

    def rows(self) -> Iterator[tuple[_Key, Iteration]]:
        """Every row under its seed, trial and iteration."""
        for run in self.runs:
            for row in run.rows:
                yield (run.seed, row.trial, row.iteration), row


@dataclass(frozen=True, slots=True)
class Difference:
    """How much more of the same commands the second of two configurations got right than the first.

    Attributes:
        accuracy: second minus first, mean over trials; 95 % interval over trials.
        trials, commands: how many they have in common.
        first_only, second_only: commands that only the one of them got right.
    """

    accuracy: Estimate
    trials: int
    commands: int
    first_only: int
    second_only: int


def configurations(runs: Sequence[Run]) -> list[Configuration]:
    """Group runs by their settings without the seed, in the order of first appearance.

    Runs whose settings are not known, and runs of one configuration with the same seed, stay by themselves: such runs
    hold the same trials, or may, and would count them twice.
    """
    groups: dict[str, list[Run]] = {}
    for run in runs:
        settings = {k: v for k, v in flatten(run.config).items() if k != "seed" and k not in NO_EFFECT}
        key = repr(sorted(settings.items())) if run.seed is not None else str(run.folder)
        groups.setdefault(key, []).append(run)
    apart: list[list[Run]] = []
    for group in groups.values():
        distinct = len({run.seed for run in group}) == len(group)
        apart += [group] if distinct else [[run] for run in group]
    return [
        Configuration(name, tuple(group), _measure_together(group))
        for name, group in zip(_names(apart), apart, strict=True)
    ]


def paired_difference(first: Configuration, second: Configuration) -> Difference | None:
    """Compare on the same commands: same seed, trial and iteration, and then the same text, target, world and pose.

    None where the two have no command in common.
    """
    heard = dict(first.rows())
    trials: dict[tuple[int | None, int], list[tuple[bool, bool]]] = {}
    for key, row in second.rows():
        if (other := heard.get(key)) is not None and _same_command(other, row):
            trials.setdefault(key[:2], []).append((other.correct, row.correct))
    if not trials:
        return None
    pairs = [pair for trial in trials.values() for pair in trial]
    means = [sum(b - a for a, b in trial) / len(trial) for trial in trials.values()]
    return Difference(
        accuracy=mean_over_trials(means),
        trials=len(trials),
        commands=len(pairs),
        first_only=sum(a and not b for a, b in pairs),
        second_only=sum(b and not a for a, b in pairs),
    )


def distinguish(runs: Sequence[Run], without: Sequence[str] = ()) -> list[str]:
    """What tells each run from the others, as overrides: "model=dcg seed=1".

    Hydra's own overrides where every folder has them and they differ, otherwise the settings that are not the same in
    all runs. Keys in `without` don't count.
    """
    given = [run.overrides for run in runs]
    settings: list[Mapping[str, Any]] = [run.config for run in runs]
    if all(overrides is not None for overrides in given):
        told = _differences([overrides or {} for overrides in given], without)
        if any(told):
            return told
    return _differences([flatten(config) for config in settings], without)


def _names(groups: Sequence[Sequence[Run]]) -> list[str]:
    """What tells the groups apart: "dcg" where only the model differs; the run's name where nothing tells them apart.

    Folders where these repeat.
    """
    told = distinguish([group[0] for group in groups], ("seed", *NO_EFFECT))
    if all(name.startswith("model=") and " " not in name for name in told):
        told = [name.removeprefix("model=") for name in told]
    names = [name or group[0].name for name, group in zip(told, groups, strict=True)]
    if len(set(names)) < len(names):
        names = [printable(str(group[0].folder)) for group in groups]
    return names


def _differences(settings: Sequence[Mapping[str, Any]], without: Sequence[str]) -> list[str]:
    keys = [key for key in dict.fromkeys(key for setting in settings for key in setting) if key not in without]
    differing = [key for key in keys if len({repr(setting.get(key)) for setting in settings}) > 1]
    return [printable(" ".join(f"{key}={setting[key]}" for key in differing if key in setting)) for setting in settings]


def _measure_together(runs: Sequence[Run]) -> Measures:
    if len(runs) == 1:
        return runs[0].measures
    trials: dict[tuple[int, int], int] = {}
    rows = []
    for k, run in enumerate(runs):
        for row in run.rows:
            trial = trials.setdefault((k, row.trial), len(trials))
            rows.append(row.model_copy(update={"trial": trial}))
    return measure(rows)


def _same_command(a: Iteration, b: Iteration) -> bool:
    return all(getattr(a, field) == getattr(b, field) for field in ("command", "target", "world", "robot", "objects"))
