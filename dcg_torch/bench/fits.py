"""The fit beside its peers, on the same rows and the same objective: `python -m dcg_torch.bench.fits [--rows N ...]`.

Peers are the solvers of scikit-learn and torch's L-BFGS. Each has the time that it needs from labelled rows to weights:
for ours, merging them included. scikit-learn gets its design matrix ready made, its C is 1 / l2 and its columns are the
pairs of ours. Its tolerance is divided by the rows, as its objective is; it often stops earlier, when the value stands
still, so every peer's gradient is given beside its time.
"""

from __future__ import annotations

import math
import sys
import tracemalloc
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dcg_torch.bench.result import Result, milliseconds, repeated, result
from dcg_torch.grounding.design import Ints, merge
from dcg_torch.grounding.fit import fit, objective_at
from dcg_torch.grounding.psi import BINARY, TERNARY, Bag, Floats, LogLinearFactor
from dcg_torch.storage.arguments import Arguments
from dcg_torch.types import Correspondence

L2 = 1.0
TOLERANCE = 1e-6
"""Of the gradient's max-norm, absolute."""
_SLOW = {"newton-cholesky": 10_000, "newton-cg": 200_000, "torch": 200_000}
"""Rows up to which a peer is asked: beyond, it takes minutes or gigabytes."""


@dataclass(frozen=True)
class Rows:
    """Labelled factors, drawn from a model of their own.

    Attributes:
        language: (m, k) bag of the phrases.
        grounding: (n, k') bag of the factors.
        phrase: (n,) the phrase of each.
        label: (n,) the number of its correspondence.
        pairs: (L, G) the features.
        correspondences: what the labels stand for.
    """

    language: Bag
    grounding: Bag
    phrase: Ints
    label: Ints
    pairs: NDArray[np.bool_]
    correspondences: tuple[Correspondence, ...]

    def factor(self) -> LogLinearFactor:
        """One of zero weights."""
        return LogLinearFactor(self.pairs, self.correspondences)


def dense_rows(count: int, rng: np.random.Generator) -> Rows:
    """Few phrases with few groundings, nearly all of which occur together; about a sixth of the rows are distinct."""
    languages, groundings, ones = 40, 30, 3
    side = math.ceil(math.sqrt(count / 6))
    phrases = np.stack([rng.choice(languages, ones, replace=False) for _ in range(side)])
    objects = np.stack([rng.choice(groundings, ones, replace=False) for _ in range(side)])
    pairs = np.ones((languages, groundings), dtype=np.bool_)
    return _labelled(
        phrases, objects[rng.integers(side, size=count)], rng.integers(side, size=count), pairs, TERNARY, rng
    )


