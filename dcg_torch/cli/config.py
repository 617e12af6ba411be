"""Hydra's side of the settings: their schemas, and its errors in one line."""

from __future__ import annotations

import difflib
import functools
import re
import secrets
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar, cast

from hydra.core.config_store import ConfigStore
from hydra.core.hydra_config import HydraConfig
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import ChoiceSweep
from hydra.errors import HydraException, MissingConfigException, OverrideParseException
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from dcg_torch.cli.settings_help import SCHEMAS, config_groups, settings_help
from dcg_torch.report.summary import flatten
from dcg_torch.settings import (
    EvaluateSettings,
    ModelSettings,
    Settings,
    SettingsError,
    SimulatorSettings,
    TalkSettings,
    check,
    check_bounds,
    check_values,
    described,
)
from dcg_torch.storage.atomic_files import write_whole
from dcg_torch.storage.resources import resource
from dcg_torch.storage.untrusted_files import plain, shown

T = TypeVar("T")
CONFIG_ERRORS = (HydraException, OmegaConfBaseException)
"""What Hydra raises when overrides or YAML files are wrong; `explain` says it in one line."""

# At import, since the jobs of a parallel sweep start in processes that never see `register`.
OmegaConf.register_new_resolver("resource", lambda name: str(resource(name)), replace=True)
OmegaConf.register_new_resolver("settings_help", settings_help, replace=True)
OmegaConf.register_new_resolver("config_groups", config_groups, replace=True)
# Two processes that start in the same second get folders of their own.
OmegaConf.register_new_resolver("unique", lambda: secrets.token_hex(3), use_cache=True, replace=True)


def register(program: str = "run") -> None:
    """Make the schemas known to Hydra, so that a misspelt key or a wrong type fails before the run.

    Args:
        program: of `settings_help.SCHEMAS`; `talk` has no groups, so that its `model` may be a folder.
    """
    store = ConfigStore.instance()
    if program == "talk":
        for group in ("model", "simulator"):  # of an experiment in the same process
            store.repo.pop(group, None)
        store.store(name="talk_schema", node=TalkSettings)
        return
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
    return _checked(config, Settings, check)


def evaluate_settings_of(config: DictConfig) -> EvaluateSettings:
    """The checked settings of `evaluate`; what depends on the episodes is checked with them."""
    return _checked(config, EvaluateSettings, check_bounds)


def talk_settings_of(config: DictConfig) -> TalkSettings:
    """The checked settings of `talk`."""
    return _checked(config, TalkSettings, check_values)


def _checked(config: DictConfig, schema: type[T], check_them: Callable[[T], None]) -> T:
    _refuse_choices()
    _refuse_added(config, schema)
    settings = cast(T, OmegaConf.to_object(config))
    check_them(settings)
    return settings


def refuse_nothing(overrides: Sequence[str]) -> None:
    """See that an override that chooses one of a group names one, and that a sweep has each setting once.

    To null, truth values and numbers Hydra would answer with a traceback; of a list of models it would mix one. Of a
    setting that is given twice the last counts, but jobs that differ in the first alone would share a folder.

    Raises:
        SettingsError: one does not.
        OverrideParseException: one is no override.
    """
    before: dict[str, str] = {}
    for override in overrides:
        group, equals, _ = override.lstrip("+~").partition("=")
        if not group:
            raise SettingsError(f"{plain(override, 80)}: not an override; write KEY=VALUE")
        first = before.setdefault(group, override)
        if first is not override and any(map(_is_sweep, (first, override))):
            raise SettingsError(f"{plain(first, 80)} and {plain(override, 80)}: a sweep has each setting once")
        if _ENDLESS.search(override):
            raise SettingsError(f"{plain(group)}: a number of hundreds of digits makes no sense; give a shorter one")
        if override.startswith("~") and group in _GROUPS:
            _refuse_choice(group, "null")
        if not equals or not ("/" in group or group in (*_GROUPS, "experiment")):
            continue
        chosen = OverridesParser.create().parse_override(override).value()
        for one in chosen.list if isinstance(chosen, ChoiceSweep) else (chosen,):
            names = one if isinstance(one, list) and group not in _GROUPS else [one]
            if any(name is None or isinstance(name, (bool, int, float, dict, list)) for name in names):
                _refuse_choice(group, "null" if one is None else one)


def _is_sweep(override: str) -> bool:
    return "=" in override and bool(OverridesParser.create().parse_override(override).is_sweep_override())


_GROUPS = ("model", "simulator")
_ENDLESS = re.compile(r"[0-9]{300}")  # beyond what a float holds


def _refuse_choices() -> None:
    """See that a kind of model and of simulator was chosen, not just their schema."""
    if not HydraConfig.initialized():
        return
    if HydraConfig.get().job.chdir:
        raise SettingsError("hydra.job.chdir=true: files are named from where you are; leave it out")
    for group, chosen in HydraConfig.get().runtime.choices.items():
        if group in _GROUPS and chosen in (None, "null", "schema"):
            _refuse_choice(group, chosen or "null")


