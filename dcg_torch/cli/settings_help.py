"""What each setting means, for `--help`: from the schemas, with the values that were composed."""

from __future__ import annotations

import enum
import textwrap
from collections.abc import Iterator
from typing import Any

from omegaconf import DictConfig, OmegaConf

from dcg_torch.settings import EvaluateSettings, Settings, TalkSettings, described
from dcg_torch.storage.resources import resource

SCHEMAS: dict[str, type] = {"run": Settings, "evaluate": EvaluateSettings, "talk": TalkSettings}
_MEANING = 34  # column at which the meanings begin
_WIDTH = 118


def settings_help(program: str, *, _root_: DictConfig) -> str:
    """A line or more for each setting: its name, the value it has now, what it means, what numbers make sense."""
    return "\n".join(setting_lines(SCHEMAS[program], _root_))


def setting_lines(schema: type, config: DictConfig) -> Iterator[str]:
    """The lines of one schema, with the values of a configuration."""
    for name, default, text, bounds in described(schema):
        value = default if OmegaConf.is_missing(config, name) else OmegaConf.select(config, name, default=default)
        choices = f": {', '.join(type(default))}" if isinstance(default, enum.Enum) else ""
        meaning = f"{text}{choices}" + (f" ({bounds})" if bounds is not None else "")
        head = f"  {name}={_written(value)}"
        if len(head) >= _MEANING:
            yield head
            head = ""
        for line in textwrap.wrap(meaning, _WIDTH - _MEANING):
            yield f"{head:<{_MEANING}}{line}"
            head = ""


def _written(value: Any) -> str:
    if value is None:
        return "null"
    if isinstance(value, bool):
        return str(value).lower()
    plain = OmegaConf.to_container(value) if OmegaConf.is_config(value) else value
    return f"[{','.join(map(str, plain))}]" if isinstance(plain, list) else str(plain).replace("???", "")


def config_groups() -> str:
    """The groups of settings that come along, each with its choices; Hydra's own list names our schemas as well."""
    groups = sorted(group for group in resource("conf").iterdir() if group.is_dir())
    return "\n".join(f"{g.name}: {', '.join(sorted(one.stem for one in g.glob('*.yaml')))}" for g in groups)
