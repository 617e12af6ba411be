"""Learning from commands whose objects are known: the landmarks that they speak of are not, and are inferred.

Expectation-maximisation over the landmarks. A lesson says which object a command means, not which cube "next to the
cube" speaks of. So, in turn: with the present model, p(landmark) for every modifier and p(landmark | object meant)
(`hypotheses.ModifierFactor`); then one fit of the weights to all choices, of the objects and of their landmarks
(`grounding.choices`). The first turn knows no relations and spreads over all landmarks that the words allow.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from dcg_torch.grounding.choices import Choice, Modified
from dcg_torch.grounding.encoders import Encoders
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.features import GROUNDING_OF, FeatureSet, ranking
from dcg_torch.grounding.hypotheses import Combos, ModifierFactor
from dcg_torch.grounding.readings import Reading
from dcg_torch.grounding.solution import Solution, target_of
from dcg_torch.interpretation.factor_tree import (
    coordinated,
    speaks_of,
    to_factor_tree,
)
from dcg_torch.interpretation.plain_words import in_group
from dcg_torch.learning.evidence import Ground, told_by_look
from dcg_torch.learning.labelling import labelled
from dcg_torch.learning.learner import Taught
from dcg_torch.scene.workspace import with_all
from dcg_torch.types import (
    NOT,
    Child,
    Correspondence,
    Example,
    Grounding,
    GroundingKind,
    ParseTree,
    PhraseKind,
    WorldModel,
)
from dcg_torch.types.arrays import Bools, Floats

_NEGLIGIBLE = 0.02
"""Landmarks so much less probable than the best teach nothing."""
_NEGLIGIBLE_CHANCE = 1e-3
"""Objects so much less probable than the best teach nothing."""


@dataclass(frozen=True)
class Lesson:
    """A command and the ids of the objects it means; `weight` scales its likelihood.

    `readings` are all that may be meant, the one of `tree` first; none where there is no doubt.
    """

    tree: ParseTree
    world: WorldModel
    targets: frozenset[str]
    weight: float = 1.0
    readings: tuple[Reading, ...] = ()


@dataclass(frozen=True)
class Part:
    """One noun phrase that a lesson is about; `alone` if the lesson joins no others to it."""

    noun: ParseTree
    world: WorldModel
    targets: frozenset[str]
    weight: float
    alone: bool


def fit_landmarks_em(
    parts: Sequence[Part],
    encoders: Encoders,
    ground_now: Callable[[], Ground],
    fit: Callable[[list[Choice], bool], None],
    *,
    rounds: int,
    progress: Callable[[int], None] | None = None,
) -> None:
    """Expect the landmarks and maximise the likelihood, in turn.

    Args:
        encoders: of worlds; only weights change meanwhile, so what a world looks like is encoded once.
        ground_now: gives what grounds with the present weights.
        fit: fits them to choices; told whether it is the last round, before which they are only on their way.
        rounds: of expectation and maximisation.
        progress: called with the number of each round that is done.
    """
    encoded = [(part, encoders.of(part.world)) for part in parts]
    for number in range(rounds):
        ground = ground_now()
        fit([choice for part, encoder in encoded for choice in _expected(part, encoder, ground)], number == rounds - 1)
        if progress is not None:
            progress(number)


def parts_of(lesson: Lesson) -> list[Part]:
    """The noun phrases that a lesson joins, each in the world with the groups that it may speak of.

    Without hypothetical objects: what a lesson means is there, and it says nothing of what is not.
    """
    found = []
    seen = replace(lesson.world, objects=tuple(o for o in lesson.world.objects if not o.hypothetical))
    trees = coordinated(lesson.tree)
    for tree in trees:
        noun = target_of(to_factor_tree(tree, lesson.world))
        if noun is not None:
            world = with_all(seen, speaks_of(noun))
            found.append(Part(noun, world, lesson.targets, lesson.weight, len(trees) == 1))
    return found


def said_of_words(
    parts: Sequence[Part], known_types: Collection[str] | None, known_colors: Collection[str] | None
) -> Taught:
    """How often each noun and each word for a colour was said of what, where only one was possible, and of what not.

    Args:
        known_types: types that may become known; None: all that are meant.
        known_colors: the same of colours; a word for a colour that no lesson says of such an object is not known.
    """
    nouns: dict[str, Counter[str]] = {}
    passed: dict[str, Counter[str]] = {}
    words: dict[str, Counter[str]] = {}
    types: dict[str, None] = {}
    colors: dict[str, None] = {}
    for part in parts:
        meant = [o for o in part.world.objects if o.id in part.targets]
        of_type = {o.type for o in meant if o.type is not None and (known_types is None or o.type in known_types)}
        of_color = {o.color for o in meant if o.color is not None and (known_colors is None or o.color in known_colors)}
        types |= dict.fromkeys(sorted(of_type))
        colors |= dict.fromkeys(sorted(of_color))
        if part.noun.phrase.noun is not None and part.alone and len(of_type) == 1:
            nouns.setdefault(part.noun.phrase.noun, Counter()).update(of_type)
            there = {o.type for o in part.world.objects if o.type is not None}
            passed.setdefault(part.noun.phrase.noun, Counter()).update(there - of_type)
        word = part.noun.phrase.color
        if word is not None and len(of_color) == 1 and not told_by_look(word, part.world.objects):
            words.setdefault(word, Counter()).update(of_color)
    return Taught(tuple(types), tuple(colors), nouns, words, passed)


def path_examples(lessons: Iterable[Lesson]) -> list[Example]:
    """What lessons about one object teach of their verb and preposition: that they are about the object meant."""
    found = []
    for lesson in lessons:
        if len(lesson.targets) != 1 or len(coordinated(lesson.tree)) != 1:
            continue
        path, node = [], to_factor_tree(lesson.tree, lesson.world)
        while node.phrase.kind is not PhraseKind.NOUN and node.children:
            path.append(node.phrase)
            node = node.children[0]
        meant = next(o for o in lesson.world.objects if o.id in lesson.targets)
        child = Child(Grounding(GroundingKind.OBJECT, meant))
        for phrase in reversed(path):
            above = Child(Grounding(GROUNDING_OF[phrase.kind], meant))
            found.append(replace(labelled(phrase, above, (child,), lesson.world), weight=lesson.weight))
            child = above
    return found


def example_choices(examples: Iterable[Example], features: FeatureSet) -> list[Choice]:
    """Hand-made examples of noun phrases as choices: each thing that may be meant has an equal share."""
    found = []
    for example in examples:
        label = np.array([c == Correspondence.ACTIVE for c in example.correspondences], dtype=np.float64)
        bag = WorldEncoder(features, example.world).bag(example)
        found.append(Choice(example.phrase, bag, label / label.sum(), example.weight))
    return found


def _expected(part: Part, encoder: WorldEncoder, ground: Ground) -> Iterator[Choice]:
    """What a noun phrase and the phrases of its landmarks choose, as far as a lesson and the present model say."""
    solution = ground(part.noun, part.world)
    if solution.best is None:
        return
    meant = _meant(part, solution)
    if meant is None:
        return
    n = len(part.world.meanable)
    share = np.zeros(n)
    share[meant] = np.array([solution.probabilities[part.world.things[j].id] for j in meant])
    of_one = part.alone or part.noun.phrase.plural
    chance = np.array([solution.probabilities[o.id] for o in part.world.meanable])
    kept = chance >= _NEGLIGIBLE_CHANCE * chance.max()
    kept[meant] = True
    label = np.zeros(n)
    label[meant] = 1.0 if of_one else share[meant] / max(share.sum(), 1e-300)
    a_set = len(meant) > 1 and part.alone and part.noun.phrase.count is None
    yield Choice(
        part.noun.phrase,
        encoder.ranked(part.noun.phrase, solution.compared)[:n][kept],
        label[kept] if a_set else label[kept] / label[kept].sum(),
        part.weight,
        tuple(_modified(modifier, encoder, kept) for modifier in solution.modifiers),
        a_set,
    )
    for modifier in solution.modifiers:
        rests = modifier.posterior[:, meant].mean(axis=1)
        yield from _landmarks(modifier.combos, rests, encoder, part.weight)


def _meant(part: Part, solution: Solution) -> list[int] | None:
    """Numbers of the things that a noun phrase means; None where a group is meant that is not seen as one."""
    things = part.world.things
    if in_group(part.noun.phrase):
        return [j for j, o in enumerate(things) if o.members and part.targets == set(o.members)][:1] or None
    return [j for j, o in enumerate(part.world.objects) if o.id in part.targets] or None


def _modified(modifier: ModifierFactor, encoder: WorldEncoder, kept: Bools) -> Modified:
    """A modifier's factors to the landmarks that are not too improbable."""
    prior = modifier.log_prior
    combos = np.flatnonzero(prior >= prior.max() + math.log(_NEGLIGIBLE))
    most = 1 if modifier.of_each else None
    landmarks = [modifier.combos.things[c][:most] for c in combos.tolist()]
    phrase = modifier.tree.phrase
    bag = encoder.placed(landmarks, ranking(phrase), modifier.compared)[:, : len(kept)][:, kept]
    return Modified(phrase, bag, prior[combos], NOT in phrase.words)


def _landmarks(combos: Combos, rests: Floats, encoder: WorldEncoder, weight: float) -> Iterator[Choice]:
    """What the phrases for the landmarks of a modifier choose, which rests on each tuple of them by so much."""
    things = np.array(combos.things, dtype=np.int64)
    for k, beam in enumerate(combos.beams if len(combos) else ()):
        share = np.zeros(len(encoder.world.things))
        np.add.at(share, things[:, k], rests)
        phrase = beam.tree.phrase
        yield Choice(phrase, encoder.ranked(phrase), share / share.sum(), weight)
