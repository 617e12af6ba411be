"""What a finished run leaves for people: figures, pictures, curves, a summary."""

from __future__ import annotations

import contextlib
import functools
import os
import tempfile
import threading
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from dcg_torch.experiment.folder import ITERATIONS
from dcg_torch.experiment.plan import trial_generators, trial_worlds
from dcg_torch.experiment.pool import may_start_processes, work_off, works_alone
from dcg_torch.report.intervals import Estimate, student_quantile
from dcg_torch.report.measures import Measures, measure
from dcg_torch.report.paper import follows_paper
from dcg_torch.report.runs import read_rows, read_timings, varied_settings
from dcg_torch.report.seconds import summarise_seconds
from dcg_torch.report.summary import SUMMARY, ReportError, read_summary, write_summary
from dcg_torch.settings import Metric, Settings
from dcg_torch.storage.atomic_files import sweep_parts
from dcg_torch.world.files import World

_FIGURES = "figures"
_EVENTS = "events.out.tfevents.*"


@dataclass(frozen=True)
class Outcome:
    """A run's measures, and mean seconds a command by phase, with the "wall" time of all."""

    measures: Measures
    seconds: Mapping[str, float]


def save_outcome(
    settings: Settings, directory: Path, wall: float | None, drawing: Generator[object] | None = None
) -> Outcome:
    """Draw and write what the settings ask for, from the rows in a run folder, in place of what was there.

    Args:
        wall: seconds that the run took; None for one that was finished before, whose time stays.
        drawing: what `begin_drawing` gave, if it was asked.
    """
    rows, timings = read_rows(directory / ITERATIONS), read_timings(directory)
    curves: list[Job] = []
    if settings.tensorboard:
        curves = [_load_board, functools.partial(_write_curves, settings, directory)]
    drawing = drawing or begin_drawing(settings, directory)
    with contextlib.closing(drawing), contextlib.closing(_working(curves, settings)) as writing:
        next(drawing, None)  # the figures begin
        next(writing, None)  # what the curves need is loaded meanwhile
        measures, seconds = measure(rows), summarise_seconds(timings)
        _finish(drawing)
        _finish(writing)
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


def begin_drawing(settings: Settings, directory: Path) -> Generator[object]:
    """Begin to draw what needs no trial, in a process of its own where the trials have some as well; go on at once.

    What is asked for draws the rest; ask for nothing before the rows of all trials are there.
    """
    jobs: list[Job] = []
    if settings.screenshots or settings.figures:
        pictures = _screenshots(settings, directory / "screenshots") if settings.screenshots else []
        jobs.append(functools.partial(_draw_ahead, pictures, settings.figures))
    if settings.figures:
        jobs.append(functools.partial(_draw_figures, settings, directory))
    if works_alone(settings) or not may_start_processes():
        return _one_by_one(jobs)
    drawing = work_off(_do, jobs, 1, bare=True)
    next(drawing)
    student_quantile(1)  # what it imports is loaded while the workers wake, and not when all wait for the summary
    return drawing


def _one_by_one(jobs: Iterable[Job]) -> Generator[object]:
    for job in jobs:
        yield job()


def _draw_ahead(pictures: Sequence[Job], figures: bool) -> None:
    """Pictures that need no trial, and what figures need, which takes a while to import."""
    for job in pictures:
        job()
    if figures:
        import dcg_torch.report.figures  # noqa: F401
        from dcg_torch.report.canvas import warm_up

        warm_up()
        student_quantile(1)


def _working(jobs: Sequence[Job], settings: Settings) -> Generator[object]:
    """Do jobs one after another where the trials ran, for there is torch: here, or in a process of their own.

    A job begins when a value is asked for after that of the job before; in another process the first has begun when the
    first value comes.
    """
    if works_alone(settings):
        yield from _one_by_one(jobs)
    else:
        yield from work_off(_do, jobs, 1)


def _finish(working: Iterator[object]) -> None:
    for _ in working:
        pass


def _do(job: Job) -> None:
    job()


def _draw_figures(settings: Settings, directory: Path) -> None:
    from dcg_torch.report.figures import save_figures

    rows, timings = read_rows(directory / ITERATIONS), read_timings(directory)
    save_figures(rows, timings, directory / _FIGURES, beside_paper=follows_paper(asdict(settings)))


def _load_board() -> None:
    import dcg_torch.report.board  # noqa: F401


def _write_curves(settings: Settings, directory: Path) -> None:
    """Write the event file, with the figures in it, beside the old one, then put it in its place."""
    from dcg_torch.report.board import write_board

    rows, timings = read_rows(directory / ITERATIONS), read_timings(directory)
    figures = sorted((directory / _FIGURES).glob("*.png")) if settings.figures else []
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


def _screenshots(settings: Settings, directory: Path) -> list[Job]:
    """A job for each world, in a folder that is made for it.

    It writes `<world>-<object id>.png` for every object, as people are shown to ask for commands. The worlds are those
    of the experiment; where each trial has its own, those of the first.

    Raises:
        WorldFileError: a world file is missing or not valid.
    """
    worlds = trial_worlds(settings, trial_generators(settings.seed, 0)[0])
    directory.mkdir(parents=True, exist_ok=True)
    sweep_parts(directory)
    return [functools.partial(_save_pairs, directory, world) for world in worlds]


def _save_pairs(directory: Path, world: World) -> None:
    from dcg_torch.simulator.screenshot import save_pair_screenshots

    with tempfile.TemporaryDirectory(prefix=".pictures.", suffix=".part", dir=directory) as part:
        for picture in save_pair_screenshots([world], Path(part)):
            os.replace(picture, directory / picture.name)
