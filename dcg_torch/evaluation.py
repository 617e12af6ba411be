"""How well commands are grounded in scenes that are seen as a whole: train on episodes, ground others, count."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from dcg_torch import space
from dcg_torch.episodes import Episode, scene_bounds, workspace
from dcg_torch.graph import Solution
from dcg_torch.lexical import LexicalModel
from dcg_torch.model import GroundingModel, TrainingSet, Variant
from dcg_torch.report.intervals import wilson
from dcg_torch.supervised import Lesson, teach
from dcg_torch.symbols import WorldModel
from dcg_torch.trial.command import Parse, Parser

CAUSES = ("no phrase", "wrong noun", "wrong colour", "wrong relation")
_LEARNING_STEPS = 10  # L-BFGS iterations after a command: the optimum moves little, and is followed


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
    seconds: float

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
            "probability": None if self.solution is None else self.solution.probability,
            "noun": self.parse.noun,
            "color": self.parse.color,
            "target": list(self.episode.target),
            "correct": self.correct,
            "kind": self.kind,
            "cause": self.cause,
            "problem": self.parse.problem,
        }


class Evaluation:
    """A model trained on episodes, and the workspace that they share.

    Args:
        train: the episodes to learn from.
        initial: the initial training set.
        parse: reads commands.
        known_types: leave out the training episodes about other types; None keeps all.
        known_colors: leave out the training episodes about objects of other colours; None keeps all.
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
        rounds: int = 4,
        progress: Callable[[int], None] | None = None,
    ) -> None:
        began = time.perf_counter()
        kept = [e for e in train if known_types is None or _types_meant(e) <= set(known_types)]
        kept = [e for e in kept if known_colors is None or _colors_meant(e) <= set(known_colors)]
        self.parse = parse
        self._bounds = workspace(train)
        kind = GroundingModel if variant.synonyms is None else LexicalModel
        self.model = kind.trained(initial, variant)
        self._meant = frozenset(t for e in kept for t in _types_meant(e))
        lessons, said = [], (dict[str, Counter[str]](), dict[str, Counter[str]]())
        for episode in kept:
            reading = parse(episode.text, ())
            if reading.tree is not None:
                lessons.append(Lesson(reading.tree, self.world(episode), frozenset(episode.target)))
                words, meant = (reading.noun, reading.color), (_types_meant(episode), _colors_meant(episode))
                for word, values, counts in zip(words, meant, said, strict=True):
                    if word is not None and len(values) == 1:
                        counts.setdefault(word, Counter()).update(values - {None})
        if isinstance(self.model, LexicalModel):
            self.model.taught(sorted(self._meant), *said)
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

    def world(self, episode: Episode) -> WorldModel:
        """Upsilon of an episode: everything is perceived, and there are places to speak of."""
        pose, speaker = episode.pose, episode.speaker_pose
        bounds = self._bounds or scene_bounds([o.position for o in episode.objects], pose)
        world = self.model.world_model(episode.percepts(), pose, speaker)
        known = self._meant | set(self.model.known_types)
        objects = tuple(replace(o, known=o.type in known) for o in world.objects)
        return replace(world, objects=objects, places=space.places(bounds, pose, speaker))

    def answers(self, test: Sequence[Episode], *, learn: bool = False) -> Iterator[Answer]:
        """Ground the test episodes in order.

        Args:
            learn: learn after each from what it was grounded to; the target is never looked at.
        """
        for episode in test:
            began = time.perf_counter()
            reading = self.parse(episode.text, self.model.symbols.keys())
            noun, solution = reading.noun, None
            kind = "known" if noun in self._first_words else "learned" if noun in self.model.symbols else "unknown"
            form = "plain"
            if reading.tree is not None:
                solution = self.model.ground(reading.tree, self.world(episode))
                form = "relation" if any(h.tree.children for h in _nouns(solution)) else "plain"
            seconds = time.perf_counter() - began
            if learn and solution is not None:
                self.model.learn(solution, max_steps=_LEARNING_STEPS)
            yield Answer(episode, reading, solution, kind, form, _shared(episode), seconds)


def _nouns(solution: Solution) -> list[Any]:
    return [] if solution.best is None else [h for h in solution.best.walk() if h.tree.phrase is solution.noun]


def _types_meant(episode: Episode) -> set[str]:
    return {o.type for o in episode.objects if o.id in episode.target}


def _colors_meant(episode: Episode) -> set[str | None]:
    return {o.color for o in episode.objects if o.id in episode.target}


def _shared(episode: Episode) -> int:
    kinds = {(o.type, o.color) for o in episode.objects if o.id in episode.target}
    return sum((o.type, o.color) in kinds for o in episode.objects)


def summarise(answers: Sequence[Answer], train_seconds: float) -> dict[str, Any]:
    """The figures of an evaluation: accuracy with its 95 % interval (Wilson), and by kinds of commands."""

    def share(of: Sequence[Answer]) -> dict[str, Any]:
        return {"n": len(of), "accuracy": sum(a.correct for a in of) / len(of) if of else None}

    half = len(answers) // 2
    kinds = {kind: [a for a in answers if a.kind == kind] for kind in ("known", "unknown", "learned")}
    kinds |= {form: [a for a in answers if a.form == form] for form in ("plain", "relation")}
    kinds |= {"several share type and colour": [a for a in answers if a.shared > 1]}
    kinds |= {"first half": list(answers[:half]), "second half": list(answers[half:])}
    types = sorted({t for a in answers for t in _types_meant(a.episode)})
    for t in types:
        of_type = [a for a in answers if _types_meant(a.episode) == {t}]
        kinds |= {t: of_type, f"{t}, first half": of_type[: len(of_type) // 2]}
        kinds |= {f"{t}, second half": of_type[len(of_type) // 2 :]}
    estimate = wilson(sum(a.correct for a in answers), len(answers))
    return {
        "n": len(answers),
        "accuracy": estimate.value,
        "ci95": [estimate.low, estimate.high],
        "no_answer": sum(not a.predicted for a in answers),
        "train_seconds": train_seconds,
        "seconds_per_command": sum(a.seconds for a in answers) / len(answers),
        "by_kind": {kind: share(of) for kind, of in kinds.items() if of},
    }
