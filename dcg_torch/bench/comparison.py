"""`python -m dcg_torch.bench.comparison NAME=RUN [NAME=RUN ...] [--out FILE]`: the project beside the baselines.

Each RUN is the folder of an evaluation with `baseline=[...]`. The tables are written between the two comments of a
Markdown page that say where they belong; without `--out` they are printed.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from dcg_torch.cli.application import one_line_errors
from dcg_torch.storage.arguments import Arguments
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.errors import UserError
from dcg_torch.storage.untrusted_files import read_json, read_text

BEGIN, END = "<!-- tables: begin -->", "<!-- tables: end -->"
_PROJECT = "this project"


class ComparisonError(UserError):
    """A run that has no baselines, or a page without a place for the tables; the message is one line."""


def read_summary(folder: Path) -> Mapping[str, Any]:
    """The figures of an evaluation.

    Raises:
        ComparisonError: there are none, or none of baselines.
    """
    path = folder / "summary.json"
    try:
        found = read_json(read_text(path, "summary", ComparisonError))
    except ValueError as error:
        raise ComparisonError(f"{path}: not a summary: {error}") from None
    if not isinstance(found, dict) or not found.get("baselines") or "by_file" not in found:
        raise ComparisonError(f"{path}: an evaluation without baselines; run it with baseline=[overlap,nearest]")
    return found


def tables(name: str, summary: Mapping[str, Any]) -> Iterator[str]:
    """The lines of a run's tables: shares of right answers by file, and of right changes where it was certified."""
    ways = {_PROJECT: summary, **summary["baselines"]}
    yield from (f"### {name}", "", f"| file | commands | {' | '.join(ways)} |", f"|---|{'---|' * (1 + len(ways))}")
    behind = []
    for file, own in summary["by_file"].items():
        shares = {way: of["by_file"][file]["accuracy"] for way, of in ways.items()}
        best = max(shares.values())
        low, high = own["ci95"]
        cells = [f"**{_percent(s)}**" if s == best else _percent(s) for s in shares.values()]
        cells[0] += f" [{_percent(low)}, {_percent(high)}]"
        yield f"| {file} | {own['n']} | {' | '.join(cells)} |"
        behind += [f"{way} in {file}" for way, share in shares.items() if share > shares[_PROJECT]]
    errors = [_decimal(of.get("calibration_error")) for of in ways.values()]
    yield from (f"| calibration error, all | {summary['n']} | {' | '.join(errors)} |", "")
    yield from (f"Ahead of this project: {', '.join(behind) or 'none'}.", "")
    if "certify" in summary:
        yield from _certified(name, {way: of["certify"] for way, of in ways.items() if "certify" in of})


def _certified(name: str, ways: Mapping[str, Mapping[str, Mapping[str, int]]]) -> Iterator[str]:
    """The share of changes that the answer follows, of those commands that a way answered right before."""
    yield from (f"### {name}: does the answer change as it should?", "", f"| change | {' | '.join(ways)} |")
    yield f"|---|{'---|' * len(ways)}"
    for change in ways[_PROJECT]:
        counts = [of[change] for of in ways.values()]
        yield f"| {change} | {' | '.join(_share(c['right'], c['n']) for c in counts)} |"
    yield ""


def _share(right: int, n: int) -> str:
    return f"{_percent(right / n)} of {n}" if n else "-"


def _percent(share: float) -> str:
    return f"{100 * share:.1f}"


def _decimal(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def placed(page: str, lines: Sequence[str], path: Path) -> str:
    """A page with lines in the place of its tables.

    Raises:
        ComparisonError: the page has no place for them.
    """
    start, end = page.find(BEGIN), page.find(END)
    if start < 0 or end < start:
        raise ComparisonError(f"{path}: no place for the tables; write the lines {BEGIN} and {END} where they belong")
    return "\n".join([page[: start + len(BEGIN)], "", *lines]) + page[end:]


def _write(runs: Sequence[str], out: Path | None) -> None:
    lines: list[str] = []
    for given in runs:
        name, sign, folder = given.partition("=")
        if not sign or not name or not folder:
            raise ComparisonError(f"{given}: write NAME=RUN, a name and the folder of an evaluation")
        lines += tables(name, read_summary(Path(folder)))
    if out is None:
        print("\n".join(lines))
    else:
        write_whole(out, placed(read_text(out, "page", ComparisonError), lines, out))


def main() -> int:
    """Run the command line; the exit status."""
    parser = Arguments(prog="python -m dcg_torch.bench.comparison", description="The tables of baselines")
    parser.add_argument("runs", nargs="+", metavar="NAME=RUN")
    parser.add_argument("--out", type=Path, help="Markdown page that gets the tables")
    given = parser.parse_args()
    with one_line_errors(program="comparison"):
        _write(given.runs, given.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
