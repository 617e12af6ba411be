"""A saved model that is damaged says so in one short line, when it is loaded and not later."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from making import command_tree, saw
from safetensors.numpy import load_file, save_file

from dcg_torch.learning.word_posterior import WordPosterior
from dcg_torch.model import GroundingModel, TrainingSet
from dcg_torch.model.checkpoint import DESCRIPTION, WEIGHTS, CheckpointError, load, save
from dcg_torch.model.pretrain import pretrained
from dcg_torch.storage.errors import UserError

Damage = Callable[[Any], None]
Arrays = dict[str, np.ndarray]


@pytest.fixture(scope="module")
def folders(
    pupil: Callable[[], GroundingModel], training: TrainingSet, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """Two saved models that have heard a word: the paper's and one with a posterior."""
    where = tmp_path_factory.mktemp("models")
    for name, model in (
        ("paper", pupil()),
        ("posterior", GroundingModel.trained(training, learner=WordPosterior.start(training))),
    ):
        model.learn(model.ground(command_tree("drill"), saw(model, "green drill", "red cube")))
        save(model, where / name)
    return where


@pytest.fixture
def copy_of(folders: Path, tmp_path: Path) -> Callable[[str], Path]:
    def make(name: str) -> Path:
        (tmp_path / name).mkdir()
        for file in (folders / name).iterdir():
            (tmp_path / name / file.name).write_bytes(file.read_bytes())
        return tmp_path / name

    return make


def refusal(folder: Path) -> str:
    """The message of the error that loading a folder raises: one line, short, printable, and it names the folder."""
    with pytest.raises(CheckpointError) as caught:
        load(folder)
    message = str(caught.value)
    assert isinstance(caught.value, UserError)
    assert message.isprintable()
    assert len(message) - len(str(folder)) < 300
    assert message.startswith(str(folder))
    return message


def edited(folder: Path, damage: Damage) -> Path:
    """The folder, with its description damaged."""
    described = json.loads((folder / DESCRIPTION).read_bytes())
    damage(described)
    (folder / DESCRIPTION).write_text(json.dumps(described))
    return folder


def noun_example(described: Any) -> Any:
    return next(e for e in described["commit_first"]["examples"] if e["phrase"]["kind"] == "noun")


def with_child(described: Any) -> Any:
    return next(e for e in described["commit_first"]["examples"] if e["children"])


DESCRIPTIONS: list[tuple[str, str, Damage, str]] = [
    ("no format", "paper", lambda d: d.pop("format"), "format"),
    ("an old format", "paper", lambda d: d.update(format=1), "format"),
    ("a later format", "paper", lambda d: d.update(format=3), "format"),
    ("no variant", "paper", lambda d: d.pop("variant"), "variant"),
    ("a feature of no family", "paper", lambda d: d["language"].append("smell: red"), "smell"),
    ("a long name of no family", "paper", lambda d: d["language"].append("\x1b[31m" * 10_000), "no family"),
    ("a column less", "paper", lambda d: d["grounding"].pop(), "not of one model"),
    ("a column twice", "paper", lambda d: d["grounding"].append(d["grounding"][0]), "twice"),
    ("no learner", "paper", lambda d: d.update(commit_first=None), "no learner"),
    ("no learner, posterior", "posterior", lambda d: d.pop("word_posterior"), "no learner"),
    ("another's correspondences", "paper", lambda d: d.update(correspondences=[0, 1]), "correspondences"),
    ("beam 0", "paper", lambda d: d["variant"].update(beam=0), "beam"),
    ("beam without end", "paper", lambda d: d["variant"].update(beam=10**9), "beam"),
    ("l2 below 0", "paper", lambda d: d["variant"].update(l2=-1.0), "l2"),
    ("l2 next to nothing", "paper", lambda d: d["variant"].update(l2=5e-324), "l2"),
    ("l2 infinite", "paper", lambda d: d["variant"].update(l2=float("inf")), "l2"),
    ("l2 no number", "paper", lambda d: d["variant"].update(l2=float("nan")), "l2"),
    ("too many labels", "paper", lambda d: noun_example(d)["correspondences"].extend([0] * 50), "more labels"),
    ("a label out of range", "paper", lambda d: noun_example(d)["correspondences"].__setitem__(0, 7), "correspond"),
    ("too few weights", "paper", lambda d: noun_example(d).update(weights=[1.0]), "fewer weights"),
    ("a weight no number", "paper", lambda d: noun_example(d).update(weight=float("nan")), "not finite"),
    ("a weight beyond all", "paper", lambda d: noun_example(d).update(weight=-1e300), "beyond 1e+06"),
    (
        "a child of nothing",
        "paper",
        lambda d: with_child(d)["children"][0][0][1].update(id="\x1b[2Jnobody"),
        "not in its world",
    ),
    (
        "belief without end",
        "posterior",
        lambda d: d["word_posterior"]["nouns"]["heard"]["drill"].update(absent=float("-inf")),
        "finite",
    ),
    (
        "an impossible prior",
        "posterior",
        lambda d: d["word_posterior"]["assumed"]["nouns"].update(slip=2.0),
        "slip",
    ),
    (
        "strength 0",
        "posterior",
        lambda d: d["word_posterior"]["assumed"].update(strength=0.0),
        "strength",
    ),
    (
        "nothing counted",
        "posterior",
        lambda d: d["word_posterior"]["census"].update(cells=0.0),
        "cells",
    ),
    (
        "hidden below 0",
        "posterior",
        lambda d: d["word_posterior"]["assumed"].update(hidden=-1.0),
        "hidden",
    ),
    (
        "strength no number",
        "posterior",
        lambda d: d["word_posterior"]["assumed"].update(strength=float("nan")),
        "strength",
    ),
]


