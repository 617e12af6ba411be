"""No device is assumed: shapes on torch's meta device, the fit beside the processor's, CUDA where there is one."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import torch
from factors import Problem, both_settings, problems, seeds, solid_problem
from hostile import EPISODE
from hypothesis import given, settings
from making import percept, typed

import dcg_torch
from dcg_torch.evaluate import main
from dcg_torch.fitting.device_objective import DeviceObjective, minimise
from dcg_torch.fitting.devices import DeviceError, device_of
from dcg_torch.fitting.fit import fit, objective_at
from dcg_torch.fitting.psi import LogLinearFactor
from dcg_torch.fitting.sparse_rows import Written, weight_at, write_out
from dcg_torch.types import Correspondence, Pose

CUDA = pytest.mark.skipif(not torch.cuda.is_available(), reason="no CUDA device here")
SAID = ("go to the red cube", "the mug left of the cube", "drive to the second biggest mug")


def written(problem: Problem, factor: LogLinearFactor, l2: float) -> Written:
    weight = factor.weight.numpy()
    zero = np.zeros(problem.shape)
    return write_out([problem.design()], weight, zero, problem.pairs, np.full(problem.pairs.shape, l2))


@given(problem=problems(), seed=seeds)
def test_value_and_gradient_are_those_of_the_processor(problem: Problem, seed: int) -> None:
    factor = problem.model(np.random.default_rng(seed))
    own = written(problem, factor, 0.3)
    objective = DeviceObjective.of(own, torch.device("cpu"))
    value, gradient, _ = objective.at(torch.from_numpy(own.start))
    centred = LogLinearFactor(problem.pairs, problem.correspondences)
    centred.set_weight(weight_at(own.start, np.zeros(problem.shape), own.columns))
    expected, of_weights = objective_at(centred, [problem.design()], 0.3)
    assert float(value) + own.constant == pytest.approx(expected, rel=1e-10)
    assert gradient.numpy() == pytest.approx(of_weights.reshape(problem.shape[0], -1)[1:, own.columns], abs=1e-9)


@both_settings
def test_the_optimum_is_that_of_the_processor(correspondences: tuple[Correspondence, ...]) -> None:
    problem = solid_problem(correspondences)
    factor = problem.model()
    fit(factor, [problem.design()], l2=0.05, tolerance=1e-11)
    own = written(problem, problem.model(), 0.05)
    found = minimise(own, torch.device("cpu"), tolerance=1e-11, max_steps=100)
    d = found.point.at.reshape(len(correspondences) - 1, -1)
    assert found.status == "converged"
    assert np.abs(weight_at(d, np.zeros(problem.shape), own.columns) - factor.weight.numpy()).max() < 1e-9


def test_the_tensors_of_the_fit_stay_on_their_device() -> None:
    """The meta device has no numbers: what would reach for the processor's fails on it."""
    problem = solid_problem(dcg_torch.LogLinearFactor(np.ones((1, 1), dtype=np.bool_)).correspondences)
    own = written(problem, problem.model(), 0.05)
    objective = DeviceObjective.of(own, torch.device("meta"))
    d = torch.zeros(own.start.shape, dtype=torch.float64, device="meta")
    value, gradient, chances = objective.at(d)
    assert value.shape == ()
    assert gradient.shape == objective.product(chances, d).shape == objective.diagonal(chances).shape == d.shape
    assert chances.shape == (2, own.incidence.rows)
    for tensor in (value, gradient, chances, objective.product(chances, d), objective.diagonal(chances)):
        assert tensor.device.type == "meta"
        assert tensor.dtype == torch.float64


def things() -> list[dcg_torch.Percept]:
    return [
        percept("red cube", (2.0, 0.5)),
        percept("blue mug", (2.0, 1.2), name="m1"),
        percept("green mug", (2.0, -1.0), name="m2"),
    ]


def grounded(model: dcg_torch.GroundingModel) -> list[dict[str, float]]:
    world = model.world_model(things(), robot=Pose(0.0, 0.0, 0.0))
    return [dict(model.ground(text, world).probabilities) for text in SAID]


def test_psi_in_torch_grounds_as_psi_in_numpy() -> None:
    """Other devices take this way; a weight that asks for a gradient takes it on the processor."""
    model = dcg_torch.pretrained()
    expected = grounded(model)
    model.factor.requires_grad_()
    for own, other in zip(grounded(model), expected, strict=True):
        assert own == pytest.approx(other, abs=1e-9)


@pytest.mark.parametrize("name", ["meta", "cuda:99", "nonsense"])
def test_a_device_that_cannot_be_used_is_one_line(name: str) -> None:
    with pytest.raises(DeviceError, match=f"^device={name}: .*take device=cpu$") as error:
        dcg_torch.pretrained(device=name)
    assert "\n" not in str(error.value)


def test_a_device_is_checked_before_a_fit() -> None:
    problem = solid_problem(LogLinearFactor(np.ones((1, 1), dtype=np.bool_)).correspondences)
    with pytest.raises(DeviceError):
        fit(problem.model(), [problem.design()], l2=0.1, device="nonsense")


def test_evaluate_refuses_a_device_that_is_not_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    episodes = tmp_path / "episodes.jsonl"
    episodes.write_text(json.dumps(EPISODE) + "\n")
    where = f"hydra.run.dir={tmp_path / 'run'}"
    status, _, err = typed(capsys, main, "dcg_torch.evaluate", f"test={episodes}", "device=cuda:99", where)
    assert status == 2
    assert err.startswith("dcg_torch: device=cuda:99: ")
    assert err.count("\n") == 1


@CUDA
def test_cuda_grounds_and_learns_as_the_processor() -> None:
    assert device_of("cuda").type == "cuda"
    models = [dcg_torch.pretrained(device=name) for name in ("cpu", "cuda")]
    for own, other in zip(*map(grounded, models), strict=True):
        assert own == pytest.approx(other, abs=1e-9)
    for model in models:
        model.learn(model.ground("go to the mug", model.world_model(things())))
        assert model.copy().factor.weight.device == model.factor.weight.device
    for own, other in zip(*map(grounded, models), strict=True):
        assert own == pytest.approx(other, abs=1e-6)  # a fit ends at a gradient of 1e-7


@CUDA
@both_settings
@settings(max_examples=1)
@given(seed=seeds)
def test_cuda_fits_as_the_processor(correspondences: tuple[Correspondence, ...], seed: int) -> None:
    problem = solid_problem(correspondences, seed)
    found = []
    for name in ("cpu", "cuda"):
        factor = problem.model()
        fit(factor, [problem.design()], l2=0.05, tolerance=1e-11, device=name)
        found.append(factor.weight.numpy())
    assert np.abs(found[0] - found[1]).max() < 1e-9
