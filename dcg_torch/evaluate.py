"""`python -m dcg_torch.evaluate train=FILE test=FILE`: train on one episode file and ground another."""

from __future__ import annotations

import gc
import json
import os
import sys
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

import hydra
import numpy as np
import torch
from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from dcg_torch.checkpoint import save
from dcg_torch.cli.application import one_line_errors, run_application
from dcg_torch.cli.config import evaluate_settings_of, save_composed
from dcg_torch.cli.console import Bar, make_console
from dcg_torch.evaluation.episodes import Episode, read_episodes, split_folds
from dcg_torch.evaluation.protocol import CAUSES, Answer, Evaluation, summarise
from dcg_torch.experiment.factory import variant
from dcg_torch.explanation import Reason, explain, rivalry
from dcg_torch.language import default_parser
from dcg_torch.lessons import training_set
from dcg_torch.lessons.generated import generated_lessons
from dcg_torch.resources import resource
from dcg_torch.settings import EvaluateSettings, SettingsError
from dcg_torch.storage.claim import claim
from dcg_torch.storage.whole import write_whole, write_whole_folder

PREDICTIONS, SUMMARY, MODEL = "predictions.jsonl", "summary.json", "model"
MARKS = (PREDICTIONS, f"{PREDICTIONS}.part", SUMMARY, MODEL, ".hydra")
_REASONS = 8  # shown for each phrase


def evaluate(settings: EvaluateSettings, directory: Path, console: Console) -> dict[str, object]:
    """Train, ground, write `predictions.jsonl` and the model into `directory`; the figures.

    Files of an earlier run there are removed first, and each appears whole or not at all.

    Raises:
        EpisodeError: an episode file is missing or not valid.
        SettingsError: a setting makes no sense.
    """
    torch.set_num_threads(1)
    pairs = _pairs(settings)
    _check(settings, pairs)
    chosen = variant(settings.model)
    answers: list[Answer] = []
    learned: dict[str, dict[str, str]] = {"nouns": {}, "colors": {}}
    train_seconds, baseline = 0.0, []
    directory.mkdir(parents=True, exist_ok=True)
    for name in (PREDICTIONS, SUMMARY):
        (directory / name).unlink(missing_ok=True)
    part = directory / f"{PREDICTIONS}.part"
    with part.open("w", encoding="utf-8") as file:
        for train, test in pairs:
            console.print(f"training on {len(train)} episodes, {settings.rounds} rounds")
            with Bar("training", settings.rounds, console) as bar:
                evaluation = Evaluation(
                    train,
                    training_set(settings.training),
                    chosen,
                    default_parser().parse,
                    known_types=settings.known_types,
                    known_colors=settings.known_colors,
                    generated=generated_lessons(default_parser().parse, settings.model.lessons),
                    rounds=settings.rounds,
                    progress=bar.advance,
                )
            train_seconds += evaluation.train_seconds
            gc.collect()
            gc.freeze()  # the corpus lives on: walking it would stop a command for up to 0.1 s now and then
            with Bar("grounding", len(test), console) as bar:
                for answer in evaluation.answers(test, learn=settings.learn):
                    answers.append(answer)
                    file.write(json.dumps(answer.record(), ensure_ascii=False) + "\n")
                    if answer.episode.id == settings.explain:
                        _print_reasons(evaluation, answer, console)
                    bar.advance()
            for kind, words in evaluation.learned.items():
                learned[kind] |= words
            if settings.baseline:
                from dcg_torch.evaluation.baseline import bag_of_words

                baseline += bag_of_words(train, test)
    os.replace(part, directory / PREDICTIONS)
    if settings.save and not settings.folds:
        write_whole_folder(directory / MODEL, lambda folder: save(evaluation.model, folder))
    figures = summarise(answers, train_seconds, by_color=settings.known_colors is not None)
    _print_errors(answers, console)
    if settings.learn:
        figures["learned"] = learned
        for kind, words in learned.items():
            told = ", ".join(f"{word} = {meaning}" for word, meaning in words.items()) or "none"
            console.print(f"{kind} learned: {told}", markup=False)
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


