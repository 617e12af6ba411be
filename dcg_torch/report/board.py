"""A run in TensorBoard: one event file with every measure by iteration, the training, the seconds and the figures.

The step is the iteration, counted from 1 as in the figures. A value at a step is the mean over the trials.
Tags are grouped by their first part, which `ABOUT` explains in the TEXT tab.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from PIL import Image
from tensorboard.compat.proto.summary_pb2 import Summary  # type: ignore[import-untyped]
from torch.utils.tensorboard import SummaryWriter
from torch.utils.tensorboard.summary import hparams as hparams_summaries

from dcg_torch.report.measures import IterationMeasures, Measures, measure
from dcg_torch.report.seconds import PHASES, summarise_seconds, total_seconds
from dcg_torch.storage.records import Iteration, Timing

_SUFFIX = ".dcg_torch"  # tells our event files from others in the folder

ABOUT = """
Steps are iterations, from 1; a value is the mean over the trials.

| tags | what |
|---|---|
| accuracy | share of commands after which the robot stood at the object meant: all, and by what the word was to it |
| shares | known, unknown and learned words among the commands it got right |
| symbols | types it has a right name for, the number if every new type met had been learned, words held wrongly |
| errors | share of all commands that went wrong, by cause |
| effort | metres, radians, looks and questions a command; success weighted by path length; objects out of view |
| training, features | the fit after each command, and the columns it has |
| seconds | wall-clock seconds a command, by phase |
| intervals | 95 % bounds of accuracy and of right symbols |
| run | one value for the whole run, at its last step; the HPARAMS tab compares runs by these |
"""

_LAYOUT = {
    "accuracy": {
        "right object reached, 95 % interval": [
            "Margin",
            ["accuracy/all", "intervals/accuracy_low", "intervals/accuracy_high"],
        ],
        "by what the word was to the robot": ["Multiline", ["accuracy/known", "accuracy/unknown", "accuracy/learned"]],
        "shares among the right ones": ["Multiline", ["shares/known", "shares/unknown", "shares/learned"]],
    },
    "symbols": {
        "right, 95 % interval": ["Margin", ["symbols/right", "intervals/symbols_low", "intervals/symbols_high"]],
        "right, expected and wrong": ["Multiline", ["symbols/right", "symbols/expected", "symbols/wrong"]],
    },
    "time": {"seconds a command": ["Multiline", [f"seconds/{phase}" for phase in PHASES]]},
}


def write_board(
    directory: Path,
    rows: Sequence[Iteration],
    timings: Sequence[Timing],
    hparams: Mapping[str, bool | int | float | str],
    figures: Iterable[Path] = (),
) -> None:
    """Write a run's event file into `directory`, in place of one that an earlier call left there.

    Args:
        directory: the run folder, made if need be.
        rows: the run's rows, as for `measure`.
        timings: the wall-clock times; may be empty.
        hparams: settings for the HPARAMS tab: those in which this run may differ from others beside it
            (`runs.varied_settings`), since a column of constants tells nothing.
        figures: PNG files, shown under their names.

    Raises:
        ValueError: as `measure` does.
    """
    measures = measure(rows)
    directory.mkdir(parents=True, exist_ok=True)
    for stale in directory.glob(f"events.out.tfevents.*{_SUFFIX}"):
        stale.unlink()
    with SummaryWriter(str(directory), filename_suffix=_SUFFIX) as writer:
        for step, tag, value in _scalars(measures, timings):
            writer.add_scalar(tag, value, step)
        values = _run_values(measures, timings)
        for tag, value in values.items():
            writer.add_scalar(tag, value, measures.by_iteration[-1].iteration + 1)
        # `SummaryWriter.add_hparams` would open a second run in a subfolder.
        for summary in hparams_summaries(dict(hparams), values):  # type: ignore[no-untyped-call]
            writer.file_writer.add_summary(summary)
        writer.add_custom_scalars(_LAYOUT)
        writer.add_text("about", ABOUT)
        for path in figures:
            writer.file_writer.add_summary(_image(path))


def _scalars(measures: Measures, timings: Sequence[Timing]) -> Iterator[tuple[int, str, float]]:
    for m in measures.by_iteration:
        for tag, value in _iteration_values(m):
            if value is not None:
                yield m.iteration + 1, tag, float(value)
    at: defaultdict[int, list[Timing]] = defaultdict(list)
    for timing in timings:
        at[timing.iteration + 1].append(timing)
    for step in sorted(at):
        for tag, value in _timing_values(at[step]):
            if math.isfinite(value):  # a loss may be anything; TensorBoard draws no curve with a gap of NaN
                yield step, tag, value


def _iteration_values(m: IterationMeasures) -> Iterator[tuple[str, float | None]]:
    yield "accuracy/all", m.accuracy.value
    yield "accuracy/mean_probability", m.probability
    yield "intervals/accuracy_low", m.accuracy.low
    yield "intervals/accuracy_high", m.accuracy.high
    for kind, of_kind in m.kinds.items():
        yield f"accuracy/{kind}", of_kind.accuracy.value if of_kind.accuracy else None
        yield f"shares/{kind}", m.shares.get(kind)
    yield "symbols/right", m.correct_symbols.value
    yield "intervals/symbols_low", m.correct_symbols.low
    yield "intervals/symbols_high", m.correct_symbols.high
    yield "symbols/expected", m.expected_symbols
    yield "symbols/wrong", m.wrong_symbols
    yield "symbols/trials_with_all_right", m.all_symbols
    for cause, count in m.causes.items():
        yield f"errors/{cause.replace(' ', '_')}", count / m.n
    yield "effort/path_length_metres", m.path_length
    yield "effort/turned_radians", m.turned
    yield "effort/path_efficiency", m.path_efficiency
    yield "effort/questions", m.asked
    yield "effort/objects_out_of_first_view", m.out_of_view


def _timing_values(timings: Sequence[Timing]) -> Iterator[tuple[str, float]]:
    def mean(field: str) -> float:
        return math.fsum(getattr(t, field) for t in timings) / len(timings)

    yield "training/loss", mean("train_loss")
    yield "training/steps", mean("train_steps")
    yield "training/rows", mean("train_rows")
    yield "features/language_columns", mean("language_columns")
    yield "features/grounding_columns", mean("grounding_columns")
    yield "effort/looks", mean("groundings")
    for phase in PHASES:
        yield f"seconds/{phase}", mean(phase)
    yield "seconds/command", math.fsum(map(total_seconds, timings)) / len(timings)


def _run_values(measures: Measures, timings: Sequence[Timing]) -> dict[str, float]:
    values = {
        "run/accuracy": measures.accuracy.value,
        "run/accuracy_low": measures.accuracy.low,
        "run/accuracy_high": measures.accuracy.high,
        "run/symbols_right": measures.correct_symbols.value,
        "run/symbols_wrong": measures.wrong_symbols,
        "run/all_symbols_share": measures.all_symbols.value,
        "run/questions_per_command": measures.asked,
        "run/calibration_error": measures.calibration.error,
        "run/path_length_metres": measures.path_length,
        "run/turned_radians": measures.turned,
        "run/seconds_per_command": summarise_seconds(timings).get("command"),
    }
    return {tag: float(value) for tag, value in values.items() if value is not None}


def _image(path: Path) -> Summary:
    """The PNG as it is: decoding and encoding it again would take longer than drawing it."""
    with Image.open(path) as image:
        width, height = image.size
    content = Summary.Image(width=width, height=height, colorspace=4, encoded_image_string=path.read_bytes())
    return Summary(value=[Summary.Value(tag=f"figures/{path.stem}", image=content)])
