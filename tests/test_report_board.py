"""TensorBoard: what is written is read back; steps count from 1; HParams show what varies."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from report_rows import row, run, timing, write_run
from tensorboard.backend.event_processing.event_accumulator import (  # type: ignore[import-untyped]
    STORE_EVERYTHING_SIZE_GUIDANCE,
    EventAccumulator,
)
from tensorboard.plugins.hparams.plugin_data_pb2 import HParamsPluginData  # type: ignore[import-untyped]

from dcg_torch.report import figures
from dcg_torch.report.board import write_board
from dcg_torch.report.measures import measure
from dcg_torch.report.runs import varied_settings
from dcg_torch.report.seconds import PHASES

NOTHING = row(correct=False, chosen=None, arrived=None, probability=None, grounded=None)


def read_board(directory: Path) -> Any:
    events = EventAccumulator(str(directory), size_guidance=STORE_EVERYTHING_SIZE_GUIDANCE)
    events.Reload()
    return events


def hparams_of(directory: Path) -> dict[str, object]:
    content = read_board(directory).SummaryMetadata("_hparams_/session_start_info").plugin_data.content
    given = HParamsPluginData.FromString(content).session_start_info.hparams
    return {key: getattr(value, value.WhichOneof("kind")) for key, value in given.items()}


def curve(events: Any, tag: str) -> dict[int, float]:
    scalars = events.Scalars(tag)
    found = {s.step: s.value for s in scalars}
    assert len(found) == len(scalars)
    return found


def test_board_reads_back(tmp_path: Path) -> None:
    rows = run(4, 3)
    times = [timing(r.trial, r.iteration, train=0.1 * (r.trial + 1), train_loss=float(r.iteration)) for r in rows]
    paths = figures.save_figures(rows, times, tmp_path / "figures", beside_paper=False)
    write_board(tmp_path, rows, times, {}, paths)
    write_board(tmp_path, rows, times, {}, paths)  # again, as after a rerun: nothing doubles
    assert len(list(tmp_path.rglob("*tfevents*"))) == 1
    events, measures = read_board(tmp_path), measure(rows)
    first, second, third = measures.by_iteration
    expected = {1: first.accuracy.value, 2: second.accuracy.value, 3: third.accuracy.value}
    assert curve(events, "accuracy/all") == pytest.approx(expected)
    assert curve(events, "seconds/train") == pytest.approx(dict.fromkeys((1, 2, 3), 0.25))  # mean of 0.1 to 0.4
    assert curve(events, "training/loss") == {1: 0.0, 2: 1.0, 3: 2.0}
    assert curve(events, "run/accuracy") == pytest.approx({3: measures.accuracy.value})
    tags = set(events.Tags()["scalars"])
    assert {f"seconds/{phase}" for phase in PHASES} <= tags
    assert {"training/steps", "features/language_columns", "effort/questions", "symbols/right"} <= tags
    assert set(events.Tags()["images"]) == {f"figures/{p.stem}" for p in paths}
    assert events.Images("figures/accuracy")[0].encoded_image_string == paths[0].read_bytes()
    assert "custom_scalars__config__" in events.Tags()["tensors"]


def test_hparams_are_what_varies(tmp_path: Path) -> None:
    """Of a sweep over model and seed with more overrides that all its runs share, and that change no trial."""
    overrides = ["model=dcg", "+seed=3", "trials=30", "model.l2=1e-4", "color_rate=0.5", "workers=2", "known=[cube]"]
    folder = write_run(tmp_path, [NOTHING], overrides=overrides)
    (folder / ".hydra" / "hydra.yaml").write_text(
        "hydra: {job: {config: {override_dirname: {exclude_keys: [color_rate, workers]}}}}"
    )
    write_board(folder, [NOTHING], [], varied_settings(folder))
    assert hparams_of(folder) == {"model": "dcg", "seed": 3.0, "model.l2": 1e-4, "known": "[cube]"}
    assert varied_settings(tmp_path / "nowhere") == {}


def test_board_leaves_others_files_alone(tmp_path: Path) -> None:
    other = tmp_path / "events.out.tfevents.1.elsewhere"
    other.write_bytes(b"")
    write_board(tmp_path / "new", [NOTHING], [], {})
    write_board(tmp_path, [NOTHING], [timing(train_loss=float("nan"))], {})
    assert other.is_file()
    assert "training/loss" not in read_board(tmp_path).Tags()["scalars"]