def _check(settings: EvaluateSettings, pairs: Sequence[tuple[list[Episode], list[Episode]]]) -> None:
    """See that the settings fit the episodes, before anything is written.

    Raises:
        SettingsError: one does not.
    """
    if settings.explain is not None and not any(e.id == settings.explain for _, test in pairs for e in test):
        some = ", ".join(e.id for e in pairs[0][1][:5])
        raise SettingsError(f"explain={settings.explain}: no test episode has this id; ids are {some} ...")
    train = [e for episodes, _ in pairs for e in episodes]
    meant = [o for e in train for o in e.objects if o.id in e.target]
    for name, wanted, there in (
        ("known_types", settings.known_types, {o.type for o in meant}),
        ("known_colors", settings.known_colors, {o.color for o in meant if o.color is not None}),
    ):
        if wanted is None:
            continue
        strange = [one for one in wanted if one not in there]
        if strange or not wanted:
            what = f"{strange[0]!r} is meant in no training episode" if strange else "there is nothing to learn from"
            raise SettingsError(f"{name}={wanted}: {what}; choose from {', '.join(sorted(there)) or 'none'}")
    if settings.baseline:
        try:
            import sklearn  # noqa: F401
        except ImportError:
            raise SettingsError("baseline=true needs scikit-learn; install dcg-torch[bench]") from None


def _print_errors(answers: Sequence[Answer], console: Console) -> None:
    counts = Counter(a.cause for a in answers if a.cause is not None)
    table = Table(title=f"Errors by cause, {sum(counts.values())} of {len(answers)} commands")
    for column in ("cause", "commands", "share"):
        table.add_column(column, justify="left" if column == "cause" else "right")
    for cause in CAUSES:
        table.add_row(cause, str(counts[cause]), f"{100 * counts[cause] / len(answers):.1f} %")
    console.print(table)


def _print_reasons(evaluation: Evaluation, answer: Answer, console: Console) -> None:
    """Which phrases, which groundings, which features moved them; and what told the answer from the second best."""
    console.print(f"{answer.episode.id}: {answer.episode.text}", markup=False)
    solution = answer.solution
    if solution is None or solution.object is None:
        console.print(f"not grounded: {answer.parse.problem}", markup=False)
        return
    console.print(f"grounded to {list(answer.predicted)}, probability {answer.probability:.3f}", markup=False)
    _print_table("what moved it, as log-odds", explain(evaluation.model, solution), console)
    second = rivalry(evaluation.model, solution)
    if second is not None:
        probability = solution.probabilities[second.object.id]
        title = (
            f"what told {solution.object.id} from the second best, {second.object.id} (probability {probability:.3f}): "
            f"log-odds {second.log_odds:+.2f}"
        )
        _print_table(title, second.reasons, console)


def _print_table(title: str, reasons: Iterable[Reason], console: Console) -> None:
    table = Table(title=title, title_justify="left")
    for column in ("phrase", "grounding", "feature of the phrase", "feature of the grounding", "log-odds"):
        table.add_column(column, justify="right" if column == "log-odds" else "left")
    shown: Counter[tuple[str, str]] = Counter()
    for reason in reasons:
        shown[reason.phrase, reason.grounding] += 1
        if shown[reason.phrase, reason.grounding] <= _REASONS:
            cells = (reason.phrase, reason.grounding, reason.language, reason.feature)
            table.add_row(*map(escape, cells), f"{reason.log_odds:+.2f}")
    console.print(table)


def _application(config: DictConfig) -> None:
    directory, console = Path(HydraConfig.get().runtime.output_dir), make_console()
    with one_line_errors(directory, program="evaluate"):
        settings = evaluate_settings_of(config)
        with claim(directory, MARKS):
            figures = evaluate(settings, directory, console)
            save_composed(config, directory)
            write_whole(directory / SUMMARY, json.dumps(figures, indent=1) + "\n")
            print(json.dumps({**figures, "run_dir": str(directory)}), flush=True)


def main() -> int:
    """Run the command line; the exit status: 0 done, 2 wrong input, 130 interrupted."""
    wrap = hydra.main(version_base="1.3", config_path=str(resource("conf")), config_name="evaluate")
    return run_application(wrap(_application), "evaluate")


if __name__ == "__main__":
    sys.exit(main())
