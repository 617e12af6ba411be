"""Figures, TensorBoard, summaries, tables and the command line."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image
from report_rows import row, run, timing, timings
from rich.console import Console
from rich.table import Table
from tensorboard.backend.event_processing.event_accumulator import (  # type: ignore[import-untyped]
    STORE_EVERYTHING_SIZE_GUIDANCE,
    EventAccumulator,
)

from dcg_torch.records import Iteration
from dcg_torch.report import figures
from dcg_torch.report.__main__ import main
from dcg_torch.report.board import write_board
from dcg_torch.report.measures import measure
from dcg_torch.report.seconds import PHASES, summarise_seconds
from dcg_torch.report.summary import ReportError, find_runs, load_run, read_rows, read_summary, write_summary
from dcg_torch.report.tables import print_comparison, print_errors, print_iterations, print_paper_table, tabulate_sweep

NAMES = ["accuracy", "symbols", "shares", "errors", "calibration"]
NOTHING = row(correct=False, chosen=None, arrived=None, probability=None, grounded=None)


def written(directory: Path, name: str = "paper", **config: Any) -> Path:
    rows = run(3, 4)
    path = directory / "summary.json"
    write_summary(path, name, {"seed": 0, **config}, measure(rows), summarise_seconds(timings(rows)), wall=1.5)
    return path


def text_of(width: int = 140) -> tuple[Console, io.StringIO]:
    buffer = io.StringIO()
    return Console(file=buffer, width=width), buffer


# --- figures


def test_figures_are_written_and_show_something(tmp_path: Path) -> None:
    before = {k: v for k, v in mpl.rcParams.items() if k != "backend"}  # resolved on being looked at
    rows = run(4, 3)
    paths = figures.save_figures(rows, timings(rows), tmp_path / "figures")
    assert [p.stem for p in paths] == [*NAMES, "time"]
    for path in paths:
        with Image.open(path) as image:
            assert min(image.size) >= 375
            assert len(np.unique(np.asarray(image.convert("L")))) > 20
    assert {k: v for k, v in mpl.rcParams.items() if k != "backend"} == before


@pytest.mark.parametrize("rows", [[row()], [NOTHING], run(1, 120), run(2, 1)], ids=["one", "nothing", "long", "two"])
def test_figures_of_odd_runs(rows: list[Iteration], tmp_path: Path) -> None:
    assert [p.stem for p in figures.save_figures(rows, [], tmp_path)] == NAMES


def test_accuracy_figure_draws_the_measured_values() -> None:
    measures = measure([row(t, i, correct=t >= i) for t in range(4) for i in range(3)])
    axes = figures.draw_accuracy(measures).axes[0]
    curve = next(line for line in axes.lines if line.get_label() == "right object")
    np.testing.assert_allclose(np.asarray(curve.get_xydata(), np.float64), np.array([[1, 1], [2, 0.75], [3, 0.5]]))


def test_symbols_figure_starts_at_what_was_known() -> None:
    axes = figures.draw_symbols(measure(run(5, 4))).axes[0]
    for label in ("types named rightly", "if all met were learned"):
        curve = next(line for line in axes.lines if line.get_label() == label)
        assert tuple(np.asarray(curve.get_xydata())[0]) == (0, 3)


def test_long_runs_are_rolling_means() -> None:
    # 100 commands, right from the 51st on; windows of 5 are cut at the ends.
    measures = measure([row(0, i, correct=i >= 50) for i in range(100)])
    axes = figures.draw_accuracy(measures).axes[0]
    curve = next(line for line in axes.lines if line.get_label() == "right object (mean of 5)")
    y = np.asarray(curve.get_ydata())
    assert y[0] == 0
    assert y[-1] == 1
    np.testing.assert_allclose(y[47:53], [0, 0.2, 0.4, 0.6, 0.8, 1])


def test_comparison_of_runs(tmp_path: Path) -> None:
    runs = {name: measure(run(3, 4, skill=skill)) for name, skill in (("a", 0.5), ("b", 1.0))}
    assert figures.save_comparison(runs, tmp_path / "new" / "comparison.png").is_file()
    figures.draw_comparison({"long": measure(run(1, 60)), "one": measure([row()])})
    with pytest.raises(ValueError, match="no runs"):
        figures.draw_comparison({})


# --- TensorBoard


def read_board(directory: Path) -> Any:
    events = EventAccumulator(str(directory), size_guidance=STORE_EVERYTHING_SIZE_GUIDANCE)
    events.Reload()
    return events


def test_board_reads_back(tmp_path: Path) -> None:
    rows = run(4, 3)
    times = [timing(r.trial, r.iteration, train=0.1 * (r.trial + 1), train_loss=float(r.iteration)) for r in rows]
    paths = figures.save_figures(rows, times, tmp_path / "figures")
    hparams = {"model": {"name": "dcg", "l2": 1e-4}, "seed": 3, "known": ["cube"], "gui": False, "nothing": None}
    write_board(tmp_path, rows, times, hparams, paths)
    write_board(tmp_path, rows, times, hparams, paths)  # again, as after a rerun: nothing doubles
    assert len(list(tmp_path.rglob("*tfevents*"))) == 1
    events, measures = read_board(tmp_path), measure(rows)

    def curve(tag: str) -> dict[int, float]:
        scalars = events.Scalars(tag)
        found = {s.step: s.value for s in scalars}
        assert len(found) == len(scalars)
        return found

    expected = {m.iteration: m.accuracy.value for m in measures.by_iteration}
    assert curve("accuracy/all") == pytest.approx(expected)
    assert curve("symbols/expected") == pytest.approx({m.iteration: m.expected_symbols for m in measures.by_iteration})
    assert curve("seconds/train") == pytest.approx(dict.fromkeys(range(3), 0.25))  # mean of 0.1, 0.2, 0.3, 0.4
    assert curve("training/loss") == {0: 0.0, 1: 1.0, 2: 2.0}
    assert curve("run/accuracy") == pytest.approx({0: measures.accuracy.value})
    tags = set(events.Tags()["scalars"])
    assert {f"seconds/{phase}" for phase in PHASES} <= tags
    assert {"training/steps", "features/language_columns", "effort/questions", "symbols/right"} <= tags
    assert set(events.Tags()["images"]) == {f"figures/{p.stem}" for p in paths}
    assert events.Images("figures/accuracy")[0].encoded_image_string == paths[0].read_bytes()
    assert "custom_scalars__config__" in events.Tags()["tensors"]

    from tensorboard.plugins.hparams.plugin_data_pb2 import HParamsPluginData  # type: ignore[import-untyped]

    content = events.SummaryMetadata("_hparams_/session_start_info").plugin_data.content
    settings = HParamsPluginData.FromString(content).session_start_info.hparams
    assert settings["model.name"].string_value == "dcg"
    assert settings["seed"].number_value == 3
    assert settings["known"].string_value == "['cube']"
    assert settings["nothing"].string_value == "None"


def test_board_leaves_others_files_alone(tmp_path: Path) -> None:
    other = tmp_path / "events.out.tfevents.1.elsewhere"
    other.write_bytes(b"")
    write_board(tmp_path / "new", [NOTHING], [], {})
    write_board(tmp_path, [NOTHING], [timing(train_loss=float("nan"))], {})
    assert other.is_file()
    assert "training/loss" not in read_board(tmp_path).Tags()["scalars"]


# --- summary.json


def test_summary_round_trip(tmp_path: Path) -> None:
    rows = run(3, 4)
    summary = read_summary(written(tmp_path / "deep" / "run", model={"name": "dcg"}))
    assert summary.run == "paper"
    assert summary.config == {"seed": 0, "model": {"name": "dcg"}}
    assert summary.measures == measure(rows)
    assert summary.seconds == pytest.approx(summarise_seconds(timings(rows)))
    assert summary.model_extra == {"wall": 1.5}


def test_a_failed_write_leaves_the_old_summary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(tmp_path)
    before = path.read_bytes()
    measures = replace(measure([row()]), path_length=float("nan"))
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_summary(path, "new", {}, measures, {})
    with pytest.raises(TypeError):
        write_summary(path, "new", {"folder": tmp_path}, measure([row()]), {})

    def die(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("os.replace", die)
    with pytest.raises(KeyboardInterrupt):
        write_summary(path, "new", {}, measure([row()]), {})
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("content", "says"), [("{", "the file"), ("{}", "run: Field required"), ('{"run": 3}', "run: Input should be")]
)
def test_a_broken_summary_is_named(content: str, says: str, tmp_path: Path) -> None:
    path = tmp_path / "summary.json"
    path.write_text(content)
    with pytest.raises(ReportError, match="run the experiment again") as caught:
        read_summary(path)
    assert says in str(caught.value)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_rows_of_a_killed_run(tmp_path: Path) -> None:
    rows = run(1, 3)
    lines = "".join(r.model_dump_json() + "\n" for r in rows)
    path = tmp_path / "iterations.jsonl"
    path.write_text(lines + lines[:100])  # killed while it wrote the next line
    assert read_rows(path) == rows
    assert load_run(tmp_path).measures == measure(rows)
    path.write_text("{}\n" + lines)
    with pytest.raises(ReportError, match=r"iterations\.jsonl:1: trial: Field required"):
        read_rows(path)
    path.write_text("")
    with pytest.raises(ReportError, match="no finished command"):
        load_run(tmp_path)


# --- tables


def test_paper_table_says_the_numbers() -> None:
    measures = measure([row(t, i, correct=i > 0 or t < 3) for t in range(4) for i in range(2)])
    console, buffer = text_of()
    print_paper_table(measures, console, {"train_max": 0.0304, "ground_max": 1.25})
    text = buffer.getvalue()
    assert "87.5 % [47.7, 100.0]" in text  # 1, 1, 1, 1/2: sd 1/4, 3.182 / 8 to each side
    assert "75-100 % (1 of 2 within 70-90)" in text
    assert "30 ms" in text
    assert "1.2 s" in text
    assert "8 commands in 4 trials" in text
    assert "can't follow from such a draw" in text


@pytest.mark.parametrize("rows", [[row()], [NOTHING], run(1, 60), run(30, 10)])
@pytest.mark.parametrize("width", [80, 140])
def test_tables_of_odd_runs(rows: list[Iteration], width: int) -> None:
    measures = measure(rows)
    console, buffer = text_of(width)
    print_paper_table(measures, console)
    print_iterations(measures, console)
    print_errors(measures, console)
    print_comparison({"a": measures, "b": measures}, console)
    text = buffer.getvalue()
    assert max(map(len, text.splitlines())) <= width
    assert "nan" not in text
    assert "None " not in text.replace("None of", "")


def test_errors_table() -> None:
    console, buffer = text_of()
    print_errors(measure([row(0), row(1, correct=False, chosen="c2")]), console)
    (line,) = [line for line in buffer.getvalue().splitlines() if line.strip().startswith("wrong colour")]
    assert line.split()[:5] == ["wrong", "colour", "1", "50.0", "%"]


def test_comparison_pairs_by_trial() -> None:
    worse = measure([row(t, i, correct=t != 0) for t in range(3) for i in range(2)])
    better = measure([row(t, i) for t in range(3) for i in range(2)])
    other = measure([row(t, 0) for t in range(3)])
    console, buffer = text_of()
    print_comparison({"worse": worse, "better": better, "other": other}, console)
    lines = {line.split()[0]: line for line in buffer.getvalue().splitlines() if line.strip()}
    assert "+33.3 [-110.1, +176.8]" in lines["better"]
    assert "+" not in lines["worse"] + lines["other"]


def cells(table: Table) -> list[list[str]]:
    return [list(column) for column in zip(*(list(c.cells) for c in table.columns), strict=True)]


def test_sweep_tells_runs_apart_by_configuration(tmp_path: Path) -> None:
    for seed in (0, 1):
        written(tmp_path / f"b{seed}", f"run{seed}", fit={"l2": 0.1 * seed, "steps": 9}, seed=seed)
    told = cells(tabulate_sweep(tmp_path))
    assert [line[:2] for line in told] == [["run0", "seed=0 fit.l2=0.0"], ["run1", "seed=1 fit.l2=0.1"]]


def test_sweep_prefers_hydra_s_overrides(tmp_path: Path) -> None:
    for model in ("dcg", "open"):
        folder = written(tmp_path / "sweep" / model, model, depth={"a": model}).parent
        (folder / ".hydra").mkdir()
        (folder / ".hydra" / "overrides.yaml").write_text(f"- model={model}\n- trials=3\n")
    assert [line[1] for line in cells(tabulate_sweep(tmp_path))] == ["model=dcg", "model=open"]
    assert find_runs(tmp_path) == [tmp_path / "sweep" / "dcg", tmp_path / "sweep" / "open"]


# --- the command line


def test_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written(tmp_path / "a", "a")
    written(tmp_path / "b", "b", seed=1)
    assert main([str(tmp_path / "a")]) == 0
    assert "The paper's figures" in capsys.readouterr().out
    assert main([str(tmp_path), "--compare", str(tmp_path / "c.png")]) == 0
    out = capsys.readouterr().out
    assert "seed=1" in out
    assert "Runs compared" in out
    assert (tmp_path / "c.png").is_file()
    assert main([str(tmp_path / "a"), str(tmp_path / "b")]) == 0


def test_command_line_refuses_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "empty").mkdir()
    written(tmp_path / "run")
    for arguments in (
        [str(tmp_path / "nowhere")],
        [str(tmp_path / "empty")],
        [str(tmp_path / "run"), str(tmp_path / "empty")],
        [str(tmp_path / "run"), "--compare", str(tmp_path / "run" / "summary.json" / "x.png")],
    ):
        assert main(arguments) == 2
        error = capsys.readouterr().err
        assert error.startswith("error: ")
        assert error.count("\n") == 1


def test_module_runs_without_torch_or_matplotlib(tmp_path: Path) -> None:
    written(tmp_path)
    code = (
        "import sys; from dcg_torch.report.__main__ import main; main([sys.argv[1]]); "
        "print([m for m in ('torch', 'matplotlib', 'pybullet', 'spacy', 'hydra') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
    json.loads((tmp_path / "summary.json").read_text())
