"""One measurement, and how it is made."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Result:
    """One measurement.

    Attributes:
        name: what is measured.
        unit: of the median of `repeats` and of the extremes.
        goal: at most so much; None: there is none.
        curve: the title of the curve that this is a point of, ": ", and the name of its line; empty: of none.
        at: where on the curve.
        part: heading in the page.
    """

    name: str
    unit: str
    median: float
    low: float
    high: float
    repeats: int
    goal: float | None = None
    curve: str = ""
    at: float = 0.0
    part: str = ""


def result(
    name: str,
    values: Sequence[float],
    unit: str = "ms",
    goal: float | None = None,
    *,
    curve: str = "",
    at: float = 0.0,
) -> Result:
    """The result of several values; for `curve` and `at` see `Result`."""
    return Result(name, unit, statistics.median(values), min(values), max(values), len(values), goal, curve, at)


def milliseconds(work: Callable[..., object], *arguments: object) -> float:
    """Wall-clock time of one call."""
    began = time.perf_counter()
    work(*arguments)
    return 1000 * (time.perf_counter() - began)


def cpu_milliseconds(work: Callable[..., object], *arguments: object) -> float:
    """Time of the processor in one call: what others do on the machine meanwhile counts less."""
    began = time.process_time()
    work(*arguments)
    return 1000 * (time.process_time() - began)


def repeated(name: str, work: Callable[[], object], repeats: int, goal: float | None = None) -> Result:
    """Milliseconds of the processor in several calls, after one to warm up."""
    work()
    return result(name, [cpu_milliseconds(work) for _ in range(repeats)], "ms CPU", goal)


def shown_number(value: float) -> str:
    """As people read it: "6,010", "0.856"."""
    return f"{value:,.0f}" if abs(value) >= 1_000 else f"{value:.3g}"
