"""Settings: every number has bounds that hold, and what is no setting is one line in every program."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import pytest
from hydra import compose, initialize_config_dir
from hypothesis import given
from hypothesis import strategies as st
from making import typed

from dcg_torch import evaluate
from dcg_torch.cli import run as experiment
from dcg_torch.cli.completion import script
from dcg_torch.cli.config import register
from dcg_torch.settings import (
    Bounds,
    EvaluateSettings,
    RobotKind,
    Settings,
    SettingsError,
    SimulatorSettings,
    TalkSettings,
    check,
    check_values,
    described,
)
from dcg_torch.storage.resources import resource

FAKE = SimulatorSettings(kind=RobotKind.fake)
SCHEMAS: list[type[Any]] = [Settings, EvaluateSettings, TalkSettings]


def with_value(schema: type[Any], name: str, value: object) -> Any:
    """Default settings with one value at a dotted name."""
    settings = schema(simulator=dataclasses.replace(FAKE)) if schema is Settings else schema()
    *groups, last = name.split(".")
    holder = settings
    for group in groups:
        holder = getattr(holder, group)
    setattr(holder, last, value)
    return settings


@pytest.mark.parametrize("schema", SCHEMAS)
def test_every_number_has_bounds_and_every_setting_a_meaning(schema: type[Any]) -> None:
    for name, default, text, bounds in described(schema):
        assert len(text) > 10, name
        number = isinstance(default, (int, float)) and not isinstance(default, bool)
        assert (bounds is not None) or not number, name
        assert bounds is None or default is None or bounds.hold(default), name


NUMBERS = [(schema, name, b) for schema in SCHEMAS for name, _, _, b in described(schema) if b is not None]


@pytest.mark.parametrize(("schema", "name", "bounds"), NUMBERS, ids=lambda x: x if isinstance(x, str) else "")
def test_what_lies_outside_is_refused_by_name(schema: type[Any], name: str, bounds: Bounds) -> None:
    outside = [bounds.low - 1, bounds.high + max(1, 1e-3 * bounds.high), float("nan"), float("inf"), -float("inf")]
    for value in [*outside, bounds.low] if bounds.open else outside:
        with pytest.raises(SettingsError, match=f"^{name}=") as error:
            check_values(with_value(schema, name, value))
        assert len(str(error.value)) < 120
    check_values(with_value(schema, name, bounds.high))


@given(st.floats())
def test_bounds_are_an_interval(x: float) -> None:
    assert Bounds(0.0, 1.0).hold(x) == (0.0 <= x <= 1.0)
    assert Bounds(0.0, 1.0, open=True).hold(x) == (0.0 < x <= 1.0)


@given(types=st.integers(1, 40), colors=st.integers(1, 10), rate=st.floats(0, 1, exclude_min=True))
def test_generated_worlds_that_pass_the_check_can_be_drawn(types: int, colors: int, rate: float) -> None:
    """In 1,000 draws the chance that no object comes is below e to the -50."""
    settings = Settings(simulator=FAKE, worlds="generated", types=types, colors=colors, object_rate=rate)
    try:
        check(settings)
    except SettingsError as error:
        assert "object_rate" in str(error)  # noqa: PT017  (it may also pass)
        return
    assert types * colors * rate * 1_000 >= 50 * (1 - 1e-9)


WRONG = [
    ("model.l2=inf", "model.l2=inf"),
    ("model.l2=1e-320", "model.l2=1e-320: give a number from 1e-06 to"),  # a singular matrix
    ("model.groups=[]", "model.groups=[]"),
    ("model=null", "model=null: there is no such model; choose from dcg, "),
    ("model=schema", "model=schema: there is no such model"),
    ("model.beam=0", "model.beam=0"),
    ("model.lessons=-5", "model.lessons=-5"),
    ("model.open_world.look_above=nan", "look_above=nan"),
    ("training=no_such.yaml", "no_such.yaml: no such training file"),
]
OF_EXPERIMENTS = [
    ("simulator=null", "simulator=null: there is no such simulator; choose from fake, pybullet"),
    ("trials=1000000000", "trials=1000000000: give a number from 1 to 100000"),
    ("seed=-1", "seed=-1"),
    ("train=x.jsonl", "train: there is no such setting; did you mean training?"),
    ("simulator.spin_step=0", "spin_step=0"),
    ("simulator.spin_step=-1e-9", "simulator.spin_step=-1e-09: the robot would look round for ever"),
    ("hydra.job.chdir=true", "hydra.job.chdir=true: files are named from where you are"),
    ("animate=[0]", "animate"),
    ("hydra/launcher=joblibs", "hydra/launcher=joblibs: there is no such"),
]


@pytest.mark.parametrize(("wrong", "says"), [*WRONG, *OF_EXPERIMENTS, ("object_rate=1e-12", "object_rate=1e-12")])
def test_an_experiment_says_it_in_one_line(
    wrong: str, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "run"
    settings = ("simulator=fake", "worlds=generated", "speaker=canonical", f"hydra.run.dir={folder}")
    status, out, err = typed(capsys, experiment.main, "dcg_torch", *settings, wrong)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert says in err
    assert not folder.exists()


@pytest.mark.parametrize(("wrong", "says"), WRONG[:-1])
def test_an_evaluation_says_it_in_one_line(
    wrong: str, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "run"
    status, out, err = typed(
        capsys, evaluate.main, "dcg_torch.evaluate", "train=x.jsonl", "test=y.jsonl", f"hydra.run.dir={folder}", wrong
    )
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert says in err
    assert not folder.exists()


@pytest.mark.parametrize("main", [experiment.main, evaluate.main])
def test_help_names_every_setting_with_its_meaning(main: Any, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = typed(capsys, main, "dcg_torch", "--help")
    assert status == 0
    words = " ".join(out.split())
    for name, _, text, _ in described(Settings if main is experiment.main else EvaluateSettings):
        assert f"{name}=" in out
        assert " ".join(text.split()) in words


def test_two_processes_of_one_second_get_folders_of_their_own() -> None:
    register()
    with initialize_config_dir(str(resource("conf")), version_base="1.3"):
        for name in ("config", "evaluate"):
            one, two = (compose(name, return_hydra_config=True).hydra.run.dir for _ in range(2))
            assert one != two


def test_the_version_is_this_projects(capsys: pytest.CaptureFixture[str]) -> None:
    for main in (experiment.main, evaluate.main):
        status, out, _ = typed(capsys, main, "dcg_torch", "--version")
        assert status == 0
        assert out.startswith("dcg_torch 0.")


@pytest.mark.parametrize("shell", ["bash", "zsh"])
def test_a_shell_completes_every_setting(shell: str) -> None:
    text = script(shell)
    for schema in SCHEMAS:
        assert all(f"{name}=" in text for name, *_ in described(schema))


def test_animate_that_is_no_list_is_said() -> None:
    with pytest.raises(SettingsError, match="animate=3: give a list of trials"):
        check(dataclasses.replace(Settings(), animate=3))  # type: ignore[arg-type]
