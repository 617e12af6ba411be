"""Numbers as text, the same in tables and figures: "82.7 % [76.6, 88.7]". What is missing is a dash."""

from __future__ import annotations

from dcg_torch.report.intervals import Estimate


def percent(share: float | None, digits: int = 1) -> str:
    """A share from 0 to 1, as in "82.7 %"."""
    return "-" if share is None else f"{100 * share:.{digits}f} %"


def percent_interval(estimate: Estimate, digits: int = 1) -> str:
    """A share with its 95 % interval, as in "82.7 % [76.6, 88.7]"."""
    return percent(estimate.value, digits) + _bounds(estimate, f".{digits}f", 100)


def points_interval(estimate: Estimate) -> str:
    """A difference of shares in percentage points with its 95 % interval, as in "+3.1 [-0.4, +6.6]"."""
    return f"{100 * estimate.value:+.1f}" + _bounds(estimate, "+.1f", 100)


def number_interval(estimate: Estimate) -> str:
    """A number with its 95 % interval, as in "5.73 [5.12, 6.35]"."""
    return f"{estimate.value:.2f}" + _bounds(estimate, ".2f", 1)


def number(value: float | None, digits: int = 2) -> str:
    """A number with so many decimals."""
    return "-" if value is None else f"{value:.{digits}f}"


def seconds(value: float | None) -> str:
    """Seconds, as in "30 ms" or "1.2 s"."""
    if value is None:
        return "-"
    return f"{1000 * value:.0f} ms" if value < 1 else f"{value:.1f} s"


def counted(count: int, noun: str) -> str:
    """A number with its noun, as in "1 trial" and "1,200 trials"."""
    return f"{count:,} {noun}" if count == 1 else f"{count:,} {noun}s"


def printable(text: str) -> str:
    """One line without control characters: names from files must not steer the terminal."""
    return "".join(c if c.isprintable() else "?" for c in " ".join(text.split()))


def _bounds(estimate: Estimate, form: str, unit: float) -> str:
    if estimate.low is None or estimate.high is None:
        return ""
    return f" [{unit * estimate.low:{form}}, {unit * estimate.high:{form}}]"
