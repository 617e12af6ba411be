"""Learning by the number of words that are known: `python -m dcg_torch.bench.learning [--words N ...] [--life N]`.

A model is given words without being taught: as many as are asked for, each with a type of its own, either told by a
teacher or heard three times among random others. What is timed is `learn` after a command about one of eight objects:
the posterior, the soft labels, and the fit to a gradient of 1e-7.

A life is one robot that hears many commands in many worlds: what one of them costs must not grow with their number.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import torch

from dcg_torch.bench.result import Result, cpu_milliseconds, result
from dcg_torch.experiment.plan import trial_commands
from dcg_torch.experiment.trial import run_trial
from dcg_torch.language import default_parser
from dcg_torch.learning.beliefs import Beliefs, Evidence
from dcg_torch.learning.learner import Experience
from dcg_torch.learning.word_posterior import WordPosterior
from dcg_torch.lessons.curriculum import generated_lessons
from dcg_torch.model import GroundingModel
from dcg_torch.model.pretrain import pretrained
from dcg_torch.settings import Settings, Speaker
from dcg_torch.simulator import FakeRobot
from dcg_torch.types import ParseTree, Percept, Phrase, PhraseKind, Pose

_GOALS = {100: 10.0, 1_000: 60.0}
_WINDOW, _WINDOWS = 100, 10
"""Commands of a life whose times are taken together, at the least, and points of its curve, at the most."""


def knowing(count: int, rng: np.random.Generator, *, told: bool) -> GroundingModel:
    """The shipped model with so many further words, each for a type of its own."""
    model = pretrained(opaque=True)
    learner = model.learner
    assert isinstance(learner, WordPosterior)
    types = [f"type {k}" for k in range(count)]
    nouns = learner.nouns.meet(types)
    names = {f"word{k}": types[k] for k in range(count)}
    nouns = replace(nouns, settled={**nouns.settled, **names}) if told else _heard(nouns, names, rng)
    model.learner = replace(learner, nouns=nouns)
    model.train()
    return model


def _heard(nouns: Beliefs, names: dict[str, str], rng: np.random.Generator) -> Beliefs:
    types = list(names.values())
    for word, type_ in names.items():
        for k in range(3):
            seen = [type_, *(types[j] for j in rng.integers(0, len(types), 7))]
            nouns = nouns.weigh(Evidence(word, dict.fromkeys(seen, 1.0), 0.05, f"{k}"))
    return nouns


def bench_learn(counts: Sequence[int] = (10, 100, 300, 1_000), repeats: int = 7) -> Iterator[Result]:
    """`learn` by the number of words, told and heard."""
    for told in (True, False):
        kind = "told by a teacher" if told else "heard"
        for count in counts:
            rng = np.random.default_rng(count)
            model = knowing(count, rng, told=told)
            times = [_learn(model, count, rng, f"new{k % 3}" if told else None) for k in range(repeats + 2)][2:]
            goal = _GOALS.get(count) if told else None
            curve = f"Learning, ms by words known: {kind}"
            yield result(f"learn with {count:,} words {kind}", times, "ms CPU", goal, curve=curve, at=count)


def _learn(model: GroundingModel, count: int, rng: np.random.Generator, noun: str | None) -> float:
    kinds, places = rng.choice(count, 8, replace=False).tolist(), rng.uniform(-5.0, 5.0, (8, 2)).tolist()
    percepts = [
        Percept(f"{k}", f"type {kind}", ("red", "green", "blue")[k % 3], (x, y, 0.0))
        for k, (kind, (x, y)) in enumerate(zip(kinds, places, strict=True))
    ]
    noun = noun or f"word{kinds[0]}"
    said = ParseTree(Phrase(PhraseKind.NOUN, noun, noun=noun))
    near = ParseTree(Phrase(PhraseKind.PREPOSITION, "to", ("to",)), (said,))
    tree = ParseTree(Phrase(PhraseKind.VERB, "go", ("go",)), (near,))
    solution = model.ground(tree, model.world_model(percepts, Pose(0.0, 0.0), looked=True))
    return cpu_milliseconds(model.learn, solution, Experience(looked=True))


def bench_life(commands: int = 600) -> Iterator[Result]:
    """One robot hears many commands about 40 types in 10 colours: what a command costs as time goes on."""
    settings = Settings(
        iterations=commands,
        worlds="generated",
        worlds_per_trial=max(10, commands // 6),
        types=40,
        colors=10,
        object_rate=0.02,
        speaker=Speaker.canonical,
    )
    model = pretrained(opaque=True)
    rows = run_trial(
        0, trial_commands(settings, 0), model, default_parser().parse, FakeRobot(), np.random.default_rng(0)
    )
    window = max(_WINDOW, -(-commands // _WINDOWS))
    for start in range(0, commands, window):
        times = [cpu_milliseconds(next, rows) for _ in range(min(window, commands - start))]
        end = start + len(times)
        curve = "A long life, ms a command by commands lived: parse, ground, learn"
        yield result(f"a command, {start + 1:,} to {end:,} of a life", times, "ms CPU", curve=curve, at=end)


def bench_teaching(lessons: int = 300) -> Iterator[Result]:
    """Teaching relations by generated lessons, as the shipped model was."""
    parse = default_parser().parse
    made = generated_lessons(parse, lessons)
    model = pretrained()

    def teach() -> None:
        model.copy().teach(made, relations_only=True, rounds=3)

    yield result(f"teaching {lessons} generated lessons", [cpu_milliseconds(teach)], "ms CPU")


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the results as they come; returns the exit status."""
    parser = argparse.ArgumentParser(prog="python -m dcg_torch.bench.learning", description="Time the learning.")
    parser.add_argument("--words", type=int, nargs="*", default=[10, 100, 300, 1_000], help="how many are known")
    parser.add_argument("--life", type=int, default=600, help="commands that one robot hears; 0: none")
    torch.set_num_threads(1)
    asked = parser.parse_args(arguments)
    for found in itertools.chain(bench_learn(asked.words), bench_life(asked.life)):
        print(f"{found.name:62} {found.median:10.4g} {found.unit}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
