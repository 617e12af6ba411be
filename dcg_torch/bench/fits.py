"""The fit beside its peers, on the same rows and the same objective: `python -m dcg_torch.bench.fits [--rows N ...]`.

Milliseconds of the processor on one thread, from labelled rows to weights: for ours, merging them included.
"""

from __future__ import annotations

import sys
import tracemalloc
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from dcg_torch.bench.peers import L2, TOLERANCE, Peer, peers
from dcg_torch.bench.result import Result, cpu_milliseconds, repeated, result
from dcg_torch.bench.rows import Rows, dense_rows, sparse_rows
from dcg_torch.fitting.design import merge
from dcg_torch.fitting.fit import fit, objective_at
from dcg_torch.fitting.psi import LogLinearFactor
from dcg_torch.storage.arguments import Arguments
from dcg_torch.types.arrays import Floats


def ours(rows: Rows, solver: str = "auto") -> LogLinearFactor:
    """From labelled rows to weights."""
    factor = rows.factor()
    weight = np.broadcast_to(1.0, len(rows.phrase))
    design = merge(rows.language, rows.grounding, rows.phrase, rows.label, weight, len(rows.correspondences))
    fit(factor, [design], l2=L2, tolerance=TOLERANCE, max_steps=5_000, solver=solver)  # type: ignore[arg-type]
    return factor


def bench_fit(kind: str, count: int, repeats: int, goal: float | None = None) -> Iterator[Result]:
    """The fit of `count` rows of a kind ("dense" or "sparse"), and each peer's time and gradient."""
    rows = (dense_rows if kind == "dense" else sparse_rows)(count, np.random.default_rng(count))
    what, curve = f"{count:,} {kind} rows", f"Fit of {kind} rows, ms by rows: "
    mine = replace(repeated(f"fit, {what}", lambda: ours(rows), repeats), curve=f"{curve}ours", at=count)
    yield mine
    yield result(f"fit, {what}: memory beyond the input", [peak(lambda: ours(rows))], "MB", goal=60)
    yield result(f"fit, {what}: gradient", [_gradient(rows, ours(rows).weight.numpy())], "max-norm")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # scikit-learn tells of steps that no longer lower its objective
        for peer in peers(rows, lambda: ours(rows, "lbfgs-torch").weight.numpy()):
            yield from _beside(peer, rows, mine, what, max(1, repeats // 2), curve, goal)


def _beside(
    peer: Peer, rows: Rows, mine: Result, what: str, repeats: int, curve: str, goal: float | None
) -> Iterator[Result]:
    """A peer's time, its gradient, and ours over its time."""
    found: list[Floats | None] = []
    times = [cpu_milliseconds(lambda: found.append(peer.run())) for _ in range(repeats)]
    theirs = result(f"{peer.name}, {what}", times, "ms CPU", curve=f"{curve}{peer.name}", at=len(rows.phrase))
    yield theirs
    if (weight := found[0]) is not None:
        yield result(f"{peer.name}, {what}: gradient", [_gradient(rows, weight)], "max-norm")
    own_goal = goal if peer.name == "scikit-learn lbfgs" else None
    yield result(f"fit over {peer.name}, {what}", [mine.median / theirs.median], "ratio", goal=own_goal)


def _gradient(rows: Rows, weight: Floats) -> float:
    """Max-norm of the objective's gradient at some weights."""
    factor = rows.factor()
    factor.set_weight(weight)
    ones = np.ones(len(rows.phrase))
    design = merge(rows.language, rows.grounding, rows.phrase, rows.label, ones, len(rows.correspondences))
    return float(np.abs(objective_at(factor, [design], L2)[1]).max())


def peak(work: Callable[[], object]) -> float:
    """Most memory that a call holds at once, in MB, as numpy tells it."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1] / 2**20
    finally:
        tracemalloc.stop()


_GOALS = {("dense", 1_000): 0.45, ("dense", 100_000): 0.07, ("dense", 1_000_000): 0.08}
"""Of our time over scikit-learn's L-BFGS; .3 for sparse rows."""


def bench_fits(counts: Sequence[int] = (1_000, 100_000)) -> Iterator[Result]:
    """Dense and sparse rows of each count."""
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        for count in counts:
            repeats = 9 if count <= 10_000 else 3 if count <= 200_000 else 1
            yield from bench_fit("dense", count, repeats, _GOALS.get(("dense", count)))
            yield from bench_fit("sparse", count, repeats, 0.3)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the results as they come; returns the exit status."""
    parser = Arguments(prog="python -m dcg_torch.bench.fits", description="Time the fit and its peers.")
    parser.add_argument("--rows", type=int, nargs="+", default=[1_000, 100_000], help="how many; 1000000 takes minutes")
    for found in bench_fits(parser.parse_args(arguments).rows):
        goal = "" if found.goal is None else f"  goal {found.goal:g}"
        print(f"{found.name:64} {found.median:12.4g} {found.unit}{goal}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
