"""How well commands are grounded in scenes that are seen as a whole: train on episodes, ground others, count."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from dcg_torch.agent.command import Parse, Parser
from dcg_torch.evaluation.episodes import Episode, workspace
from dcg_torch.grounding.features import GROUNDING_OF
from dcg_torch.grounding.graph import Solution
from dcg_torch.learning.commit_first import labelled
from dcg_torch.lexical import LexicalModel
from dcg_torch.model import GroundingModel, TrainingSet, Variant
from dcg_torch.relational import coordinated
from dcg_torch.report.intervals import wilson
from dcg_torch.supervised import Lesson, teach
from dcg_torch.types import Child, Example, Grounding, GroundingKind, PhraseKind, WorldModel

CAUSES = ("no phrase", "wrong noun", "wrong colour", "wrong relation")
_GENERATED = 0.03
"""Weight of a generated lesson against one of people's."""
_LEARNING_STEPS = 10  # L-BFGS iterations after a command: the optimum moves little, and is followed


@dataclass(frozen=True, slots=True)
class Seconds:
    """Wall-clock seconds that a command took to be read, grounded and learned from."""

    parse: float
    ground: float
    learn: float = 0.0


@dataclass(frozen=True)
class Answer:
    """What came of one test episode.

    Attributes:
        kind: was the noun known to the robot when it heard it, unknown, or learned from an earlier command?
        form: does the command describe the object by more than its noun and colour?
        shared: how many objects have the type and colour of the one meant.
    """

    episode: Episode
    parse: Parse
    solution: Solution | None
    kind: str
    form: str
    shared: int
    seconds: Seconds

    @property
    def probability(self) -> float | None:
        """Of the object grounded to, the likeliest if there are several."""
        return None if self.solution is None else self.solution.probability

    @property
    def predicted(self) -> tuple[str, ...]:
        """Ids of the objects grounded to."""
        return () if self.solution is None else tuple(o.id for o in self.solution.objects)

    @property
    def correct(self) -> bool:
        """Is the predicted set the target set?"""
        return set(self.predicted) == set(self.episode.target)

    @property
    def cause(self) -> str | None:
        """What kind of error it is: one of `CAUSES`; None if it is none."""
        if self.correct:
            return None
        if not self.predicted:
            return CAUSES[0]
        objects = {o.id: o for o in self.episode.objects}
        got, meant = ([objects[i] for i in ids] for ids in (self.predicted, self.episode.target))
        if {o.type for o in got} != {o.type for o in meant}:
            return CAUSES[1]
        return CAUSES[2] if {o.color for o in got} != {o.color for o in meant} else CAUSES[3]

    def record(self) -> dict[str, Any]:
        """Its line of `predictions.jsonl`."""
        return {
            "id": self.episode.id,
            "predicted": list(self.predicted),
            "probability": self.probability,
            "noun": self.parse.noun,
            "color": self.parse.color,
            "target": list(self.episode.target),
            "correct": self.correct,
            "kind": self.kind,
            "cause": self.cause,
            "problem": self.parse.problem,
        }


