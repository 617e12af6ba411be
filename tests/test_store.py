"""A saved model: bit-identical, able to go on learning, no pickle, and one line when something is wrong with it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
import torch
from making import command_tree, percept, saw
from safetensors.torch import load_file, save_file

from dcg_torch.model.checkpoint import DESCRIPTION, WEIGHTS, StoreError, load, save
from dcg_torch.grounding.features import Group
from dcg_torch.model import GroundingModel, TrainingSet, Variant

Pupil = Callable[[], GroundingModel]


@pytest.fixture(scope="module")
def taught(pupil: Pupil) -> GroundingModel:
    """A model that has learned "fire hydrant" and seen a colour that it doesn't know."""
    model = pupil()
    world = saw(model, "teal fire hydrant", "red cube")
    assert model.learn(model.ground(command_tree("fire hydrant"), world)) is not None
    return model


@pytest.fixture
def folder(taught: GroundingModel, tmp_path: Path) -> Path:
    save(taught, tmp_path / "model")
    return tmp_path / "model"


def test_round_trip_to_the_bit(taught: GroundingModel, folder: Path) -> None:
    restored = load(folder)
    assert torch.equal(restored.factor.weight, taught.factor.weight)
    assert torch.equal(restored.factor.pairs, taught.factor.pairs)
    assert restored.factor.correspondences == taught.factor.correspondences
    assert list(restored.features.language.items()) == list(taught.features.language.items())
    assert list(restored.features.grounding.items()) == list(taught.features.grounding.items())
    assert restored.features.groups == taught.features.groups
    assert (restored.variant, restored.symbols, restored.examples) == (taught.variant, taught.symbols, taught.examples)
    tree = command_tree("fire hydrant", "teal")
    world = saw(taught, "red cube", "teal fire hydrant", "blue drill")
    one, other = taught.ground(tree, world), restored.ground(tree, world)
    assert dict(one.probabilities) == dict(other.probabilities)
    assert one.best == other.best


def test_positions_and_attributes_survive(pupil: Pupil, tmp_path: Path) -> None:
    model = pupil()
    seen = percept("red cube", (1 / 3, -2e-17))
    model.learn(model.ground(command_tree("cube"), model.world_model([seen])))
    save(model, tmp_path)
    assert load(tmp_path).examples[-1] == model.examples[-1]
    assert model.examples[-1].world.objects[0].position == (1 / 3, -2e-17, 0.0)


def test_both_go_on_learning_alike(taught: GroundingModel, folder: Path, tmp_path: Path) -> None:
    ends = []
    save(taught, tmp_path / "again")
    for model in (load(folder), load(tmp_path / "again")):
        world = saw(model, "green drill", "teal fire hydrant")
        symbol = model.learn(model.ground(command_tree("drill"), world))
        assert symbol is not None
        assert symbol.type == "drill"
        ends.append(model)
    assert torch.equal(ends[0].factor.weight, ends[1].factor.weight)
    assert list(ends[0].symbols) == ["cube", "sphere", "cylinder", "fire hydrant", "drill"]
    solution = ends[0].ground(command_tree("drill"), saw(ends[0], "red mailbox", "blue drill"))
    assert solution.object is not None
    assert solution.object.type == "drill"


def test_what_was_trained_on_beside_the_lessons_is_kept(training: TrainingSet, tmp_path: Path) -> None:
    """Or the first lesson after loading would unlearn it."""
    model = GroundingModel.trained(training, Variant(groups=frozenset(Group)))
    save(model, tmp_path)
    restored = load(tmp_path)
    assert restored.corpus == model.corpus != []
    model.train()
    restored.train()
    assert torch.equal(model.factor.weight, restored.factor.weight)


def test_saving_again_replaces(folder: Path, trained: GroundingModel) -> None:
    save(trained, folder)
    assert load(folder).symbols == trained.symbols
    assert sorted(path.name for path in folder.iterdir()) == sorted([DESCRIPTION, WEIGHTS])


def test_no_pickle(folder: Path) -> None:
    assert json.loads((folder / DESCRIPTION).read_bytes())["symbols"][-1]["word"] == "fire hydrant"
    header = (folder / WEIGHTS).read_bytes()
    length = int.from_bytes(header[:8], "little")
    assert set(json.loads(header[8 : 8 + length])) <= {"weight", "__metadata__"}


def garble_description(folder: Path) -> None:
    (folder / DESCRIPTION).write_text('{"variant": ')


def drop_symbols(folder: Path) -> None:
    description = json.loads((folder / DESCRIPTION).read_bytes())
    del description["symbols"]
    (folder / DESCRIPTION).write_text(json.dumps(description))


def strange_feature(folder: Path) -> None:
    description = json.loads((folder / DESCRIPTION).read_bytes())
    description["language"][-1] = "smell: red"
    (folder / DESCRIPTION).write_text(json.dumps(description))


def fewer_columns(folder: Path) -> None:
    description = json.loads((folder / DESCRIPTION).read_bytes())
    description["grounding"].pop()
    (folder / DESCRIPTION).write_text(json.dumps(description))


def column_twice(folder: Path) -> None:
    description = json.loads((folder / DESCRIPTION).read_bytes())
    description["grounding"][-1] = description["grounding"][0]
    (folder / DESCRIPTION).write_text(json.dumps(description))


def cut_weights(folder: Path) -> None:
    (folder / WEIGHTS).write_bytes((folder / WEIGHTS).read_bytes()[:-9])


def other_tensor(folder: Path) -> None:
    save_file({"bias": torch.zeros(3)}, folder / WEIGHTS)


def half_precision(folder: Path) -> None:
    save_file({"weight": load_file(folder / WEIGHTS)["weight"].half()}, folder / WEIGHTS)


def no_weights(folder: Path) -> None:
    (folder / WEIGHTS).unlink()


def no_description(folder: Path) -> None:
    (folder / DESCRIPTION).unlink()


@pytest.mark.parametrize(
    ("damage", "says"),
    [
        (garble_description, "not a saved model"),
        (drop_symbols, "symbols"),
        (strange_feature, "smell"),
        (fewer_columns, "not of one model"),
        (column_twice, "twice"),
        (cut_weights, "not a saved model"),
        (other_tensor, "weight"),
        (half_precision, "float64"),
        (no_weights, WEIGHTS),
        (no_description, DESCRIPTION),
    ],
)
def test_damage_is_told_in_one_line(folder: Path, damage: Callable[[Path], None], says: str) -> None:
    damage(folder)
    with pytest.raises(StoreError, match=says) as caught:
        load(folder)
    assert "\n" not in str(caught.value)
    assert str(folder) in str(caught.value)


def test_no_folder(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="no saved model here"):
        load(tmp_path / "nowhere")
    (tmp_path / "a file").write_text("")
    with pytest.raises(StoreError, match="no saved model here"):
        load(tmp_path / "a file")
