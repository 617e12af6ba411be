"""The folders of runs and sweeps as Hydra makes them, and the table of a sweep."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Any, cast

from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.experimental.callback import Callback
from omegaconf import DictConfig, OmegaConf, open_dict, read_write

from dcg_torch.cli.application import GOES_ON, one_line_errors
from dcg_torch.cli.console import make_console
from dcg_torch.experiment.backends import remove_shared_memory
from dcg_torch.report.runs import load_runs
from dcg_torch.report.show import print_several, save_several_figure
from dcg_torch.storage.claim import check_place, claim

# Not in the callback, which a launcher may send to other processes.
_HELD = contextlib.ExitStack()


class Folders(Callback):
    """Guards the folders that Hydra makes, and names those of a sweep by what differs between its runs.

    When all runs of a sweep are done it compares them.
    """

    def on_run_start(self, config: DictConfig, **_: Any) -> None:
        """See that the folder of a single run is one, before Hydra makes it."""
        with one_line_errors():  # Hydra makes a warning of what a callback raises, but lets the program end
            check_place(Path(config.hydra.run.dir))

    def on_multirun_start(self, config: DictConfig, **_: Any) -> None:
        """Claim the folder of the sweep, and leave the overrides that all runs share out of the names in it."""
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # Ray's launcher would tell its makers of every sweep
        with one_line_errors():
            folder = claim(Path(config.hydra.sweep.dir), ("multirun.yaml",), setting="hydra.sweep.dir")
            if (killed := _HELD.enter_context(folder)) is not None:
                sweep_shared_memory(killed)
        GOES_ON.set(f"the same command with hydra.sweep.dir={config.hydra.sweep.dir} goes on from here")
        settings = cast(dict[str, Any], OmegaConf.to_container(config.hydra, resolve=False))
        params = settings["sweeper"].get("params") or {}
        given = [*settings["overrides"]["task"], *(f"{key}={value}" for key, value in params.items())]
        overrides = OverridesParser.create().parse_overrides(given)
        shared = {o.get_key_element() for o in overrides if not o.is_sweep_override()}
        if any(o.is_sweep_override() for o in overrides):
            with read_write(config), open_dict(config):
                excluded = f"hydra.job.config.override_dirname.exclude_keys=[{','.join(sorted(shared))}]"
                config.hydra.overrides.hydra.append(excluded)

    def on_multirun_end(self, config: DictConfig, **_: Any) -> None:
        """Print the table and the comparison, and draw the latter."""
        with one_line_errors():
            compare_runs(Path(config.hydra.sweep.dir))
        _HELD.close()
        GOES_ON.set("")


def sweep_shared_memory(process: int) -> None:
    """Remove what joblib left of a run or a sweep that was killed, if that process is really gone."""
    if Path(f"/proc/{process}").exists():
        return
    remove_shared_memory(process)


def compare_runs(directory: Path) -> None:
    """Print what the runs at or below `directory` amount to side by side, and draw it in `comparison.png` there."""
    console = make_console()
    runs = load_runs([directory])
    print_several(runs, console)
    if len(runs) > 1:
        console.print(f"figure: {save_several_figure(runs, directory)}")
        console.print(f"curves: tensorboard --logdir {directory}")
