"""A saved model: bit-identical, able to go on learning, no pickle."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
import torch
from making import command_tree, percept, saw

from dcg_torch.learning.commit_first import CommitFirst
from dcg_torch.model import GroundingModel
from dcg_torch.model.checkpoint import DESCRIPTION, FORMAT, WEIGHTS, load, save
from dcg_torch.types import Example

Pupil = Callable[[], GroundingModel]


@pytest.fixture(scope="module")
def taught(pupil: Pupil) -> GroundingModel:
    """A model that has learned "fire hydrant" and seen a colour that it doesn't know."""
    model = pupil()
    assert model.learn(model.ground(command_tree("fire hydrant"), saw(model, "teal fire hydrant", "red cube")))
    return model


@pytest.fixture
def folder(taught: GroundingModel, tmp_path: Path) -> Path:
    save(taught, tmp_path / "model")
    return tmp_path / "model"


def examples_of(model: GroundingModel) -> tuple[Example, ...]:
    assert isinstance(model.learner, CommitFirst)
    return model.learner.examples


def test_round_trip_to_the_bit(taught: GroundingModel, folder: Path) -> None:
    restored = load(folder)
    assert torch.equal(restored.factor.weight, taught.factor.weight)
    assert torch.equal(restored.factor.pairs, taught.factor.pairs)
    assert restored.factor.correspondences == taught.factor.correspondences
    assert list(restored.features.language.items()) == list(taught.features.language.items())
    assert list(restored.features.grounding.items()) == list(taught.features.grounding.items())
    assert restored.features.groups == taught.features.groups
    assert (restored.variant, restored.learner) == (taught.variant, taught.learner)
    assert list(restored.symbols) == list(taught.symbols)
    assert (restored.held == taught.held).all()
    assert restored.prior is None
    assert taught.prior is None  # no corpus has taught any
    tree = command_tree("fire hydrant", "teal")
    world = saw(taught, "red cube", "teal fire hydrant", "blue drill")
    one, other = taught.ground(tree, world), restored.ground(tree, world)
    assert dict(one.probabilities) == dict(other.probabilities)
    assert one.best == other.best


def test_the_same_model_gives_the_same_bytes(taught: GroundingModel, folder: Path, tmp_path: Path) -> None:
    save(taught, tmp_path / "again")
    save(load(folder), tmp_path / "restored")
    for name in (DESCRIPTION, WEIGHTS):
        assert len({(at / name).read_bytes() for at in (folder, tmp_path / "again", tmp_path / "restored")}) == 1


def test_what_a_corpus_pulls_weights_towards_survives(taught: GroundingModel, tmp_path: Path) -> None:
    model = taught.copy()
    model.prior = 0.5 * model.factor.weight.numpy()
    save(model, tmp_path)
    found = load(tmp_path).prior
    assert found is not None
    assert (found == model.prior).all()


def test_positions_and_attributes_survive(pupil: Pupil, tmp_path: Path) -> None:
    model = pupil()
    seen = percept("red cube", (1 / 3, -2e-17))
    model.learn(model.ground(command_tree("cube"), model.world_model([seen])))
    save(model, tmp_path)
    assert examples_of(load(tmp_path))[-1] == examples_of(model)[-1]
    assert examples_of(model)[-1].world.objects[0].position == (1 / 3, -2e-17, 0.0)


def test_a_restored_model_goes_on_learning_as_it_would_have(pupil: Pupil, tmp_path: Path) -> None:
    model = pupil()
    save(model, tmp_path)
    restored = load(tmp_path)
    for one in (model, restored):
        learned = one.learn(one.ground(command_tree("drill"), saw(one, "green drill", "teal cube")))
        assert learned.symbol is not None
        assert learned.symbol.type == "drill"
    assert torch.equal(model.factor.weight, restored.factor.weight)
    solution = restored.ground(command_tree("drill"), saw(restored, "red mailbox", "blue drill"))
    assert solution.object is not None
    assert solution.object.type == "drill"


def test_saving_again_replaces(folder: Path, trained: GroundingModel) -> None:
    save(trained, folder)
    assert load(folder).symbols == trained.symbols
    assert sorted(path.name for path in folder.iterdir()) == sorted([DESCRIPTION, WEIGHTS])


def test_a_name_as_text_will_do(trained: GroundingModel, tmp_path: Path) -> None:
    where = str(tmp_path / "deep" / "model")
    save(trained, where)
    assert load(where).symbols == trained.symbols


def test_no_pickle(folder: Path) -> None:
    described = json.loads((folder / DESCRIPTION).read_bytes())
    assert described["format"] == FORMAT
    assert list(described["commit_first"]["symbols"])[-1] == "fire hydrant"
    header = (folder / WEIGHTS).read_bytes()
    length = int.from_bytes(header[:8], "little")
    tensors = json.loads(header[8 : 8 + length])
    assert set(tensors) - {"__metadata__"} == {"weight", "weight at", "prior", "prior at", "held"}
