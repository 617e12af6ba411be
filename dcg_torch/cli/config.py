"""Hydra's side of the settings: their schemas, its errors in one line, and what is added to a sweep."""

from __future__ import annotations

import difflib
import functools
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, cast, get_type_hints

from hydra.core.config_store import ConfigStore
from hydra.core.hydra_config import HydraConfig
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.errors import HydraException, MissingConfigException, OverrideParseException
from hydra.experimental.callback import Callback
from omegaconf import DictConfig, OmegaConf, open_dict, read_write
from omegaconf.errors import OmegaConfBaseException

from dcg_torch.cli.console import make_console
from dcg_torch.report.runs import load_runs
from dcg_torch.report.show import print_several, save_several_figure
from dcg_torch.report.summary import flatten
from dcg_torch.resources import resource
from dcg_torch.settings import EvaluateSettings, ModelSettings, Settings, SettingsError, SimulatorSettings, check

CONFIG_ERRORS = (HydraException, OmegaConfBaseException)
"""What Hydra raises when overrides or YAML files are wrong; `explain` says it in one line."""

# At import, since the jobs of a parallel sweep start in processes that never see `register`.
OmegaConf.register_new_resolver("resource", lambda name: str(resource(name)), replace=True)


def register() -> None:
    """Make the schemas known to Hydra, so that a misspelt key or a wrong type fails before the run."""
    store = ConfigStore.instance()
    store.store(name="schema", node=Settings)
    store.store(name="evaluate_schema", node=EvaluateSettings)
    store.store(group="model", name="schema", node=ModelSettings)
    store.store(group="simulator", name="schema", node=SimulatorSettings)


def settings_of(config: DictConfig) -> Settings:
    """The checked settings of a composed configuration.

    Raises:
        SettingsError: a value makes no sense, or is of no use to any setting.
        OmegaConfBaseException: a value is missing, or refers to one that does not exist.
    """
    _refuse_added(config, Settings)
    settings = cast(Settings, OmegaConf.to_object(config))
    check(settings)
    return settings


def evaluate_settings_of(config: DictConfig) -> EvaluateSettings:
    """The same for `evaluate`, whose values are checked against the episodes."""
    _refuse_added(config, EvaluateSettings)
    return cast(EvaluateSettings, OmegaConf.to_object(config))


def _refuse_added(config: DictConfig, schema: type) -> None:
    for key in flatten(cast(dict[str, Any], OmegaConf.to_container(config))):
        if key not in _keys(schema):  # Hydra's "+key=value" adds what the schema doesn't have
            raise SettingsError(_unknown_key(key))


def save_composed(config: DictConfig, directory: Path) -> None:
    """Write `.hydra` into a run folder: the configuration, Hydra's own, and the overrides that were given.

    Hydra would write it before the program runs, over that of the experiment which the folder may hold.
    """
    own = HydraConfig.get()
    target = directory / ".hydra"
    target.mkdir(parents=True, exist_ok=True)
    OmegaConf.save(config, target / "config.yaml")
    OmegaConf.save(OmegaConf.create({"hydra": own}), target / "hydra.yaml")
    OmegaConf.save(own.overrides.task, target / "overrides.yaml")


def explain(error: Exception) -> str:
    """One line for the user from one of `CONFIG_ERRORS`: what, where, how to mend it."""
    cause = error.__cause__ or error.__context__
    first = next(iter(_lines(error)), type(error).__name__)
    if isinstance(error, MissingConfigException):
        group, _, option = (error.missing_cfg_file or "").rpartition("/")
        choices = sorted(set(error.options or ()) - {"schema"})
        if not group:
            return f"there is no configuration {option!r} in {resource('conf')}; leave --config-name out"
        return f"{group}={option}: there is no such {group}; choose from {', '.join(choices)}"
    if isinstance(error, OverrideParseException):
        return f"{error.override}: not an override; write KEY=VALUE, in quotes if it holds brackets or spaces"
    key = getattr(cause, "full_key", None) or getattr(error, "full_key", None)
    if first.startswith(("Could not override", "Could not append")):
        return _unknown_key(str(key or first.split("'")[1]))
    if first.startswith("Error merging override") and cause is not None:
        return f"{first.removeprefix('Error merging override ')}: {_lines(cause)[0]}"
    return f"{key}: {first}" if key and str(key) not in first else " ".join(_lines(error))


def _unknown_key(key: str) -> str:
    near = difflib.get_close_matches(key, (*_keys(Settings), *_keys(EvaluateSettings)), n=1)
    hint = f"did you mean {near[0]}?" if near else "python -m dcg_torch --help lists all"
    return f"{key}: there is no such setting; {hint}"


@functools.cache
def _keys(schema: type, prefix: str = "") -> tuple[str, ...]:
    """The dotted names of all settings."""
    found: list[str] = []
    types = get_type_hints(schema)
    for field in fields(schema):
        found.append(prefix + field.name)
        if is_dataclass(types[field.name]):
            found += _keys(cast(type, types[field.name]), f"{prefix}{field.name}.")
    return tuple(found)


def _lines(error: BaseException) -> list[str]:
    return [line.strip() for line in str(error).splitlines() if line.strip()]


class Sweep(Callback):
    """Names the folders of a sweep by what differs between its runs, and compares the runs when all are done."""

    def on_multirun_start(self, config: DictConfig, **_: Any) -> None:
        """Leave the overrides that all runs share out of the folder names."""
        settings = cast(dict[str, Any], OmegaConf.to_container(config.hydra, resolve=False))
        params = settings["sweeper"].get("params") or {}
        given = [*settings["overrides"]["task"], *(f"{key}={value}" for key, value in params.items())]
        overrides = OverridesParser.create().parse_overrides(given)
        shared = {o.get_key_element() for o in overrides if not o.is_sweep_override()}
        if len(shared) < len(overrides):
            with read_write(config), open_dict(config):
                excluded = f"hydra.job.config.override_dirname.exclude_keys=[{','.join(sorted(shared))}]"
                config.hydra.overrides.hydra.append(excluded)

    def on_multirun_end(self, config: DictConfig, **_: Any) -> None:
        """Print the table and the comparison, and draw the latter."""
        compare_runs(Path(config.hydra.sweep.dir))


def compare_runs(directory: Path) -> None:
    """Print what the runs at or below `directory` amount to side by side, and draw it in `comparison.png` there."""
    console = make_console()
    runs = load_runs([directory])
    print_several(runs, console)
    if len(runs) > 1:
        console.print(f"figure: {save_several_figure(runs, directory)}")
        console.print(f"curves: tensorboard --logdir {directory}")