def _refuse_choice(group: str, chosen: object) -> None:
    there = sorted(path.stem for path in (resource("conf") / group).glob("*.yaml"))
    mend = f"choose from {', '.join(there)}" if there else "give the name of one"
    raise SettingsError(f"{group}={shown(chosen).strip(_QUOTE)}: there is no such {group}; {mend}")


_QUOTE = "'"


def _refuse_added(config: DictConfig, schema: type) -> None:
    for key in flatten(cast(dict[str, Any], OmegaConf.to_container(config))):
        if key not in _keys(schema):  # Hydra's "+key=value" adds what the schema doesn't have
            raise SettingsError(_unknown_key(key, schema))


def save_composed(config: DictConfig, directory: Path) -> None:
    """Write `.hydra` into a run folder: the configuration, Hydra's own, and the overrides that were given.

    Hydra would write it before the program runs, over that of the experiment which the folder may hold.
    """
    own = HydraConfig.get()
    for name, part in (
        ("config", config),
        ("hydra", OmegaConf.create({"hydra": own})),
        ("overrides", own.overrides.task),
    ):
        write_whole(directory / ".hydra" / f"{name}.yaml", OmegaConf.to_yaml(part))


def explain(error: Exception, program: str = "run") -> str:
    """One line for the user from one of `CONFIG_ERRORS`: what, where, how to mend it.

    Args:
        program: whose settings a misspelt one is compared with.
    """
    cause = error.__cause__ or error.__context__
    first = next(iter(_lines(error)), type(error).__name__)
    if isinstance(error, MissingConfigException):
        group, _, option = (error.missing_cfg_file or "").rpartition("/")
        choices = sorted(set(error.options or ()) - {"schema"})
        if not group:
            return f"there is no configuration {option!r} in {resource('conf')}; leave --config-name out"
        extra = _PLUGINS.get(f"{group}={option}")
        get = f", or install {extra[0]} (the extra {extra[1]}: pip install -e '.[{extra[1]}]')" if extra else ""
        return f"{group}={option}: there is no such {group}; choose from {', '.join(choices)}{get}"
    if isinstance(error, OverrideParseException):
        given = plain(str(error.override), 80)
        return f"{given}: not an override; write KEY=VALUE, in quotes if it holds brackets or spaces"
    if first.startswith("Ambiguous value for argument"):
        given = plain(first.partition("'")[2].rstrip("'"), 80)
        of, _, values = given.partition("=")
        return f"{given}: several values; a list stands in brackets, {of}=[{values}], and -m makes a run of each"
    key = getattr(cause, "full_key", None) or getattr(error, "full_key", None)
    if first.startswith(("Could not override", "Could not append")):
        return _unknown_key(str(key or first.split("'")[1]), SCHEMAS[program])
    if first.startswith("Error merging override") and cause is not None:
        given = first.removeprefix("Error merging override ")
        return f"{plain(given, 120)}: {_wanted(_lines(cause)[0], given)}"
    return f"{key}: {first}" if key and str(key) not in first else " ".join(_lines(error))


def _wanted(said: str, given: str) -> str:
    """What to give instead, from what OmegaConf says of a value of another kind."""
    key, _, value = given.lstrip("+").partition("=")
    for part, wanted in (
        ("converted to Integer", "give a whole number"),
        ("converted to Float", "give a number"),
        ("is not a valid bool", "give true or false"),
        ("is not a ListConfig", f"give a list in brackets, as in {plain(key)}=[{plain(value, 40) or 'a'}]"),
        ("to string", "give a text"),
        ("is not a subclass", f"it holds several settings; set one at a time, as in {plain(key)}.NAME=VALUE"),
        ("expected one of [", f"give one of {said.rpartition('[')[2].rstrip(']')}"),
    ):
        if part in said:
            return wanted
    return plain(said, 200)


_PLUGINS = {
    "hydra/launcher=joblib": ("hydra-joblib-launcher==1.2.0", "sweep"),
    "hydra/launcher=ray": ("hydra-ray-launcher==1.2.2", "ray"),
    "hydra/launcher=submitit_local": ("hydra-submitit-launcher==1.2.0", "slurm"),
    "hydra/launcher=submitit_slurm": ("hydra-submitit-launcher==1.2.0", "slurm"),
    "hydra/sweeper=optuna": ("hydra-optuna-sweeper==1.3.0", "optuna"),
}
"""What may be installed besides: its package, and our extra that draws it in."""


def launcher_of(hydra: Any) -> str:
    """Who starts the jobs of a sweep: "basic" (this process), "joblib", "ray", "submitit"."""
    target = str(hydra.launcher["_target_"])
    return next((name for name in ("joblib", "ray", "submitit") if name in target.lower()), "basic")


def _unknown_key(key: str, schema: type) -> str:
    near = difflib.get_close_matches(key[:100], sorted(_keys(schema)), n=1)
    hint = f"did you mean {near[0]}?" if near else "--help lists all"
    return f"{key}: there is no such setting; {hint}"


@functools.cache
def _keys(schema: type) -> frozenset[str]:
    """The dotted names of all settings, and of the groups that they are in."""
    names = [name for name, *_ in described(schema)]
    return frozenset(names) | {name.rpartition(".")[0] for name in names if "." in name}


def _lines(error: BaseException) -> list[str]:
    return [line.strip() for line in str(error).splitlines() if line.strip()]
