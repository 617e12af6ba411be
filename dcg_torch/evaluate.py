"""`python -m dcg_torch.evaluate train=FILE test=FILE`: train on one episode file and ground another."""

from __future__ import annotations

import json
import os
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import hydra
import numpy as np
import torch
from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig, OmegaConf
from rich.console import Console
from rich.progress import track
from rich.table import Table

from dcg_torch.__main__ import refuse, run_application
from dcg_torch.config import CONFIG_ERRORS, save_composed
from dcg_torch.config import explain as explain_error
from dcg_torch.console import make_console
from dcg_torch.episodes import Episode, EpisodeError, read_episodes, split_folds
from dcg_torch.evaluation import CAUSES, Answer, Evaluation, summarise
from dcg_torch.explanation import explain
from dcg_torch.language import default_parser
from dcg_torch.resources import resource
from dcg_torch.settings import EvaluateSettings, SettingsError
from dcg_torch.training import initial_training
from dcg_torch.worker import variant

PREDICTIONS = "predictions.jsonl"
_REASONS = 8  # shown for each phrase


def evaluate(settings: EvaluateSettings, directory: Path, console: Console) -> dict[str, object]:
    """Train, ground, write `predictions.jsonl` into `directory`; the figures.

    Raises:
        EpisodeError: an episode file is missing or not valid.
        SettingsError: a setting makes no sense.
    """
    torch.set_num_threads(1)
    pairs = _pairs(settings)
    if settings.explain is not None and not any(e.id == settings.explain for _, test in pairs for e in test):
        raise SettingsError(f"explain={settings.explain}: no test episode has this id")
    answers: list[Answer] = []
    train_seconds, baseline = 0.0, []
    part = directory / f"{PREDICTIONS}.part"
    directory.mkdir(parents=True, exist_ok=True)
    with part.open("w", encoding="utf-8") as file:
        for train, test in pairs:
            console.print(f"training on {len(train)} episodes, {settings.rounds} rounds")
            evaluation = Evaluation(
                train,
                initial_training(),
                variant(settings.model),
                default_parser().parse,
                known_types=settings.known_types,
                rounds=settings.rounds,
                progress=lambda number: console.print(f"round {number + 1} done"),
            )
            train_seconds += evaluation.train_seconds
            found = evaluation.answers(test, learn=settings.learn)
            for answer in track(found, "grounding", total=len(test), console=console):
                answers.append(answer)
                file.write(json.dumps(answer.record(), ensure_ascii=False) + "\n")
                if answer.episode.id == settings.explain and answer.solution is not None:
                    _print_reasons(evaluation, answer, console)
            if settings.learn:
                words = {s.word: s.type for s in evaluation.model.symbols.values()}
                console.print("words known at the end: " + ", ".join(f"{w} = {t}" for w, t in words.items()))
            if settings.baseline:
                from dcg_torch.baseline import bag_of_words

                baseline += bag_of_words(train, test)
    os.replace(part, directory / PREDICTIONS)
    _print_errors(answers, console)
    figures = summarise(answers, train_seconds)
    if settings.baseline:
        figures["baseline_accuracy"] = sum(baseline) / len(baseline)
        console.print(f"logistic regression on words x object features: {figures['baseline_accuracy']:.4f}")
    return figures


def _pairs(settings: EvaluateSettings) -> list[tuple[list[Episode], list[Episode]]]:
    """The training and test episodes, of each fold if there are folds."""
    train = read_episodes(Path(settings.train).expanduser())
    if settings.folds:
        if settings.test is not None or settings.folds < 2:
            raise SettingsError(f"folds={settings.folds}: give at least 2, and no test file")
        parts = split_folds(train, settings.folds, np.random.default_rng(0))
        return [([e for other in parts if other is not part for e in other], part) for part in parts]
    if settings.test is None:
        raise SettingsError("test: no file given; write test=FILE, or folds=5 to cross-validate the training file")
    return [(train, read_episodes(Path(settings.test).expanduser()))]


def _print_errors(answers: Sequence[Answer], console: Console) -> None:
    counts = Counter(a.cause for a in answers if a.cause is not None)
    table = Table(title=f"Errors by cause, {sum(counts.values())} of {len(answers)} commands")
    for column in ("cause", "commands", "share"):
        table.add_column(column, justify="left" if column == "cause" else "right")
    for cause in CAUSES:
        table.add_row(cause, str(counts[cause]), f"{100 * counts[cause] / len(answers):.1f} %")
    console.print(table)


def _print_reasons(evaluation: Evaluation, answer: Answer, console: Console) -> None:
    assert answer.solution is not None
    console.print(f"{answer.episode.id}: {answer.episode.text}", markup=False)
    console.print(f"grounded to {list(answer.predicted)}, probability {answer.solution.probability:.3f}", markup=False)
    table = Table(title="what moved it, as log-odds")
    for column in ("phrase", "grounding", "feature of the phrase", "feature of the grounding", "log-odds"):
        table.add_column(column, justify="right" if column == "log-odds" else "left")
    shown: Counter[tuple[str, str]] = Counter()
    for reason in explain(evaluation.model, answer.solution):
        shown[reason.phrase, reason.grounding] += 1
        if shown[reason.phrase, reason.grounding] <= _REASONS:
            table.add_row(reason.phrase, reason.grounding, reason.language, reason.feature, f"{reason.log_odds:+.2f}")
    console.print(table)


def _application(config: DictConfig) -> None:
    directory, console = Path(HydraConfig.get().runtime.output_dir), make_console()
    try:
        settings = OmegaConf.to_object(config)
        assert isinstance(settings, EvaluateSettings)
        figures = evaluate(settings, directory, console)
        save_composed(config, directory)
        (directory / "summary.json").write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
        print(json.dumps({**figures, "run_dir": str(directory)}), flush=True)
    except CONFIG_ERRORS as error:
        sys.exit(refuse(explain_error(error), directory))
    except (EpisodeError, SettingsError) as error:
        sys.exit(refuse(str(error), directory))


def main() -> int:
    """Run the command line; the exit status: 0 done, 2 wrong input, 130 interrupted."""
    return run_application(
        hydra.main(version_base="1.3", config_path=str(resource("conf")), config_name="evaluate")(_application)
    )


if __name__ == "__main__":
    sys.exit(main())
