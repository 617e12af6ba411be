"""`python -m dcg_torch.convert KIND PATH --out FILE`: scenes and commands of others, as files of ours."""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Self

from rich.console import Console

from dcg_torch.cli.application import one_line_errors
from dcg_torch.cli.console import Bar, make_console
from dcg_torch.evaluation.importers.base import Converted, ImportFileError
from dcg_torch.storage.arguments import Arguments
from dcg_torch.storage.atomic_files import write_whole


class Kind(NamedTuple):
    """A kind of files: the importer, what it reads, what it writes."""

    module: str
    reads: str
    writes: str = "episodes"


KINDS: Mapping[str, Kind] = {
    "h2sl": Kind("h2sl", "examples of h2sl: an XML file, or a folder of them"),
    "h2sl_symbols": Kind("h2sl_symbols", "a symbol dictionary of h2sl; writes a training file (YAML)", "training file"),
    "iref_vla": Kind("iref_vla", "IRef-VLA: a *_scene_graph.json with its statements beside it, or a folder"),
    "concept_graphs": Kind("concept_graphs", "ConceptGraphs: a folder with objects and relations (JSON), or a file"),
    "csv": Kind("table", "a CSV file with a row per object"),
}

_DESCRIPTION = """\
Converts scenes and commands of others into an episode file, for `evaluate`, and says
what was left out and why.
"""
_EPILOG = """\
  python -m dcg_torch.convert h2sl data/training --out h2sl.jsonl
  python -m dcg_torch.evaluate test=h2sl.jsonl

Exit status: 0 done, 2 for what can't be read or written; one line says what, where and how to mend it.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    with one_line_errors():
        options = _parser().parse_args(arguments)
        kind = KINDS[options.kind]
        console = make_console()
        with _Progress(console) as progress:
            found = _importer(kind)(options.path, progress)
        if not found.lines:
            told = next(found.told(), "there is nothing in it")
            raise ImportFileError(f"{options.path}: gives no {kind.writes}; {told}")
        write_whole(options.out, "\n".join(found.lines) + "\n")
        number = f"{len(found.lines)} " if kind.writes == "episodes" else ""
        for line in (f"written: {options.out}: {number}{kind.writes}", *found.told()):
            console.print(line, markup=False, highlight=False)
        sys.stdout.flush()
    return 0


def _importer(kind: Kind) -> Callable[[Path, Callable[[int], None]], Converted]:
    module: Any = importlib.import_module(f"dcg_torch.evaluation.importers.{kind.module}")
    convert: Callable[[Path, Callable[[int], None]], Converted] = module.convert
    return convert


class _Progress:
    """A bar that learns with the first step how many there are."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._bar: Bar | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.__exit__()

    def __call__(self, total: int) -> None:
        """One more of `total` is done."""
        if self._bar is None:
            self._bar = Bar("converting", total, self._console).__enter__()
        self._bar.advance()


def _parser() -> argparse.ArgumentParser:
    listed = "\n".join(f"  {name:<16}{kind.reads}" for name, kind in KINDS.items())
    parser = Arguments(
        prog="python -m dcg_torch.convert",
        description=f"{_DESCRIPTION}\nKinds:\n{listed}\n",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("kind", metavar="KIND", choices=KINDS, help="of the files, one of those above")
    parser.add_argument("path", metavar="PATH", type=Path, help="a file or a folder")
    parser.add_argument(
        "--out", metavar="FILE", type=Path, required=True, help="the file to write; its folder is made if need be"
    )
    return parser
