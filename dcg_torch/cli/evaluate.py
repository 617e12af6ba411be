"""`python -m dcg_torch.evaluate test=FILE [train=FILE]`: ground the commands of episode files."""

from __future__ import annotations

import gc
import json
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import hydra
import torch
from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from dcg_torch.cli.application import one_line_errors, run_application
from dcg_torch.cli.config import evaluate_settings_of, save_composed
from dcg_torch.cli.console import Bar, make_console
from dcg_torch.cli.splits import read_splits
from dcg_torch.evaluation.baselines import make_baseline, run_baseline
from dcg_torch.evaluation.baselines.base import Baseline
from dcg_torch.evaluation.baselines.run import Outcome
from dcg_torch.evaluation.certify import certify
from dcg_torch.evaluation.episodes import Episode, turned_note, unused_note
from dcg_torch.evaluation.protocol import CAUSES, Answer, Training, answers, train
from dcg_torch.evaluation.splits import Split
from dcg_torch.evaluation.summary import by_file, summarise
from dcg_torch.evaluation.summary import figures as of_all
from dcg_torch.experiment.factory import make_model
from dcg_torch.experiment.lessons_note import lessons_note
from dcg_torch.fitting.devices import device_of
from dcg_torch.grounding.explanation import Reason, explain, rivalry
from dcg_torch.language import default_parser
from dcg_torch.model import GroundingModel
from dcg_torch.model.checkpoint import save
from dcg_torch.report.runs import PREDICTIONS
from dcg_torch.settings import EvaluateSettings, SettingsError
from dcg_torch.storage.atomic_files import write_whole, write_whole_folder
from dcg_torch.storage.claim import claim
from dcg_torch.storage.resources import resource

SUMMARY, MODEL = "summary.json", "model"
MARKS = (PREDICTIONS, f"{PREDICTIONS}.part", SUMMARY, MODEL, ".hydra")
_REASONS = 8  # shown for each phrase


def evaluate(settings: EvaluateSettings, directory: Path, console: Console) -> dict[str, object]:
    """Train, ground, write `predictions.jsonl` and the model into `directory`; the figures.

    Raises:
        DeviceError: torch cannot use the device here.
        EpisodeError: an episode file is missing or not valid.
        SettingsError: a setting makes no sense.
    """
    torch.set_num_threads(1)
    device_of(settings.device)
    splits = read_splits(settings)
    _check(settings, splits)
    # With folds, too, the first split has all episodes.
    all_ = [e for of in (splits[0].train, splits[0].test) for part in of.values() for e in part]
    notes = unused_note(all_), turned_note(all_), lessons_note(settings.model, settings.training)
    for note in filter(None, notes):
        console.print(f"note: {note}", markup=False)
    for name in (PREDICTIONS, SUMMARY):
        (directory / name).unlink(missing_ok=True)
    model, found, learned, train_seconds = _ground(settings, splits, directory, console)
    if settings.save and not settings.folds:
        write_whole_folder(directory / MODEL, lambda folder: save(model, folder))
    further: dict[str, Any] = {}
    if settings.baseline:
        further["baselines"] = _baselines(settings, splits, console)
    if settings.certify:
        further["certify"] = _certify(model, splits, console)
    figures = summarise(found, train_seconds, by_color=settings.known_colors is not None)
    _print_files(figures, further.get("baselines", {}), console)
    _print_errors(found, console)
    if settings.learn:
        further["learned"] = learned
        told = ", ".join(f"{word} = {meaning}" for word, meaning in learned.items()) or "none"
        console.print(f"nouns learned: {told}", markup=False)
    return figures | further


def _ground(
    settings: EvaluateSettings, splits: Sequence[Split], directory: Path, console: Console
) -> tuple[GroundingModel, list[Answer], dict[str, str], float]:
    """Train and ground each split, and write its predictions; the last model, all answers, words learned, seconds."""
    found: list[Answer] = []
    learned: dict[str, str] = {}
    train_seconds = 0.0
    part = directory / f"{PREDICTIONS}.part"
    with part.open("w", encoding="utf-8") as file:
        for split in splits:
            model = make_model(settings.model, settings.names, settings.training).to(settings.device)
            train_seconds += _train(model, split, settings, console)
            first = set(model.symbols)
            with Bar("grounding", sum(map(len, split.test.values())), console) as bar:
                for answer in _answers(model, split, settings, console):
                    found.append(answer)
                    file.write(json.dumps(answer.record(), ensure_ascii=False) + "\n")
                    bar.advance()
            learned |= {w: s.type for w, s in model.symbols.items() if w not in first}
    part.replace(directory / PREDICTIONS)
    return model, found, learned, train_seconds


def _baselines(settings: EvaluateSettings, splits: Sequence[Split], console: Console) -> dict[str, Any]:
    """The figures of other ways to answer, on the same episodes and candidates."""
    found: dict[str, Any] = {}
    for name in settings.baseline:
        outcomes: list[Outcome] = []
        certified: dict[str, Any] = {}
        for split in splits:
            baseline = make_baseline(name, _noun_phrase)
            taught = [e for episodes in split.train.values() for e in episodes]
            with Bar(name, sum(map(len, split.test.values())), console) as bar:
                outcomes += run_baseline(baseline, taught, split.test, advance=bar.advance)
            if settings.certify and split is splits[-1]:
                certified = {"certify": _certified(split, _objects_of(baseline))}
        found[name] = {**of_all(outcomes), "by_file": by_file(outcomes), **certified}
    return found


