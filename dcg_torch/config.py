"""Hydra's side of the settings: their registration as schemas, and the table at the end of a sweep."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

from hydra.core.config_store import ConfigStore
from hydra.experimental.callback import Callback
from omegaconf import DictConfig, OmegaConf
from rich.console import Console

from dcg_torch.report.tables import tabulate_sweep
from dcg_torch.resources import resource
from dcg_torch.settings import ModelSettings, Settings, SimulatorSettings, check


def register() -> None:
    """Make the schemas known to Hydra, so that a misspelt key or a wrong type fails before the run."""
    OmegaConf.register_new_resolver("resource", lambda name: str(resource(name)), replace=True)
    store = ConfigStore.instance()
    store.store(name="schema", node=Settings)
    store.store(group="model", name="schema", node=ModelSettings)
    store.store(group="simulator", name="schema", node=SimulatorSettings)


def settings_of(config: DictConfig) -> Settings:
    """The checked settings of a composed configuration.

    Raises:
        SettingsError: a value makes no sense.
    """
    settings = cast(Settings, OmegaConf.to_object(config))
    check(settings)
    return settings


class SweepTable(Callback):
    """Prints the table of a sweep when its last job is done."""

    def on_multirun_end(self, config: DictConfig, **kwargs: Any) -> None:
        """Hydra's hook."""
        Console().print(tabulate_sweep(Path(config.hydra.sweep.dir)))
