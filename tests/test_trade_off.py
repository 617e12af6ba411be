"""The figure of accuracy against questions."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from report_rows import row

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
    assert "error" in capsys.readouterr().err
