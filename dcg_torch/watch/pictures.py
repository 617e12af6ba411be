"""The pictures of an experiment's worlds that people are shown, to ask them for commands (the paper's Fig. 5)."""

from __future__ import annotations

from pathlib import Path

from joblib import Parallel, delayed

from dcg_torch.experiment.plan import trial_generators, trial_worlds
from dcg_torch.settings import Settings


def save_screenshots(settings: Settings, directory: Path, workers: int = 2) -> list[Path]:
    """Write `<world>-<object id>.png` for every pair of a world and an object in it.

    The worlds are those of the experiment; where each trial has its own, those of the first.

    Raises:
        WorldFileError: a world file is missing or not valid.
    """
    from dcg_torch.simulator.screenshot import save_pair_screenshots

    worlds = trial_worlds(settings, trial_generators(settings.seed, 0)[0])
    made = Parallel(n_jobs=workers)(delayed(save_pair_screenshots)([world], directory) for world in worlds)
    return [path for paths in made for path in paths]
