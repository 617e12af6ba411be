"""The splits that the settings of `evaluate` ask for, read from their files."""

from __future__ import annotations

import numpy as np

from dcg_torch.evaluation.episodes import Episode, read_episodes
from dcg_torch.evaluation.splits import Split, cross_validation, split_halves
from dcg_torch.settings import EvaluateSettings, SettingsError
from dcg_torch.storage.untrusted_files import at_home


def read_splits(settings: EvaluateSettings) -> list[Split]:
    """What to train and test on; a split for each fold if there are folds.

    Raises:
        EpisodeError: an episode file is missing or not valid, or has too few groups to be split.
        SettingsError: files are missing or too many, or two have one name.
    """
    files = {key: _read(key, getattr(settings, key)) for key in ("train", "test")}
    if not settings.folds and not settings.halves:
        if not files["test"]:
            raise SettingsError("test: no file given; write test=FILE, or train=FILE folds=5 to cross-validate one")
        return [Split(files["train"], files["test"])]
    asked = f"folds={settings.folds}" if settings.folds else "halves=true"
    if settings.folds and settings.halves:
        raise SettingsError(f"{asked}: goes without halves=true")
    if settings.folds == 1:
        raise SettingsError(f"{asked}: is too few; give at least 2")
    if files["test"] or not files["train"]:
        raise SettingsError(f"{asked}: goes with train=FILE and no test file")
    if settings.halves:
        return [split_halves(files["train"])]
    return cross_validation(files["train"], settings.folds, np.random.default_rng(0))


def _read(key: str, given: object) -> dict[str, list[Episode]]:
    """The files of a setting that names none, one or several."""
    named = [] if given is None else list(given) if isinstance(given, list | tuple) else [given]
    if not all(isinstance(one, str) and one for one in named):
        raise SettingsError(f"{key}: write {key}=FILE, or {key}=[FILE,FILE]")
    found: dict[str, list[Episode]] = {}
    for one in named:
        path = at_home(str(one))
        if path.stem in found:
            raise SettingsError(f"{key}: two files are called {path.stem}; rename one")
        found[path.stem] = read_episodes(path)
    return found
