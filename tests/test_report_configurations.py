"""Runs over seeds as configurations, paired differences on the same commands, and the CSV file."""

from __future__ import annotations

import math
from pathlib import Path

import pandas as pd
import pytest
from report_rows import row, run, thing, write_run

from dcg_torch.report.configurations import Configuration, configurations, distinguish, paired_difference
from dcg_torch.report.export import COLUMNS, to_csv
from dcg_torch.report.measures import measure
from dcg_torch.report.runs import load_run, load_runs


def sweep(directory: Path) -> Path:
    """Two models x three seeds, of two trials each; the better model is right wherever the other is."""
    for seed in range(3):
        worse = [row(t, i, correct=(t + i + seed) % 2 == 0) for t in range(2) for i in range(2)]
        better = [row(t, i, correct=i == 0 or (t + i + seed) % 2 == 0) for t in range(2) for i in range(2)]
        for name, rows in (("dcg", worse), ("open", better)):
            folder = directory / f"model={name},seed={seed}"
            write_run(folder, rows, overrides=[f"model={name}", f"seed={seed}"], seed=seed, model={"name": name})
    return directory


def by_name(runs: Path) -> dict[str, Configuration]:
    return {c.name: c for c in configurations(load_runs([runs]))}


def test_seeds_are_taken_together_trial_by_trial(tmp_path: Path) -> None:
    found = by_name(sweep(tmp_path))
    assert list(found) == ["dcg", "open"]
    assert [run.seed for run in found["open"].runs] == [0, 1, 2]
    together = found["open"].measures
    # Trials of model open, seed by seed: with t + seed even the second command is wrong, else right.
    means = [0.5, 1.0, 1.0, 0.5, 0.5, 1.0]
    assert together.trial_accuracy == pytest.approx(means)
    deviation = math.sqrt(6 / 5) * 0.25
    half = 2.570582 * deviation / math.sqrt(6)  # Student's t for 5 degrees of freedom
    assert (together.accuracy.low, together.accuracy.high) == pytest.approx((0.75 - half, min(1.0, 0.75 + half)))
    assert [m.n for m in together.by_iteration] == [6, 6]
    assert found["open"].by_seed == pytest.approx([0.75, 0.75, 0.75])


def test_a_seed_is_not_counted_twice(tmp_path: Path) -> None:
    for name in ("first", "again"):
        write_run(tmp_path / name, run(2, 3), seed=4)
    found = configurations(load_runs([tmp_path]))
    assert [c.name for c in found] == ["again", "first"]
    assert [c.measures.trials for c in found] == [2, 2]


def test_what_changes_no_trial_keeps_no_runs_apart(tmp_path: Path) -> None:
    write_run(tmp_path / "a", run(2, 3), seed=0, workers=1, name="a", trials=2)
    write_run(tmp_path / "b", run(4, 3, seed=9), seed=1, workers=2, name="b", trials=4)
    write_run(tmp_path / "c", run(4, 3, seed=9), seed=1, workers=2, name="c", speaker="written")
    first, second = configurations(load_runs([tmp_path]))
    assert (len(first.runs), first.measures.trials, len(second.runs)) == (2, 6, 1)
    assert (first.name, second.name) == ("a", "speaker=written")


def test_unfinished_runs_of_a_sweep_belong_to_their_configuration(tmp_path: Path) -> None:
    sweep(tmp_path)
    cut = tmp_path / "model=dcg,seed=2"
    (cut / "summary.json").rename(cut / "settings.json")
    (cut / "settings.json").write_text('{"seed": 2, "model": {"name": "dcg"}}')
    found = by_name(tmp_path)
    assert [r.name for r in found["dcg"].runs][-1] == "model=dcg,seed=2 (unfinished)"
    assert found["dcg"].measures.trials == 6


def test_difference_is_of_paired_trials(tmp_path: Path) -> None:
    found = by_name(sweep(tmp_path))
    difference = paired_difference(found["dcg"], found["open"])
    assert difference is not None
    assert (difference.trials, difference.commands) == (6, 12)
    assert (difference.first_only, difference.second_only) == (0, 3)
    # Trials with t + seed odd gain their first command, one of two.
    assert difference.accuracy.value == pytest.approx(0.25)
    half = 2.570582 * math.sqrt(6 / 5) * 0.25 / math.sqrt(6)
    assert difference.accuracy.low == pytest.approx(0.25 - half)


def test_only_the_same_commands_are_paired(tmp_path: Path) -> None:
    rows = [row(t, i) for t in range(3) for i in range(2)]

    def against(**changes: object) -> int | None:
        """How many of the six commands pair when one of them is changed."""
        other = [rows[0].model_copy(update=changes), *(r.model_copy(update={"correct": False}) for r in rows[1:])]
        folders = [write_run(tmp_path / "a", rows, model={"name": "a"}), write_run(tmp_path / "b", other)]
        difference = paired_difference(*configurations([load_run(f) for f in folders]))
        return None if difference is None else difference.commands

    assert against() == 6
    assert against(command="go to a cube") == 5
    assert against(objects=(thing("c", "cube", x=3.0),)) == 5
    assert against(world="another") == 5
    one = write_run(tmp_path / "one", rows, model={"name": "a"})
    other_seed = write_run(tmp_path / "other", rows, seed=1)
    assert paired_difference(*configurations([load_run(one), load_run(other_seed)])) is None


def test_runs_are_told_apart_by_settings_or_by_overrides(tmp_path: Path) -> None:
    for k in (0, 1):
        write_run(tmp_path / f"b{k}", run(1, 2), fit={"l2": 0.1 * k, "steps": 9}, seed=k)
    assert distinguish(load_runs([tmp_path])) == ["seed=0 fit.l2=0.0", "seed=1 fit.l2=0.1"]
    for k in (0, 1):
        write_run(tmp_path / f"b{k}", run(1, 2), overrides=[f"+model=m{k}", "trials=3", "~x"], fit={"l2": k}, seed=k)
    assert distinguish(load_runs([tmp_path])) == ["model=m0", "model=m1"]


def test_csv_is_read_by_pandas(tmp_path: Path) -> None:
    sweep(tmp_path)
    write_run(tmp_path / "x, y", [row(probability=None, chosen=None, grounded=None, correct=False)], known=["a", "b"])
    (tmp_path / "runs.csv").write_text(to_csv(load_runs([tmp_path])))
    table = pd.read_csv(tmp_path / "runs.csv")
    assert tuple(table.columns[: len(COLUMNS)]) == COLUMNS
    assert list(table.columns[len(COLUMNS) :]) == ["setting.known", "setting.model.name", "setting.seed"]
    assert len(table) == 7
    means = table.groupby("setting.model.name")["accuracy"].mean()
    assert means.to_dict() == pytest.approx({"dcg": 0.5, "open": 0.75})
    last = table[table["run"] == "x, y"].iloc[0]
    assert pd.isna(last["calibration_error"])
    assert pd.isna(last["accuracy_learned"])
    assert last["setting.known"] == '["a", "b"]'
    assert (last["commands"], last["correct"], last["seed"]) == (1, 0, 0)
    measured = measure([row(t, i, correct=(t + i) % 2 == 0) for t in range(2) for i in range(2)])
    assert table["accuracy_high"][0] == pytest.approx(measured.accuracy.high)
