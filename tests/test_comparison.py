"""The page that shows the project beside the baselines."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest

from dcg_torch.bench.comparison import BEGIN, END, ComparisonError, main, placed, read_summary, tables


def of_file(n: int, right: int, **more: Any) -> dict[str, Any]:
    return {"n": n, "accuracy": right / n, "ci95": [0.25, 0.75], "calibration_error": 0.1, **more}


def summary(**more: Any) -> dict[str, Any]:
    """Two files: the project is ahead in one, a baseline in the other."""
    baseline = {"by_file": {"a": of_file(10, 4), "b": of_file(4, 4)}, "n": 14, "calibration_error": None}
    own = {"by_file": {"a": of_file(10, 8), "b": of_file(4, 3)}, "n": 14, "calibration_error": 0.05}
    return {**own, "baselines": {"overlap": {**baseline, **more}}, **more}


def test_the_best_is_marked_and_who_is_ahead_is_named() -> None:
    lines = list(tables("As it comes", summary()))
    assert "| a | 10 | **80.0** [25.0, 75.0] | 40.0 |" in lines
    assert "| b | 4 | 75.0 [25.0, 75.0] | **100.0** |" in lines
    assert "Ahead of this project: overlap in b." in lines
    assert "| calibration error, all | 14 | 0.050 | - |" in lines


def test_what_was_certified_has_a_table_of_its_own() -> None:
    changes = {"color": {"applicable": 9, "n": 8, "right": 6}, "side": {"applicable": 0, "n": 0, "right": 0}}
    lines = list(tables("As it comes", summary(certify=changes)))
    assert "| color | 75.0 of 8 | 75.0 of 8 |" in lines
    assert "| side | - | - |" in lines


def test_the_rest_of_a_page_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / "page.md"
    page.write_text(f"# Title\n\n{BEGIN}\nold\n{END}\n\nThe end.\n")
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "summary.json").write_text(json.dumps(summary()))
    monkeypatch.setattr(sys, "argv", ["comparison", f"Shipped={tmp_path / 'run'}", "--out", str(page)])
    assert main() == 0
    text = page.read_text()
    assert text.startswith(f"# Title\n\n{BEGIN}\n\n### Shipped\n")
    assert text.endswith(f"\n{END}\n\nThe end.\n")
    assert "old" not in text
    before = text
    assert main() == 0
    assert page.read_text() == before


@pytest.mark.parametrize(
    "content", ["{", "[]", "{}", json.dumps({"baselines": {}, "by_file": {}}), json.dumps({"baselines": {"x": {}}})]
)
def test_what_is_no_comparison_is_refused(tmp_path: Path, content: str) -> None:
    (tmp_path / "summary.json").write_text(content)
    with pytest.raises(ComparisonError) as error:
        read_summary(tmp_path)
    assert "\n" not in str(error.value)


def test_a_page_without_a_place_is_refused() -> None:
    for page in ("# Title\n", f"{END}\n{BEGIN}\n"):
        with pytest.raises(ComparisonError, match="no place"):
            placed(page, ["x"], Path("page.md"))
