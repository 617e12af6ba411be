"""There is one model: no subclass of it, no question what kind it is, and every program makes the same one."""

from __future__ import annotations

import ast
import json
from pathlib import Path

import numpy as np
import pytest
from episode_making import COLORS, episode, write
from making import typed

from dcg_torch import evaluate
from dcg_torch.cli import commands
from dcg_torch.learning.word_posterior import WordPosterior
from dcg_torch.model import GroundingModel
from dcg_torch.model.checkpoint import load
from dcg_torch.model.pretrain import pretrained

PACKAGE = Path(__file__).parent.parent / "dcg_torch"
KINDS = {"isinstance", "issubclass", "type"}


def kinds_of_model(source: str) -> list[str]:
    """What a source does that tells kinds of the model apart: subclasses, and questions after its class."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ClassDef) and any("GroundingModel" in ast.unparse(base) for base in node.bases):
            found.append(f"line {node.lineno}: class {node.name} is a GroundingModel")
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in KINDS:
            asked = " ".join(map(ast.unparse, node.args))
            if "GroundingModel" in asked or (node.args and ast.unparse(node.args[0]) in ("model", "self.model")):
                found.append(f"line {node.lineno}: {ast.unparse(node)}")
        if isinstance(node, ast.match_case) and "GroundingModel" in ast.unparse(node.pattern):
            found.append(f"line {node.pattern.lineno}: a case of GroundingModel")
    return found


def test_there_is_one_kind_of_model() -> None:
    found = {p.relative_to(PACKAGE): kinds_of_model(p.read_text("utf-8")) for p in sorted(PACKAGE.rglob("*.py"))}
    assert len(found) > 100
    assert {path: lines for path, lines in found.items() if lines} == {}


@pytest.mark.parametrize(
    "source",
    [
        "class OpenWorldModel(GroundingModel): ...",
        "class Other(core.GroundingModel, Base): ...",
        "def f(m):\n    return isinstance(m, GroundingModel)",
        "def f(m):\n    return isinstance(m, (int, core.GroundingModel))",
        "def f(model):\n    return type(model) is int",
        "def f(m):\n    match m:\n        case GroundingModel(): return 1",
    ],
)
def test_the_scan_finds(source: str) -> None:
    assert kinds_of_model(source)


def test_evaluate_and_experiment_make_the_same_model(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`model=open_world` is one class, one learner and the shipped weights, wherever it is said."""
    rng = np.random.default_rng(0)
    test = write(tmp_path / "test.jsonl", [episode(k, rng, "cube", "cube", COLORS[0]) for k in range(2)])
    runs = {
        "evaluate": (evaluate.main, [f"test={test}"]),
        "experiment": (
            commands.main,
            ["simulator=fake", "trials=1", "iterations=1", "workers=1", "figures=false", "tensorboard=false"],
        ),
    }
    made = {}
    for name, (main, settings) in runs.items():
        folder = tmp_path / name
        said = ["model=open_world", "names=words", f"hydra.run.dir={folder}", *settings]
        status, _, err = typed(capsys, main, name, *said)
        assert status == 0, err
        made[name] = load(folder / "model")
    shipped = pretrained()
    for model in made.values():
        assert type(model) is GroundingModel
        assert isinstance(model.learner, WordPosterior)
        assert isinstance(shipped.learner, WordPosterior)
        assert model.variant == shipped.variant
        assert model.learner.assumed == shipped.learner.assumed
        assert model.learner.nouns.settled == shipped.learner.nouns.settled
    # Nothing was learned by `evaluate`: it is the shipped model to the bit.
    assert (made["evaluate"].factor.weight == shipped.factor.weight).all()
    assert made["evaluate"].learner == shipped.learner
    assert json.loads((tmp_path / "evaluate" / "summary.json").read_text())["n"] == 2
