"""The figure of accuracy against questions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from report_rows import row, write_run

from dcg_torch.report.measures import measure
from dcg_torch.report.trade_off import draw_trade_off, main


def test_a_point_for_every_threshold() -> None:
    runs = {
        0.0: measure([row(0), row(1, correct=False, chosen="d")]),
        0.75: measure([row(0, asked=1), row(1)]),
    }
    line = draw_trade_off(runs).axes[0].get_lines()[0]
    assert np.asarray(line.get_xdata()).tolist() == [0.0, 0.5]
    assert np.asarray(line.get_ydata()).tolist() == [0.5, 1.0]


def test_nothing_to_draw_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ValueError, match="no runs"):
        draw_trade_off({})
    assert main([str(tmp_path / "none"), "--out", str(tmp_path / "x.png")]) == 2
    assert "no such folder" in capsys.readouterr().err


def test_from_run_folders(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_run(tmp_path / "runs" / "never", [row()], asking="never")
    write_run(
        tmp_path / "runs" / "asks", [row(asked=1)], asking="when_unsure", model={"open_world": {"ask_below": 0.75}}
    )
    assert main([str(tmp_path / "runs"), "--out", str(tmp_path / "x.svg")]) == 0
    assert (tmp_path / "x.svg").is_file()
    assert main([str(tmp_path / "runs"), "--out", str(tmp_path / "x.jpg")]) == 2
    assert "png, pdf, svg" in capsys.readouterr().err
    write_run(tmp_path / "runs" / "odd", [row()], asking="when_unsure", model={"name": "m"})
    assert main([str(tmp_path / "runs"), "--out", str(tmp_path / "x.png")]) == 2
    assert "odd: its settings don't say model.open_world.ask_below" in capsys.readouterr().err