def sparse_rows(count: int, rng: np.random.Generator) -> Rows:
    """As a corpus gives them: each phrase among the twenty things of its own scene; a few words are frequent.

    A phrase fires 5 of 150 language columns and a thing 8 of 120 grounding columns, by Zipf's law; a third of the
    pairs are features.
    """
    languages, groundings, scene = 150, 120, 20
    phrases = max(1, count // scene)
    kinds = _zipf_bags(max(10, phrases // 4), languages, 5, rng)  # what people say is often the same
    grounding = _zipf_bags(phrases * scene, groundings, 8, rng)
    pairs = rng.random((languages, groundings)) < 1 / 3
    phrase = np.repeat(rng.integers(len(kinds), size=phrases), scene)
    return _labelled(kinds, grounding, phrase, pairs, BINARY, rng)


def _zipf_bags(count: int, columns: int, ones: int, rng: np.random.Generator) -> Bag:
    chance = 1.0 / np.arange(1, columns + 1)
    keys = rng.exponential(size=(count, columns)) / chance  # the least of exponential times: drawn without repeats
    return np.argpartition(keys, ones, axis=1)[:, :ones].astype(np.int64)


def _labelled(
    language: Bag,
    grounding: Bag,
    phrase: Ints,
    pairs: NDArray[np.bool_],
    correspondences: tuple[Correspondence, ...],
    rng: np.random.Generator,
) -> Rows:
    factor = LogLinearFactor(pairs, correspondences)
    factor.set_weight(rng.normal(size=tuple(factor.weight.shape)) * pairs)
    chances = factor.log_psi(language, grounding, phrase).exp().numpy()
    label = (rng.random((len(phrase), 1)) > chances.cumsum(axis=1)).sum(axis=1).clip(0, len(correspondences) - 1)
    return Rows(language, grounding, phrase, label, pairs, correspondences)


def ours(rows: Rows, solver: str = "auto") -> LogLinearFactor:
    """From labelled rows to weights."""
    factor = rows.factor()
    weight = np.ones(len(rows.phrase))
    design = merge(rows.language, rows.grounding, rows.phrase, rows.label, weight, len(rows.correspondences))
    fit(factor, [design], l2=L2, tolerance=TOLERANCE, max_steps=5_000, solver=solver)  # type: ignore[arg-type]
    return factor


def peers(rows: Rows) -> Iterator[tuple[str, Callable[[], Floats]]]:
    """Name, and what finds the weights (P, L, G), of every peer that can be asked for so many rows."""
    count = len(rows.phrase)
    if count <= _SLOW["torch"]:
        yield "torch L-BFGS", lambda: ours(rows, "lbfgs-torch").weight.numpy()
    try:
        from sklearn.linear_model import LogisticRegression
    except ImportError:
        return
    design = _written_out(rows)
    used = np.unique(design.indices)
    narrow, shape = design[:, used], (len(rows.correspondences), *rows.pairs.shape)
    two = len(rows.correspondences) == 2
    for solver in ("lbfgs", "newton-cg", "newton-cholesky"):
        if count > _SLOW.get(solver, count):
            continue

        def run(solver: str = solver) -> Floats:
            model: Any = LogisticRegression(
                C=(2.0 if two else 1.0) / L2, fit_intercept=False, solver=solver, tol=TOLERANCE / count, max_iter=5_000
            )
            model.fit(narrow, rows.label)
            weight = np.zeros((shape[0], shape[1] * shape[2]))
            weight[:, used] = np.concatenate([-model.coef_, model.coef_]) / 2 if two else model.coef_
            centred: Floats = (weight - weight.mean(axis=0)).reshape(shape)
            return centred

        yield f"scikit-learn {solver}", run


def _written_out(rows: Rows) -> Any:
    """(n, L * G) scikit-learn's design matrix."""
    from scipy.sparse import csr_array

    count, groundings = len(rows.phrase), rows.pairs.shape[1]
    columns = (rows.language[rows.phrase][:, :, None] * groundings + rows.grounding[:, None, :]).reshape(count, -1)
    kept = rows.pairs.reshape(-1)[columns]
    starts = np.concatenate([[0], np.cumsum(kept.sum(axis=1))])
    return csr_array((np.ones(int(starts[-1])), columns[kept], starts), (count, rows.pairs.size))


def bench_fit(kind: str, count: int, repeats: int, goal: float | None = None) -> Iterator[Result]:
    """The fit of `count` rows of a kind ("dense" or "sparse"), and each peer's time and gradient."""
    rows = (dense_rows if kind == "dense" else sparse_rows)(count, np.random.default_rng(count))
    what = f"{count:,} {kind} rows"
    mine = repeated(f"fit, {what}", lambda: ours(rows), repeats)
    yield mine
    yield result(f"fit, {what}: memory beyond the input", [_peak(lambda: ours(rows))], "MB", goal=60)
    yield result(f"fit, {what}: gradient", [_gradient(rows, ours(rows).weight.numpy())], "max-norm")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # scikit-learn tells of steps that no longer lower its objective
        for name, run in peers(rows):
            first = [np.zeros(0)]

            def keep(run: Callable[[], Floats] = run, first: list[Floats] = first) -> None:
                first[0] = run()

            theirs = result(f"{name}, {what}", [milliseconds(keep) for _ in range(max(1, repeats // 2))])
            yield theirs
            yield result(f"{name}, {what}: gradient", [_gradient(rows, first[0])], "max-norm")
            own_goal = goal if name == "scikit-learn lbfgs" else None
            yield result(f"fit over {name}, {what}", [mine.median / theirs.median], "ratio", goal=own_goal)


def _gradient(rows: Rows, weight: Floats) -> float:
    """Max-norm of the objective's gradient at some weights."""
    factor = rows.factor()
    factor.set_weight(weight)
    ones = np.ones(len(rows.phrase))
    design = merge(rows.language, rows.grounding, rows.phrase, rows.label, ones, len(rows.correspondences))
    return float(np.abs(objective_at(factor, [design], L2)[1]).max())


def _peak(work: Callable[[], object]) -> float:
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
