"""From measurements to a page with pictures: `python -m dcg_torch.bench.page runs/bench.json docs`."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from dcg_torch.bench.result import Result, shown_number
from dcg_torch.cli.application import one_line_errors
from dcg_torch.storage.arguments import Arguments
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.errors import UserError

_HEAD = """# Performance

`make bench` measures, and `python -m dcg_torch.bench.page runs/bench.json docs` makes this page of what it has
written. Figures are medians, with the lowest and the highest of the repeats. "ms CPU" is time of the processor on one
thread, which others on the machine disturb little; "ms" is time on the clock.
"""
_PICTURE = "pictures/performance_{}.svg"


def page(found: dict[str, Any]) -> tuple[str, dict[str, dict[str, list[Result]]]]:
    """The page, and its curves: title -> line -> points.

    Args:
        found: what `make bench` has written.
    """
    results = [Result(**one) for one in found["benchmarks"]]
    lines = [_HEAD, *_machine(found["machine"], results)]
    curves = _curves(results)
    for part in dict.fromkeys(r.part for r in results):
        own = [r for r in results if r.part == part]
        lines += ["", f"## {part}", ""]
        if ratios := _ratios(own):
            lines += [*ratios, ""]
        lines += [f"![{title}]({_PICTURE.format(_slug(title))})\n" for title in _curves(own)]
        lines += ["| what | median | lowest | highest | unit | repeats | goal |", "|---|---|---|---|---|---|---|"]
        for r in own:
            if r.unit != "ratio":
                goal = "" if r.goal is None else f"{r.goal:g}"
                values = " | ".join(map(shown_number, (r.median, r.low, r.high)))
                lines.append(f"| {r.name} | {values} | {r.unit} | {r.repeats} | {goal} |")
    return "\n".join(lines) + "\n", curves


def _machine(machine: dict[str, Any], results: Sequence[Result]) -> list[str]:
    told = ", ".join(f"{name} {value}" for name, value in machine.items() if name != "load")
    lines = [f"The machine: {told}; load {machine['load']:.1f} at the end."]
    if machine["load"] > machine["processors"]:
        lines.append("Others were busy on it, so times on the clock are far higher than on a quiet machine.")
    slow = next((r.median for r in results if r.name == "importing torch"), None)
    if slow is not None:
        lines.append(
            f"Importing torch takes {slow / 1000:.1f} s CPU here and took 1.2 s where the goals were set: "
            f"a goal of 1 ms there is {slow / 1200:.1f} ms here."
        )
    return lines


def _ratios(results: Sequence[Result]) -> list[str]:
    """The time of the fit over that of each peer, by rows."""
    ratios = {r.name.removeprefix("fit over "): r.median for r in results if r.unit == "ratio"}
    if not ratios:
        return []
    peers = list(dict.fromkeys(name.partition(", ")[0] for name in ratios))
    lines = [
        "Our time over that of peers, in the same run, on the same rows, for the same objective; below 1 is faster:"
    ]
    lines += ["", "| rows | " + " | ".join(peers) + " |", "|---|" + "---|" * len(peers)]
    for what in dict.fromkeys(name.partition(", ")[2] for name in ratios):
        values = (ratios.get(f"{peer}, {what}") for peer in peers)
        lines.append(f"| {what} | " + " | ".join("" if v is None else f"{v:.2g}" for v in values) + " |")
    return lines


def _curves(results: Sequence[Result]) -> dict[str, dict[str, list[Result]]]:
    found: dict[str, dict[str, list[Result]]] = {}
    for r in results:
        if r.curve:
            title, _, line = r.curve.partition(": ")
            found.setdefault(title, {}).setdefault(line, []).append(r)
    return found


def _slug(title: str) -> str:
    return "_".join("".join(c if c.isalnum() else " " for c in title.lower()).split())


def draw(title: str, lines: dict[str, list[Result]], path: Path) -> None:
    """A curve as SVG, both axes logarithmic where its points lie far apart."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot
    from matplotlib.ticker import MaxNLocator

    figure, axes = pyplot.subplots(figsize=(6.0, 3.2), layout="constrained")
    for name, points in lines.items():
        axes.plot([p.at for p in points], [p.median for p in points], marker="o", markersize=3, label=name)
    values = [p.at for points in lines.values() for p in points]
    if max(values) > 20 * min(values):
        axes.set_xscale("log")
        axes.set_yscale("log")
    else:
        axes.set_ylim(bottom=0.0)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))  # there are no 1.2 workers
    what, _, by = title.rpartition(" by ")
    axes.set(title=what, xlabel=by)
    axes.grid(alpha=0.3)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=7, frameon=False)  # beside the lines, over none
    with matplotlib.rc_context({"svg.hashsalt": "dcg_torch", "svg.fonttype": "none"}):  # small, the same bytes always
        figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    parser = Arguments(prog="python -m dcg_torch.bench.page", description="Make the page of measurements.")
    parser.add_argument("json", type=Path, help="what make bench has written")
    parser.add_argument("folder", type=Path, help="where performance.md and pictures/ go")
    options = parser.parse_args(arguments)
    with one_line_errors():
        try:
            text, curves = page(json.loads(options.json.read_text(encoding="utf-8")))
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise UserError(f"{options.json}: not what `make bench` writes ({error}); run it anew") from None
        (options.folder / "pictures").mkdir(parents=True, exist_ok=True)
        for title, lines in curves.items():
            draw(title, lines, options.folder / _PICTURE.format(_slug(title)))
        write_whole(options.folder / "performance.md", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