class Evaluation:
    """A model trained on episodes.

    Args:
        train: the episodes to learn from.
        initial: the initial training set.
        parse: reads commands.
        known_types: leave out the training episodes about other types; None keeps all.
        known_colors: leave out the training episodes about objects of other colours; None keeps all.
        generated: lessons that come first, and weigh little: what words for relations mean until people say otherwise.
        rounds: of expectation-maximisation over the landmarks.
        progress: called as each round ends.
    """

    def __init__(
        self,
        train: Sequence[Episode],
        initial: TrainingSet,
        variant: Variant,
        parse: Parser,
        *,
        known_types: Collection[str] | None = None,
        known_colors: Collection[str] | None = None,
        generated: Sequence[Lesson] = (),
        rounds: int = 4,
        progress: Callable[[int], None] | None = None,
    ) -> None:
        began = time.perf_counter()
        kept = [e for e in train if known_types is None or _types_meant(e) <= set(known_types)]
        kept = [e for e in kept if known_colors is None or _colors_meant(e) <= set(known_colors)]
        self.parse = parse
        kind = GroundingModel if variant.synonyms is None else LexicalModel
        self.model = kind.trained(initial, variant)
        self.model.workspace = workspace(train)
        self._meant = frozenset(t for e in kept for t in _types_meant(e))
        read = [(e, reading) for e in kept if (reading := parse(e.text, ())).tree is not None]
        if isinstance(self.model, LexicalModel):
            nouns = _counted((reading.noun, _types_meant(e)) for e, reading in read)
            colors = _counted((reading.color, _colors_meant(e)) for e, reading in read)
            self.model.taught(sorted(self._meant), nouns, colors)
        if generated:
            teach(self.model, [replace(lesson, weight=_GENERATED) for lesson in generated], rounds=2)
        lessons = [Lesson(r.tree, self.world(e), frozenset(e.target)) for e, r in read if r.tree is not None]
        self.model.corpus += [example for lesson in lessons for example in _acted(self.model, lesson)]
        teach(
            self.model,
            lessons,
            known_types=known_types,
            known_colors=known_colors,
            rounds=rounds,
            progress=progress,
        )
        self._first_words = frozenset(self.model.symbols)
        self.train_seconds = time.perf_counter() - began

    @property
    def learned(self) -> dict[str, dict[str, str]]:
        """The words learned since the training: nouns with their types, words for colours with what they name."""
        nouns = {w: s.type for w, s in self.model.symbols.items() if w not in self._first_words}
        colors = dict(self.model.words.color_words) if isinstance(self.model, LexicalModel) else {}
        return {"nouns": nouns, "colors": colors}

    def world(self, episode: Episode) -> WorldModel:
        """Upsilon of an episode: everything is perceived, and there are places to speak of."""
        pose, speaker = episode.pose, episode.speaker_pose
        world = self.model.world_model(episode.percepts(), pose, speaker)
        known = self._meant | set(self.model.known_types)
        objects = tuple(replace(o, known=o.type in known) for o in world.objects)
        return replace(world, objects=objects)

    def answers(self, test: Sequence[Episode], *, learn: bool = False) -> Iterator[Answer]:
        """Ground the test episodes in order.

        Args:
            learn: learn after each from what it was grounded to; the target is never looked at.
        """
        for episode in test:
            began = time.perf_counter()
            reading = self.parse(episode.text, self.model.symbols.keys())
            read = time.perf_counter()
            noun, solution = reading.noun, None
            kind = "known" if noun in self._first_words else "learned" if noun in self.model.symbols else "unknown"
            form = "plain"
            if reading.tree is not None:
                solution = self.model.ground(reading.tree, self.world(episode))
                form = "relation" if any(h.tree.children for h in _nouns(solution)) else "plain"
            grounded = time.perf_counter()
            if learn and solution is not None:
                self.model.learn(solution, max_steps=_LEARNING_STEPS)
            seconds = Seconds(read - began, grounded - read, time.perf_counter() - grounded)
            yield Answer(episode, reading, solution, kind, form, _shared(episode), seconds)


def _acted(model: GroundingModel, lesson: Lesson) -> list[Example]:
    """What a lesson about one object teaches of its verb and preposition: that they are about the object meant."""
    if len(lesson.targets) != 1 or len(coordinated(lesson.tree)) != 1:
        return []
    path, node = [], model.readable(lesson.tree)
    while node.phrase.kind is not PhraseKind.NOUN and node.children:
        path.append(node.phrase)
        node = node.children[0]
    meant = next(o for o in lesson.world.objects if o.id in lesson.targets)
    child, found = Child(Grounding(GroundingKind.OBJECT, meant)), []
    for phrase in reversed(path):
        above = Child(Grounding(GROUNDING_OF[phrase.kind], meant))
        found.append(labelled(phrase, above, (child,), lesson.world))
        child = above
    return found


def _counted(said: Iterable[tuple[str | None, Collection[str | None]]]) -> dict[str, Counter[str]]:
    """How often each word was said of each meaning, where only one was possible."""
    found: dict[str, Counter[str]] = {}
    for word, meant in said:
        one = next(iter(meant)) if len(meant) == 1 else None
        if word is not None and one is not None:
            found.setdefault(word, Counter())[one] += 1
    return found


