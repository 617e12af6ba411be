"""Run folders, summaries, tables and the command line of the report."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from report_rows import PAPER, row, run, timings, write_run
from rich.console import Console

from dcg_torch.report.__main__ import main
from dcg_torch.report.measures import measure
from dcg_torch.report.paper import follows_paper
from dcg_torch.report.runs import find_runs, load_run, load_runs, read_rows
from dcg_torch.report.seconds import summarise_seconds
from dcg_torch.report.show import print_several
from dcg_torch.report.summary import ReportError, read_summary, write_summary
from dcg_torch.report.tables import print_errors, print_iterations, print_measures
from dcg_torch.storage.records import Iteration

NOTHING = row(correct=False, chosen=None, arrived=None, probability=None, grounded=None)


def text_of(width: int = 100) -> tuple[Console, io.StringIO]:
    buffer = io.StringIO()
    return Console(file=buffer, width=width), buffer


# --- summary.json


def test_summary_round_trip(tmp_path: Path) -> None:
    rows = run(3, 4)
    folder = write_run(tmp_path / "deep" / "paper", rows, model={"name": "dcg"})
    summary = read_summary(folder / "summary.json")
    assert summary.run == "paper"
    assert summary.config == {"seed": 0, "model": {"name": "dcg"}}
    assert summary.seconds == pytest.approx(summarise_seconds(timings(rows)))
    written = json.loads((folder / "summary.json").read_text())["measures"]
    assert written["accuracy"]["value"] == measure(rows).accuracy.value
    assert len(written["by_iteration"]) == 4
    loaded = load_run(folder)
    assert (loaded.measures, loaded.rows, loaded.seed, loaded.overrides) == (measure(rows), tuple(rows), 0, None)


def test_a_failed_write_leaves_the_old_summary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_run(tmp_path, [row()]) / "summary.json"
    before = path.read_bytes()
    with pytest.raises(ValueError, match="not JSON compliant"):
        write_summary(path, "new", {}, replace(measure([row()]), path_length=float("nan")), {})
    with pytest.raises(TypeError):
        write_summary(path, "new", {"folder": tmp_path}, measure([row()]), {})

    def die(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("os.replace", die)
    files = sorted(tmp_path.iterdir())
    with pytest.raises(KeyboardInterrupt):
        write_summary(path, "new", {}, measure([row()]), {})
    assert path.read_bytes() == before
    assert sorted(tmp_path.iterdir()) == files


# --- run folders


def test_rows_of_a_killed_run(tmp_path: Path) -> None:
    rows = run(1, 3)
    lines = "".join(r.model_dump_json() + "\n" for r in rows)
    path = tmp_path / "iterations.jsonl"
    path.write_text(lines + lines[:100])  # killed while it wrote the next line
    assert read_rows(path) == rows
    assert load_run(tmp_path).measures == measure(rows)
    assert load_run(tmp_path).name == f"{tmp_path.name} (unfinished)"


def test_runs_are_found_by_size_of_their_numbers(tmp_path: Path) -> None:
    for seed in (10, 9, 1):
        write_run(tmp_path / "sweep" / f"seed={seed}", [row()], seed=seed)
    assert [p.name for p in find_runs(tmp_path)] == ["seed=1", "seed=9", "seed=10"]
    assert [r.seed for r in load_runs([tmp_path, tmp_path / "sweep"])] == [1, 9, 10]


def test_an_evaluation_beside_runs_is_no_run(tmp_path: Path) -> None:
    (tmp_path / "evaluate").mkdir()
    for name in ("summary.json", "predictions.jsonl"):
        (tmp_path / "evaluate" / name).write_text("{}")
    with pytest.raises(ReportError, match="evaluations are in it and no run"):
        find_runs(tmp_path)
    write_run(tmp_path / "run", [row()])
    assert find_runs(tmp_path) == [tmp_path / "run"]


LINE = row().model_dump_json()
DAMAGED = [
    ("summary.json", b"{", "summary.json: the file: "),
    ("summary.json", b"{}", "summary.json: run: Field required; run the experiment again"),
    ("summary.json", b'{"run": 3}', "summary.json: run: Input should be"),
    ("summary.json", b"\xff\xfe\x00", "summary.json: the file: "),
    ("summary.json", None, "summary.json: can't be read (Is a directory)"),
    ("iterations.jsonl", b"{}\n", "iterations.jsonl:1: trial: Field required; mend or remove the line"),
    ("iterations.jsonl", LINE.encode() + b"\n\x00\xff\x1b[31m\n", "iterations.jsonl:2: the line: "),
    ("iterations.jsonl", LINE.encode() + b"\n" + LINE[:80].encode() + b"\n", "iterations.jsonl:2: the line: "),
    ("iterations.jsonl", f"{LINE}\n{LINE}\n".encode(), "run: trial 0, iteration 0 comes twice"),
    ("iterations.jsonl", LINE.replace('"target":"c"', '"target":"z"').encode() + b"\n", "'z' is not among"),
    ("iterations.jsonl", LINE.replace("0.9", "NaN").encode() + b"\n", "iterations.jsonl:1: probability: "),
    ("iterations.jsonl", LINE.replace("0.9", "7.5").encode() + b"\n", "a probability is not between 0 and 1"),
    ("iterations.jsonl", b"", "iterations.jsonl: no finished command in it; run the experiment on"),
    ("iterations.jsonl", None, "iterations.jsonl: can't be read (Is a directory)"),
]


@pytest.mark.parametrize(("name", "content", "says"), DAMAGED)
def test_a_damaged_folder_is_one_line(
    name: str, content: bytes | None, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = write_run(tmp_path / "run", [row()])
    (folder / name).unlink()
    if content is None:
        (folder / name).mkdir()
    else:
        (folder / name).write_bytes(content)
    assert main([str(folder)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("dcg_torch: ")
    assert error.count("\n") == 1
    assert says in error
    assert len(error) < 300 + len(str(folder))
    assert error.strip().isprintable()


@pytest.mark.parametrize("damage", [b"\xff\xfe", b"[1, 2]", b"{", b"- !!bool abc", b"- !!timestamp abc", None])
@pytest.mark.parametrize("name", ["settings.json", ".hydra/overrides.yaml", ".hydra/hydra.yaml"])
def test_what_only_names_a_run_may_be_damaged(
    name: str, damage: bytes | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = write_run(tmp_path, [row()], overrides=["model=dcg"])
    (folder / "summary.json").unlink()
    (folder / name).unlink(missing_ok=True)
    if damage is None:
        (folder / name).mkdir()
    else:
        (folder / name).write_bytes(damage)
    assert main([str(folder)]) == 0
    assert "1 command in 1 trial" in capsys.readouterr().out


def test_names_from_files_do_not_steer_the_terminal(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for k, name in enumerate(("a\x1b[31m", "b\n[red]c")):
        write_run(tmp_path / str(k), [row()], model=name)
    assert main([str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert "\x1b" not in out
    assert "b [red]c" in out


# --- tables


def test_the_table_says_the_numbers() -> None:
    measures = measure([row(t, i, correct=i > 0 or t < 3) for t in range(4) for i in range(2)])
    console, buffer = text_of()
    print_measures(measures, console, {"train_max": 0.0304, "ground_max": 1.25}, beside_paper=True)
    text = buffer.getvalue()
    assert "87.5 % [47.7, 100.0]" in text  # 1, 1, 1, 1/2: sd 1/4, 3.182 / 8 to each side
    assert "75-100 % (1 of 2 within 70-90)" in text
    assert "30 ms" in text
    assert "1.2 s" in text
    assert "8 commands in 4 trials" in text
    assert "can't follow from such a draw" in text.replace("\n", " ")


def test_a_custom_world_does_not_stand_beside_the_paper(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    published = ("paper", "70-90 %", "about 87 %", "< 60 s")
    for settings, beside in (
        (PAPER, True),
        ({**PAPER, "worlds": "generated", "speaker": "written", "seed": 7, "trials": 3}, True),
        ({**PAPER, "worlds": "my/worlds"}, False),
        ({**PAPER, "iterations": 3}, False),
        ({**PAPER, "types": 40}, False),
        ({**PAPER, "speaker": "relational"}, False),
        ({}, False),
    ):
        assert follows_paper(settings) == beside
        assert main([str(write_run(tmp_path, [row()], **settings))]) == 0
        out = capsys.readouterr().out
        assert [word in out for word in published] == [beside] * 4, settings


@pytest.mark.parametrize("rows", [[row()], [NOTHING], run(1, 60), run(30, 10)])
@pytest.mark.parametrize("width", [80, 100])
def test_tables_of_odd_runs(rows: list[Iteration], width: int) -> None:
    measures = measure(rows)
    console, buffer = text_of(width)
    print_measures(measures, console, beside_paper=True)
    print_iterations(measures, console)
    print_errors(measures, console)
    text = buffer.getvalue()
    assert max(map(len, text.splitlines())) <= width
    assert "nan" not in text
    assert "None " not in text.replace("None of", "")


def test_errors_table() -> None:
    console, buffer = text_of()
    print_errors(measure([row(0), row(1, correct=False, chosen="c2")]), console)
    (line,) = [line for line in buffer.getvalue().splitlines() if line.strip().startswith("wrong colour")]
    assert line.split()[:5] == ["wrong", "colour", "1", "50.0", "%"]


def sweep(directory: Path) -> Path:
    """Three models x two seeds."""
    for k, model in enumerate(("dcg", "dcg_upup_away", "z_model_with_a_name_of_more_than_forty_letters")):
        for seed in (0, 1):
            rows = [row(t, i, correct=t <= k) for t in range(4) for i in range(10)]
            folder = directory / f"model={model},seed={seed}"
            write_run(folder, rows, overrides=[f"model={model}", f"seed={seed}"], seed=seed, model=model, **PAPER)
    return directory


def lines_of(text: str, title: str) -> list[str]:
    """The lines of a table below its heading."""
    after = text[text.index(title) :].splitlines()
    rule = next(k for k, line in enumerate(after) if "───" in line)
    body = after[rule + 1 :]
    return body[: next(k for k, line in enumerate(body) if not line.strip())]


def test_tables_of_a_sweep_fit_and_pair(tmp_path: Path) -> None:
    console, buffer = text_of(100)
    print_several(load_runs([sweep(tmp_path)]), console)
    text = buffer.getvalue()
    assert max(map(len, text.splitlines())) <= 100
    assert "…" not in text
    first, second, *_ = lines_of(text, "Configurations compared")
    # Two seeds of four trials, of which one is right: mean 1/4, sd sqrt(3/14), t = 2.365 for 7 degrees of freedom.
    assert " ".join(first.split()) == "dcg 2 8 25.0 % [0.0, 63.7] 25-25 3.00 of 5 0.00 0.00 0.650"
    assert second.split()[:4] == ["dcg_upup_away", "2", "8", "50.0"]
    assert len(lines_of(text, "Runs")) >= 6
    difference = next(
        line for line in lines_of(text, "Differences") if line.split()[:3] == ["dcg_upup_away", "-", "dcg"]
    )
    # One trial of four in each seed changes from wrong to right, with its ten commands.
    assert " ".join(difference.split()[3:]) == "8 80 20 / 0 +25.0 [-13.7, +63.7]"


def test_configurations_without_common_commands_have_no_differences(tmp_path: Path) -> None:
    write_run(tmp_path / "a", [row()], seed=0, speaker="x")
    write_run(tmp_path / "b", [row(command="other")], seed=0, speaker="y")
    console, buffer = text_of()
    print_several(load_runs([tmp_path]), console)
    assert "speaker=y" in buffer.getvalue()
    assert "Differences" not in buffer.getvalue()


# --- the command line


def test_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sweep(tmp_path / "sweep")
    one = str(tmp_path / "sweep" / "model=dcg,seed=0")
    assert main([one, "--csv", str(tmp_path / "one.csv"), "--figures", "svg", "--out", str(tmp_path / "out")]) == 0
    assert "The paper's figures" in capsys.readouterr().out
    assert (tmp_path / "one.csv").read_text().count("\n") == 2
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == [
        f"{name}.svg" for name in ("accuracy", "calibration", "errors", "shares", "symbols", "time")
    ]
    assert main([str(tmp_path / "sweep"), one, "--csv", str(tmp_path / "all.csv"), "--figures", "pdf"]) == 0
    out = capsys.readouterr().out
    for part in ("model=dcg seed=1", "Configurations compared", "Differences on the same commands", "comparison.pdf"):
        assert part in out
    assert (tmp_path / "sweep" / "comparison.pdf").read_bytes().startswith(b"%PDF-")
    assert (tmp_path / "all.csv").read_text().count("\n") == 7


def test_command_line_refuses_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "empty").mkdir()
    folder = write_run(tmp_path / "run", [row()])
    file = str(folder / "summary.json")
    for arguments, says in (
        ([str(tmp_path / "nowhere")], "nowhere: no such folder; give the folder of a run"),
        ([file], "summary.json: no such folder"),
        ([str(tmp_path / "empty")], "empty: no run in it"),
        ([str(folder), str(tmp_path / "empty")], "empty: no run in it"),
        ([str(folder), "--figures", "png", "--out", file], "summary.json"),
        ([str(folder), "--csv", f"{file}/x.csv"], "can't be written"),
        ([str(folder), "--csv", str(tmp_path / "empty")], "can't be written"),
        ([str(folder), "--csv", str(tmp_path / ("n" * 300))], "can't be written"),
        ([str(folder), "--out", str(tmp_path)], "--figures"),
        ([str(tmp_path / "no\nsuch\x1b[31m")], "no such?[31m: no such folder"),
    ):
        assert main(arguments) == 2
        error = capsys.readouterr().err
        assert error.startswith("dcg_torch: ")
        assert error.count("\n") == 1
        assert says in error
    assert list((tmp_path / "empty").iterdir()) == []


def test_module_runs_without_torch_or_matplotlib(tmp_path: Path) -> None:
    sweep(tmp_path)
    code = (
        "import sys; from dcg_torch.report.__main__ import main; main([sys.argv[1], '--csv', sys.argv[1] + '/x.csv']); "
        "print([m for m in ('torch', 'matplotlib', 'pybullet', 'spacy', 'hydra') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_a_pipe_that_closes_is_one_line(tmp_path: Path) -> None:
    sweep(tmp_path)
    for arguments in (["--help"], [str(tmp_path)]):
        read_end, write_end = os.pipe()
        os.close(read_end)
        typed = ["env", "-u", "PYTHONUNBUFFERED", sys.executable, "-m", "dcg_torch.report", *arguments]
        done = subprocess.run(typed, stdout=write_end, stderr=subprocess.PIPE, text=True, check=False)
        os.close(write_end)
        assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
        assert "standard output was closed" in done.stderr


@pytest.mark.parametrize("arguments", [["--help"], []])
def test_an_output_without_room_or_closed_is_one_line(tmp_path: Path, arguments: list[str]) -> None:
    sweep(tmp_path)
    typed = ["env", "-u", "PYTHONUNBUFFERED", sys.executable, "-m", "dcg_torch.report", *(arguments or [str(tmp_path)])]
    with open("/dev/full", "w") as full:  # argparse itself passes over an unbuffered help that finds no room
        done = subprocess.run(typed, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
    assert "No space left" in done.stderr
    shut = subprocess.run(["sh", "-c", 'exec "$@" >&-', "sh", *typed], stderr=subprocess.PIPE, text=True, check=False)
    assert (shut.returncode, shut.stderr.count("\n")) == (2, 1), shut.stderr
    assert "standard output is closed" in shut.stderr
