"""What a finished run leaves for people: figures, pictures, curves, a summary."""

from __future__ import annotations

import contextlib
import functools
import os
import tempfile
import threading
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from dcg_torch.experiment.folder import ITERATIONS
from dcg_torch.experiment.plan import trial_generators, trial_worlds
from dcg_torch.experiment.pool import cores, work_off, works_alone
from dcg_torch.report.intervals import Estimate
from dcg_torch.report.measures import Measures, measure
from dcg_torch.report.paper import follows_paper
from dcg_torch.report.runs import read_rows, read_timings, varied_settings
from dcg_torch.report.seconds import summarise_seconds
from dcg_torch.report.summary import SUMMARY, ReportError, read_summary, write_summary
from dcg_torch.settings import Metric, Settings
from dcg_torch.storage.records import Iteration, Timing
from dcg_torch.storage.whole import sweep_parts
from dcg_torch.world.files import World

_EVENTS = "events.out.tfevents.*"


@dataclass(frozen=True)
class Outcome:
    """A run's measures, and mean seconds a command by phase, with the "wall" time of all."""

    measures: Measures
    seconds: Mapping[str, float]


def save_outcome(settings: Settings, directory: Path, wall: float | None) -> Outcome:
    """Draw and write what the settings ask for, from the rows in a run folder, in place of what was there.

    Args:
        wall: seconds that the run took; None for one that was finished before, whose time stays.
    """
    rows, timings = read_rows(directory / ITERATIONS), read_timings(directory)
    with contextlib.closing(_working(_jobs(settings, directory), settings)) as drawing:
        next(drawing, None)  # it begins
        measures, seconds = measure(rows), summarise_seconds(timings)
        _finish(drawing)
    summary = directory / SUMMARY
    if wall is not None:
        seconds["wall"] = wall
    else:
        with contextlib.suppress(ReportError):  # there may be none yet, if it was interrupted after its last trial
            seconds["wall"] = read_summary(summary).seconds["wall"]
    write_summary(summary, directory.name, asdict(settings), measures, seconds)
    return Outcome(measures, seconds)


def value_of(measures: Measures, metric: Metric) -> float:
    """What a run is judged by, as one number."""
    value = getattr(measures, metric)
    return float(value.value if isinstance(value, Estimate) else value)


Job = Callable[[], object]


def _jobs(settings: Settings, directory: Path) -> list[Job]:
    """What there is to draw, the longest first: pieces that don't wait for one another."""
    jobs: list[Job] = []
    if settings.figures or settings.tensorboard:
        jobs.append(functools.partial(_draw, settings, directory))
    if settings.screenshots:
        jobs += _screenshots(settings, directory / "screenshots")
    return jobs


def _working(jobs: Sequence[Job], settings: Settings) -> Generator[object]:
    """Do all jobs where the trials ran, for there is imported what takes longest: here, or in several processes.

    Those in other processes have begun when the first value comes.
    """
    if works_alone(settings):
        for job in jobs:
            yield job()
    else:
        yield from work_off(_do, jobs, settings.workers or cores())


def _finish(working: Iterator[object]) -> None:
    for _ in working:
        pass


def _do(job: Job) -> None:
    job()


def _draw(settings: Settings, directory: Path) -> None:
    """Figures, and curves beside which they are shown."""
    rows, timings = read_rows(directory / ITERATIONS), read_timings(directory)
    figures: list[Path] = []
    if settings.figures:
        from dcg_torch.report.figures import save_figures

        figures = save_figures(rows, timings, directory / "figures", beside_paper=follows_paper(asdict(settings)))
    if settings.tensorboard:
        _write_curves(directory, rows, timings, figures)


def _write_curves(
    directory: Path, rows: Sequence[Iteration], timings: Sequence[Timing], figures: Sequence[Path]
) -> None:
    """Write the event file beside the old one, then put it in its place."""
    from dcg_torch.report.board import write_board

    with tempfile.TemporaryDirectory(prefix=".curves.", suffix=".part", dir=directory) as part:
        with _quiet_threads():
            write_board(Path(part), rows, timings, varied_settings(directory), figures)
        new = list(Path(part).glob(_EVENTS))
        for stale in directory.glob(_EVENTS):
            stale.unlink()
        for file in new:
            os.replace(file, directory / file.name)


@contextlib.contextmanager
def _quiet_threads() -> Iterator[None]:
    """TensorBoard writes in a thread; what fails there it raises once more in this one, so once is enough to say it."""
    before = threading.excepthook
    threading.excepthook = lambda _: None
    try:
        yield
    finally:
        threading.excepthook = before


def save_screenshots(settings: Settings, directory: Path) -> None:
    """Write `<world>-<object id>.png` for every pair of a world and an object, as people are shown to ask for commands.

    The worlds are those of the experiment; where each trial has its own, those of the first.

    Raises:
        WorldFileError: a world file is missing or not valid.
    """
    _finish(_working(_screenshots(settings, directory), settings))


def _screenshots(settings: Settings, directory: Path) -> list[Job]:
    """A job for each world, in a folder that is made for it."""
    worlds = trial_worlds(settings, trial_generators(settings.seed, 0)[0])
    directory.mkdir(parents=True, exist_ok=True)
    sweep_parts(directory)
    return [functools.partial(_save_pairs, directory, world) for world in worlds]


def _save_pairs(directory: Path, world: World) -> None:
    from dcg_torch.simulator.screenshot import save_pair_screenshots

    with tempfile.TemporaryDirectory(prefix=".pictures.", suffix=".part", dir=directory) as part:
        for picture in save_pair_screenshots([world], Path(part)):
            os.replace(picture, directory / picture.name)