def _nouns(solution: Solution) -> list[Any]:
    return [] if solution.best is None else [h for h in solution.best.walk() if h.tree.phrase is solution.noun]


def _types_meant(episode: Episode) -> set[str]:
    return {o.type for o in episode.objects if o.id in episode.target}


def _colors_meant(episode: Episode) -> set[str | None]:
    return {o.color for o in episode.objects if o.id in episode.target}


def _shared(episode: Episode) -> int:
    kinds = {(o.type, o.color) for o in episode.objects if o.id in episode.target}
    return sum((o.type, o.color) in kinds for o in episode.objects)


def summarise(answers: Sequence[Answer], train_seconds: float, *, by_color: bool = False) -> dict[str, Any]:
    """The figures of an evaluation: accuracy with its 95 % interval (Wilson), and by kinds of commands.

    A half is one of the whole file, in its order, also where it is that of a type.

    Args:
        by_color: also by the colour of the object meant.
    """
    half = len(answers) // 2
    halves = {id(a): k < half for k, a in enumerate(answers)}
    kinds = {kind: [a for a in answers if a.kind == kind] for kind in ("known", "unknown", "learned")}
    kinds |= {form: [a for a in answers if a.form == form] for form in ("plain", "relation")}
    kinds |= {"several share type and colour": [a for a in answers if a.shared > 1]}
    meant = {t: [a for a in answers if _types_meant(a.episode) == {t}] for t in _sorted(answers, _types_meant)}
    if by_color:
        colors = _sorted(answers, _colors_meant)
        meant |= {f"color {c}": [a for a in answers if _colors_meant(a.episode) == {c}] for c in colors}
    for name, of in {"": answers, **meant}.items():
        kinds |= {name: list(of)} if name else {}
        for which, first in (("first half", True), ("second half", False)):
            kinds[f"{name}, {which}" if name else which] = [a for a in of if halves[id(a)] is first]
    estimate = wilson(sum(a.correct for a in answers), len(answers))
    return {
        "n": len(answers),
        "accuracy": estimate.value,
        "ci95": [estimate.low, estimate.high],
        "no_answer": sum(not a.predicted for a in answers),
        "train_seconds": train_seconds,
        "seconds_per_command": sum(a.seconds.parse + a.seconds.ground for a in answers) / len(answers),
        "parse_ms": _milliseconds([a.seconds.parse for a in answers]),
        "ground_ms": _milliseconds([a.seconds.ground for a in answers]),
        "learn_ms": _milliseconds([a.seconds.learn for a in answers]),
        "calibration_error": calibration_error(answers),
        "errors": {cause: sum(a.cause == cause for a in answers) for cause in CAUSES},
        "by_kind": {
            kind: {"n": len(of), "accuracy": sum(a.correct for a in of) / len(of)} for kind, of in kinds.items() if of
        },
    }


def calibration_error(answers: Sequence[Answer], bins: int = 10) -> float:
    """How far the answers' probability is from the share that is right: the expected calibration error.

    The answers fall into equal bins of probability; in each, the mean probability is compared with the accuracy
    (Guo et al. 2017, "On calibration of modern neural networks", eq. 3). No answer counts as one of probability 0.
    """
    probability = np.array([a.probability or 0.0 for a in answers])
    correct = np.array([a.correct for a in answers], dtype=np.float64)
    which = np.minimum((probability * bins).astype(np.int64), bins - 1)
    apart = np.bincount(which, weights=probability - correct, minlength=bins)
    return float(np.abs(apart).sum() / len(answers))


def _milliseconds(seconds: Sequence[float]) -> dict[str, float]:
    median, high = np.percentile(1e3 * np.array(seconds), (50, 95))
    return {"median": float(median), "p95": float(high)}


def _sorted(answers: Sequence[Answer], values: Callable[[Episode], Collection[str | None]]) -> list[str]:
    return sorted({v for a in answers for v in values(a.episode) if v is not None})
