"""`dcg-torch pretrain`: the shipped model made anew, by one process at a time, and errors in one line."""

from __future__ import annotations

from pathlib import Path

import pytest
from making import typed

from dcg_torch.cli.commands import main
from dcg_torch.model import GroundingModel
from dcg_torch.model.checkpoint import DESCRIPTION, WEIGHTS, load
from dcg_torch.storage.claim import claim


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch, trained: GroundingModel) -> None:
    """As if a model took no time to train."""
    monkeypatch.setattr("dcg_torch.cli.pretrain.train_open_world", lambda training, lessons: trained)


@pytest.mark.usefixtures("quick")
def test_it_writes_a_model(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "new" / "model"
    for _ in range(2):
        status, out, _ = typed(capsys, main, "dcg-torch", "pretrain", "--out", str(folder))
        assert (status, out.startswith(f"{folder}: ")) == (0, True)
        assert sorted(p.name for p in folder.iterdir()) == sorted((DESCRIPTION, WEIGHTS))
    assert load(folder).symbols


@pytest.mark.usefixtures("quick")
def test_errors_are_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    other, taken = tmp_path / "other", tmp_path / "taken"
    other.mkdir()
    (other / "thesis.tex").touch()
    with claim(taken):
        for arguments, says in (
            (["--lessons", "-1"], "from 0 to"),
            (["--lessons", "many"], "invalid int value"),
            (["--out", str(other)], "holds other files"),
            (["--out", "/dev/null"], "no folder"),
            (["--out", str(taken)], "another process works in this folder"),
        ):
            status, out, err = typed(capsys, main, "dcg-torch", "pretrain", *arguments)
            assert (status, out, err.count("\n")) == (2, "", 1), err
            assert says in err
    assert [p.name for p in other.iterdir()] == ["thesis.tex"]
