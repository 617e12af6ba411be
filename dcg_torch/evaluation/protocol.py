"""How well commands are grounded in scenes that are seen as a whole: train on episodes, ground others, count."""

from __future__ import annotations

import gc
import math
import time
from collections import Counter
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from dcg_torch.evaluation.episodes import Episode, of_scene, workspace
from dcg_torch.grounding.readings import worth_grounding
from dcg_torch.grounding.solution import Solution
from dcg_torch.interpretation.marks import heard
from dcg_torch.interpretation.parser_protocol import CommandParser, ParsedCommand
from dcg_torch.learning.landmarks import Lesson
from dcg_torch.model import GroundingModel
from dcg_torch.scene.workspace import Workspace
from dcg_torch.types import WorldModel

_FULL_WEIGHT = 300
"""Episodes of one of several corpora that count in full: of more, each counts for less: it is to drown no small one."""
_FULL_SCENE = 8
"""Commands in one scene that count in full: a scene described a hundred times tells of itself, not of words."""
CAUSES = ("no phrase", "wrong noun", "wrong colour", "wrong relation")


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
        file: the stem of the file it is from.
        kind: was the noun known to the robot when it heard it, unknown, or learned from an earlier command?
        form: does the command describe the object by more than its noun and colour?
        shared: how many objects have the type and colour of the one meant.
    """

    file: str
    episode: Episode
    parse: ParsedCommand
    solution: Solution | None
    kind: str
    form: str
    shared: int
    seconds: Seconds

    @property
    def probability(self) -> float | None:
        """The probability of the object grounded to, of the likeliest if there are several."""
        return None if self.solution is None else self.solution.probability

    @property
    def predicted(self) -> tuple[str, ...]:
        """Ids of the objects grounded to; none where what is meant is not there."""
        return () if self.solution is None else tuple(o.id for o in self.solution.objects if not o.hypothetical)

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
        """The answer's line of `predictions.jsonl`."""
        return {
            "id": self.episode.id,
            "file": self.file,
            "predicted": list(self.predicted),
            "probability": self.probability,
            "noun": self.parse.noun,
            "color": self.parse.color,
            "target": list(self.episode.target),
            "correct": self.correct,
            "kind": self.kind,
            "cause": self.cause,
            "problem": self.parse.problem if self.solution is None else None,
            "refused": getattr(self.parse, "refused", None) if self.solution is None else None,
            "unread": list(getattr(self.parse, "unread", ())),
        }


@dataclass(frozen=True)
class Training:
    """What a model is taught from episodes.

    Attributes:
        known_types: leave out the episodes about other types; None keeps all.
        known_colors: leave out the episodes about objects of other colours; None keeps all.
        rounds: of expectation-maximisation over the landmarks.
    """

    known_types: Collection[str] | None = None
    known_colors: Collection[str] | None = None
    rounds: int = 4

    def kept(self, episodes: Iterable[Episode]) -> list[Episode]:
        """The episodes that are not left out."""
        found = [e for e in episodes if self.known_types is None or types_meant(e) <= set(self.known_types)]
        return [e for e in found if self.known_colors is None or colors_meant(e) <= set(self.known_colors)]


def train(
    model: GroundingModel,
    corpora: Sequence[Sequence[Episode]],
    parse: CommandParser,
    training: Training,
    progress: Callable[[int], None] | None = None,
) -> float:
    """Teach a model, in place, the episodes of several corpora, each with a workspace of its own.

    Args:
        parse: reads commands.
        progress: called as each round ends.

    Returns:
        The seconds that it took.
    """
    began = time.perf_counter()
    lessons: list[Lesson] = []
    for corpus in corpora:
        where, kept = workspace(corpus), training.kept(corpus)
        weight = 1.0 if len(corpora) == 1 else min(1.0, math.sqrt(_FULL_WEIGHT / max(1, len(kept))))
        scenes = [_scene(episode) for episode in kept]
        times = Counter(scenes)
        for episode, scene, world in zip(kept, scenes, _worlds(model, kept, where), strict=True):
            read = heard(parse, episode.text, (), world.objects)
            if read.readings and episode.target:
                readings = worth_grounding(read, world, model.learner.readings)
                counts = weight * min(1.0, math.sqrt(_FULL_SCENE / times[scene]))
                lesson = Lesson(readings[0].tree, world, frozenset(episode.target), counts, tuple(readings))
                lessons.append(lesson)
        gc.freeze()  # they stay until all is learned, and walking them again and again takes time
    model.teach(
        lessons,
        known_types=training.known_types,
        known_colors=training.known_colors,
        rounds=training.rounds,
        progress=progress,
    )
    return time.perf_counter() - began


def _scene(episode: Episode) -> Hashable:
    """What tells scenes apart: their group, or what stands where."""
    return episode.group or tuple((o.type, o.color, o.rgb, o.position) for o in episode.objects)


def test_world(model: GroundingModel, episode: Episode, where: Workspace) -> WorldModel:
    """Upsilon of an episode: all there is has been perceived, and there are places to speak of."""
    percepts = episode.percepts()
    scale = of_scene(percepts, episode.pose, where)
    return model.world_model(percepts, episode.pose, episode.speaker_pose, looked=True, workspace=scale)


def _worlds(model: GroundingModel, episodes: Iterable[Episode], where: Workspace) -> Iterator[WorldModel]:
    """The `test_world` of each episode, as the model knows things by then: of some in a row in one scene it is one."""
    last: tuple[object, ...] | None = None
    world = WorldModel(())
    for episode in episodes:
        seen = episode.robot, episode.speaker, episode.holding, model.known_types, episode.objects
        if seen != last:
            last, world = seen, test_world(model, episode, where)
        yield world


def answers(
    model: GroundingModel, test: Sequence[Episode], parse: CommandParser, *, file: str = "", learn: bool = False
) -> Iterator[Answer]:
    """Ground the test episodes in order.

    Args:
        file: its stem.
        learn: learn after each from what it was grounded to; the target is never looked at.
    """
    first_words, where = frozenset(model.symbols), workspace(test)
    for episode, world in zip(test, _worlds(model, test, where), strict=True):
        began = time.perf_counter()
        words = model.symbols
        reading = heard(parse, episode.text, words.keys(), world.objects)
        read = time.perf_counter()
        noun = reading.noun
        kind = "known" if noun in first_words else "learned" if noun in words else "unknown"
        found = model.ground(reading, world)
        solution = None if found.problem is not None else found
        grounded = time.perf_counter()
        if learn and solution is not None:
            model.learn(solution)
        seconds = Seconds(read - began, grounded - read, time.perf_counter() - grounded)
        form = "relation" if solution is not None and solution.modifiers else "plain"
        yield Answer(file, episode, reading, solution, kind, form, _shared(episode), seconds)


def types_meant(episode: Episode) -> set[str]:
    """The types of the objects meant."""
    return {o.type for o in episode.objects if o.id in episode.target}


def colors_meant(episode: Episode) -> set[str | None]:
    """The colours of the objects meant."""
    return {o.color for o in episode.objects if o.id in episode.target}


def _shared(episode: Episode) -> int:
    kinds = {(o.type, o.color) for o in episode.objects if o.id in episode.target}
    return sum((o.type, o.color) in kinds for o in episode.objects)
