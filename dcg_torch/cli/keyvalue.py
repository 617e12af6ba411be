"""Settings as KEY=VALUE for programs that compose nothing: into a plain dataclass, or an error of one line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar, cast

from omegaconf import OmegaConf
from omegaconf.errors import OmegaConfBaseException

from dcg_torch.cli.settings_help import setting_lines
from dcg_torch.settings import SettingsError, check_values, described
from dcg_torch.storage.untrusted_files import misspelt

T = TypeVar("T")


def read_settings(schema: type[T], arguments: Sequence[str]) -> T:
    """The checked settings of a schema of `settings`' form, from KEY=VALUE each; `null` is none.

    Raises:
        SettingsError: one is no setting, or its value makes no sense.
    """
    known = tuple(name for name, *_ in described(schema))
    config = OmegaConf.structured(schema)
    for argument in arguments:
        key, equals, value = argument.partition("=")
        if not equals:
            raise SettingsError(f"{argument}: not a setting; write KEY=VALUE, as in {known[0]}=...")
        if key not in known:
            near = misspelt(key, known)
            raise SettingsError(
                f"{key}: there is no such setting; " + (f"did you mean {near}?" if near else "see --help")
            )
        try:
            OmegaConf.update(config, key, None if value == "null" else value)
        except OmegaConfBaseException as error:
            raise SettingsError(f"{argument}: {str(error).splitlines()[0]}") from None
    try:
        settings = cast(T, OmegaConf.to_object(config))
    except OmegaConfBaseException as error:
        raise SettingsError(" ".join(str(error).split())) from None
    check_values(settings)
    return settings


def settings_text(schema: type) -> str:
    """A line or more for each setting of a schema, with its default."""
    return "\n".join(setting_lines(schema, OmegaConf.structured(schema)))