@pytest.mark.parametrize(("name", "damage", "says"), [d[1:] for d in DESCRIPTIONS], ids=[d[0] for d in DESCRIPTIONS])
def test_a_damaged_description(copy_of: Callable[[str], Path], name: str, damage: Damage, says: str) -> None:
    folder = copy_of(name)
    load(folder)
    assert says in refusal(edited(folder, damage))


def half(tensors: Arrays) -> None:
    tensors["weight"] = tensors["weight"].astype(np.float16)


def put(name: str, value: float) -> Damage:
    def damage(tensors: Arrays) -> None:
        tensors[name] = tensors[name].copy()
        tensors[name][0] = value

    return damage


def shorter(tensors: Arrays) -> None:
    tensors["weight"] = tensors["weight"][:-1]


def square(tensors: Arrays) -> None:
    tensors["weight"] = tensors["weight"][None]


def strange(tensors: Arrays) -> None:
    tensors.clear()
    tensors["bias"] = np.zeros(3)


WRONG_WEIGHTS: list[tuple[str, Damage, str]] = [
    ("half precision", half, "float64"),
    ("no number", put("weight", float("nan")), "finite"),
    ("infinite", put("weight", float("-inf")), "finite"),
    ("beyond all weights", put("weight", 1e300), "beyond 1e+06"),
    ("fewer values than places", shorter, "not of one model"),
    ("two dimensions", square, "weight"),
    ("places outside", put("weight at", 10**9), "not of one model"),
    ("places below 0", put("weight at", -1), "not of one model"),
    ("other tensors", strange, "tensors"),
]


@pytest.mark.parametrize(("damage", "says"), [d[1:] for d in WRONG_WEIGHTS], ids=[d[0] for d in WRONG_WEIGHTS])
def test_damaged_weights(copy_of: Callable[[str], Path], damage: Damage, says: str) -> None:
    folder = copy_of("paper")
    tensors = load_file(folder / WEIGHTS)
    damage(tensors)
    save_file(tensors, folder / WEIGHTS)
    assert says in refusal(folder)


def test_held_weights_of_columns_that_are_not_there(copy_of: Callable[[str], Path]) -> None:
    folder = copy_of("paper")
    save_file(load_file(folder / WEIGHTS) | {"held": np.array([10**8], dtype=np.int32)}, folder / WEIGHTS)
    assert "lacks" in refusal(folder)


def test_files_that_are_none_of_ours(copy_of: Callable[[str], Path]) -> None:
    for number, (name, content, says) in enumerate(
        [
            (DESCRIPTION, b'{"variant": ', "not a saved model"),
            (DESCRIPTION, b"\x1b[31mred\x07" * 50, "not a saved model"),
            (DESCRIPTION, b"[" * 100_000, "not a saved model"),
            (DESCRIPTION, b"", "not a saved model"),
            (DESCRIPTION, b"\xff\xfe\x00", "not a saved model"),
            (WEIGHTS, b"", "not a file of weights"),
            (WEIGHTS, b"\x1b[31m" * 100, "not a file of weights"),
        ]
    ):
        folder = copy_of("paper").rename(copy_of("posterior").parent / f"copy {number}")
        for left in (folder.parent / "posterior").iterdir():
            left.unlink()
        (folder.parent / "posterior").rmdir()
        (folder / name).write_bytes(content)
        assert says in refusal(folder)


@pytest.mark.parametrize("kept", [0.1, 0.5, 0.99])
@pytest.mark.parametrize("name", [DESCRIPTION, WEIGHTS])
def test_a_file_that_is_cut_short(copy_of: Callable[[str], Path], name: str, kept: float) -> None:
    folder = copy_of("paper")
    content = (folder / name).read_bytes()
    (folder / name).write_bytes(content[: int(kept * len(content))])
    assert name in refusal(folder)


@pytest.mark.parametrize("name", [DESCRIPTION, WEIGHTS])
def test_a_file_that_is_missing_or_a_folder(copy_of: Callable[[str], Path], name: str) -> None:
    folder = copy_of("paper")
    (folder / name).unlink()
    assert "no saved model here" in refusal(folder)
    (folder / name).mkdir()
    assert "cannot be read" in refusal(folder)


def test_no_folder(tmp_path: Path) -> None:
    assert "no saved model here" in refusal(tmp_path / "nowhere")
    (tmp_path / "a file").write_text("")
    assert refusal(tmp_path / "a file")


def test_two_learners_are_one_too_many(folders: Path, copy_of: Callable[[str], Path]) -> None:
    posterior = json.loads((folders / "posterior" / DESCRIPTION).read_bytes())["word_posterior"]
    folder = edited(copy_of("paper"), lambda d: d.update(word_posterior=posterior))
    assert "or two" in refusal(folder)


def test_the_shipped_model_passes_its_own_checks(tmp_path: Path) -> None:
    save(pretrained(), tmp_path)
    load(tmp_path)
