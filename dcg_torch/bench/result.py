"""One measurement, and how it is made."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Result:
    """One measurement: what, its unit, the median of `repeats`, the extremes, and the goal if there is one."""

    name: str
    unit: str
    median: float
    low: float
    high: float
    repeats: int
    goal: float | None = None


def result(name: str, values: Sequence[float], unit: str = "ms", goal: float | None = None) -> Result:
    """The result of several values."""
    return Result(name, unit, statistics.median(values), min(values), max(values), len(values), goal)


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
    """Of several calls, after one to warm up."""
    work()
    return result(name, [milliseconds(work) for _ in range(repeats)], goal=goal)