def _noun_phrase(text: str) -> str:
    parse = default_parser().parse(text)
    return " ".join(word for word in (parse.color, parse.noun) if word)


def _certify(model: GroundingModel, splits: Sequence[Split], console: Console) -> dict[str, Any]:
    """How often the answer follows a small change of the episode; by the model of the last split."""
    found = _certified(splits[-1], lambda e: next(iter(answers(model, [e], default_parser().parse))).predicted)
    for kind, of in found.items():
        console.print(f"{kind}: {of['right']} of {of['n']} changes followed", markup=False)
    return found


def _objects_of(baseline: Baseline) -> Callable[[Episode], tuple[str, ...]]:
    return lambda episode: baseline.predict(episode).objects


def _certified(split: Split, answer: Callable[[Episode], tuple[str, ...]]) -> dict[str, Any]:
    return certify(answer, [e for episodes in split.test.values() for e in episodes])


def _train(model: GroundingModel, split: Split, settings: EvaluateSettings, console: Console) -> float:
    """Teach a model its training files, if there are any; the seconds that it took."""
    if not split.train:
        return 0.0
    console.print(f"training on {sum(map(len, split.train.values()))} episodes, {settings.rounds} rounds")
    training = Training(settings.known_types, settings.known_colors, settings.rounds)
    with Bar("training", settings.rounds, console) as bar:
        seconds = train(model, list(split.train.values()), default_parser().parse, training, bar.advance)
    gc.collect()
    gc.freeze()  # walking what is left of the corpus would stop a command for up to 0.1 s now and then
    return seconds


def _answers(model: GroundingModel, split: Split, settings: EvaluateSettings, console: Console) -> Iterable[Answer]:
    """The answers to all test files, one after the other."""
    for name, episodes in split.test.items():
        for answer in answers(model, episodes, default_parser().parse, file=name, learn=settings.learn):
            if answer.episode.id == settings.explain:
                _print_reasons(model, answer, console)
            yield answer


def _check(settings: EvaluateSettings, splits: Sequence[Split]) -> None:
    """See that the settings fit the episodes, before anything is written.

    Raises:
        SettingsError: one does not.
    """
    test = [e for split in splits for episodes in split.test.values() for e in episodes]
    if settings.explain is not None and not any(e.id == settings.explain for e in test):
        some = ", ".join(e.id for e in test[:5])
        raise SettingsError(f"explain={settings.explain}: no test episode has this id; ids are {some} ...")
    taught = [e for split in splits for episodes in split.train.values() for e in episodes]
    meant = [o for e in taught for o in e.objects if o.id in e.target]
    for name, wanted, there in (
        ("known_types", settings.known_types, {o.type for o in meant}),
        ("known_colors", settings.known_colors, {o.color for o in meant if o.color is not None}),
    ):
        if wanted is None:
            continue
        if not taught:
            raise SettingsError(f"{name}: it says what of the training episodes is kept; give train=FILE, too")
        strange = [one for one in wanted if one not in there]
        if strange or not wanted:
            what = f"{strange[0]!r} is meant in no training episode" if strange else "there is nothing to learn from"
            raise SettingsError(f"{name}={wanted}: {what}; choose from {', '.join(sorted(there)) or 'none'}")


def _print_files(figures: dict[str, Any], baselines: dict[str, Any], console: Console) -> None:
    """How many are right in each file and in all, with a column for each baseline."""
    table = Table(title="Right")
    columns = ("file", "commands", "right", "95 % interval", "calibration error", *baselines)
    for column in columns:
        table.add_column(column, justify="left" if column == "file" else "right")
    rows = dict(figures["by_file"])
    ways = [dict(of["by_file"]) for of in baselines.values()]
    if len(rows) > 1:
        for files, all_ in zip((rows, *ways), (figures, *baselines.values()), strict=True):
            files["all"] = all_
    for name, of in rows.items():
        low, high = (100 * share for share in of["ci95"])
        error = of["calibration_error"]
        shown = "-" if error is None else f"{error:.3f}"
        shares = [f"{100 * files[name]['accuracy']:.1f} %" for files in ways]
        table.add_row(
            escape(name), str(of["n"]), f"{100 * of['accuracy']:.1f} %", f"{low:.1f} to {high:.1f}", shown, *shares
        )
    console.print(table)


def _print_errors(found: Sequence[Answer], console: Console) -> None:
    counts = Counter(a.cause for a in found if a.cause is not None)
    if not counts:
        return
    table = Table(title=f"Errors by cause, {sum(counts.values())} of {len(found)} commands")
    for column in ("cause", "commands", "share"):
        table.add_column(column, justify="left" if column == "cause" else "right")
    for cause in CAUSES:
        table.add_row(cause, str(counts[cause]), f"{100 * counts[cause] / len(found):.1f} %")
    console.print(table)


def _print_reasons(model: GroundingModel, answer: Answer, console: Console) -> None:
    """Which phrases, which groundings, which features moved them; and what told the answer from the second best."""
    console.print(f"{answer.episode.id}: {answer.episode.text}", markup=False)
    solution = answer.solution
    if solution is None or solution.object is None:
        console.print(f"not grounded: {answer.parse.problem}", markup=False)
        return
    console.print(f"grounded to {list(answer.predicted)}, probability {answer.probability:.3f}", markup=False)
    _print_table("what moved it, as log-odds", explain(model, solution), console)
    second = rivalry(model, solution)
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
