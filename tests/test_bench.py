"""What benchmarks measure is what they say, and the page of them is whole."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from dcg_torch.bench.fits import ours, peak
from dcg_torch.bench.learning import knowing
from dcg_torch.bench.page import main
from dcg_torch.bench.peers import L2, peers
from dcg_torch.bench.result import Result, result, shown_number
from dcg_torch.bench.rows import Rows, dense_rows, sparse_rows
from dcg_torch.fitting.design import merge
from dcg_torch.fitting.fit import objective_at

MACHINE = {"python": "3.11", "processors": 2, "load": 0.5}


def gradient(rows: Rows, weight: np.ndarray) -> float:
    factor = rows.factor()
    factor.set_weight(weight)
    ones = np.ones(len(rows.phrase))
    design = merge(rows.language, rows.grounding, rows.phrase, rows.label, ones, len(rows.correspondences))
    return float(np.abs(objective_at(factor, [design], L2)[1]).max())


@pytest.mark.parametrize("rows", [dense_rows(60, np.random.default_rng(0)), sparse_rows(60, np.random.default_rng(0))])
def test_peers_have_our_objective(rows: Rows) -> None:
    """At the weights that each of them finds its gradient is small; that of no fit at all is not."""
    assert gradient(rows, rows.factor().weight.numpy()) > 0.5
    assert gradient(rows, ours(rows).weight.numpy()) < 1e-5
    found = {peer.name: peer.run() for peer in peers(rows, lambda: ours(rows, "lbfgs-torch").weight.numpy())}
    assert "torch L-BFGS" in found
    for name, weight in found.items():
        assert weight is None or gradient(rows, weight) < 1e-2, name


def test_a_fit_of_many_rows_takes_little_beside_them() -> None:
    """60 MB beside a million sparse rows, which take 77 MB themselves, is the goal; few take more for each."""
    rows = sparse_rows(100_000, np.random.default_rng(1))
    ours(rows)  # what is imported at the first time is not the fit's
    own = sum(part.nbytes for part in (rows.language, rows.grounding, rows.phrase, rows.label)) / 2**20
    assert peak(lambda: ours(rows)) < 2.6 * own


@pytest.mark.parametrize("told", [True, False])
def test_the_model_of_the_learning_benchmark_knows_its_words(told: bool) -> None:
    model = knowing(40, np.random.default_rng(0), told=told)
    likeliest = {word: max(of, key=of.__getitem__) for word in model.symbols if (of := model.beliefs_of(word))}
    assert sum(likeliest.get(f"word{k}") == f"type {k}" for k in range(40)) >= (40 if told else 30)
    assert model.fitted is not None
    assert model.fitted.status == "converged"


def written(path: Path, results: list[Result]) -> Path:
    path.write_text(json.dumps({"machine": MACHINE, "benchmarks": [asdict(r) for r in results]}), encoding="utf-8")
    return path


def test_the_page_has_every_figure_the_ratios_and_the_curves(tmp_path: Path) -> None:
    results = [
        result("importing torch", [3000.0], "ms CPU"),
        *(result(f"fit, {n} rows", [n / 7], curve="Fit, ms by rows: ours", at=n) for n in (10, 1000)),
        result("fit over a peer, 10 rows", [0.25], "ratio"),
        result("learn with 10 words", [1.5, 2.5, 9.5], "ms CPU", goal=4.0),
    ]
    assert main([str(written(tmp_path / "bench.json", results)), str(tmp_path)]) == 0
    text = (tmp_path / "performance.md").read_text(encoding="utf-8")
    assert "| learn with 10 words | 2.5 | 1.5 | 9.5 | ms CPU | 3 | 4 |" in text
    assert "| 10 rows | 0.25 |" in text
    assert "2.5 ms here" in text  # what a goal of 1 ms means on this machine
    assert "](pictures/performance_fit_ms_by_rows.svg)" in text
    assert (tmp_path / "pictures" / "performance_fit_ms_by_rows.svg").read_bytes().startswith(b"<?xml")


def test_a_file_of_something_else_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "bench.json").write_text('{"machine": 1}', encoding="utf-8")
    with pytest.raises(SystemExit) as ended:
        main([str(tmp_path / "bench.json"), str(tmp_path)])
    assert ended.value.code == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "make bench" in told


@pytest.mark.parametrize(
    ("value", "shown"), [(6010.4, "6,010"), (999.4, "999"), (0.85614, "0.856"), (-20_800.0, "-20,800")]
)
def test_no_number_needs_an_exponent(value: float, shown: str) -> None:
    assert shown_number(value) == shown
