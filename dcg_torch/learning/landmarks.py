"""Learning from commands whose objects are known: the landmarks that they speak of are not, and are inferred.

Expectation-maximisation over the landmarks. A lesson says which object a command means, not which cube "next to the
cube" speaks of. So, in turn: with the present model, p(landmark | object meant) for every modifier
(`solution.ModifierFactor`); then examples weighted by it, and one fit of the log-linear factor on all of them. The
first turn knows no relations and spreads over all landmarks that the words allow.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dcg_torch.grounding.encode import Rows, WorldEncoder
from dcg_torch.grounding.factor_tree import coordinated, speaks_of_groups, to_factor_tree
from dcg_torch.grounding.features import GROUNDING_OF, FeatureSet, ranking
from dcg_torch.grounding.plain_words import in_group
from dcg_torch.grounding.solution import Hypothesis, ModifierFactor, Solution, target_of
from dcg_torch.learning.labelling import labelled
from dcg_torch.learning.learner import Taught
from dcg_torch.scene.workspace import with_groups
from dcg_torch.types import (
    NOT,
    Child,
    Correspondence,
    Example,
    Grounding,
    GroundingKind,
    Object,
    ParseTree,
    Phrase,
    PhraseKind,
    WorldModel,
)

Bools = NDArray[np.bool_]
GroundEncoded = Callable[[ParseTree, WorldModel, WorldEncoder], Solution]
"""Grounds a tree of factors in a world whose encoder is given."""

_NEGLIGIBLE = 0.02
"""Landmarks less probable than this teach nothing."""
_FAR_NEGATIVE = 0.1
"""Weight of the objects that the noun phrase may rule out by itself, as negative examples of its modifiers."""


@dataclass(frozen=True)
class Lesson:
    """A command and the ids of the objects it means; `weight` scales its likelihood."""

    tree: ParseTree
    world: WorldModel
    targets: frozenset[str]
    weight: float = 1.0


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
    features: FeatureSet,
    ground: GroundEncoded,
    fit: Callable[[list[Rows], bool], None],
    *,
    rounds: int,
    progress: Callable[[int], None] | None = None,
) -> None:
    """Expect the landmarks and maximise the likelihood, in turn.

    Args:
        features: the columns; only weights change meanwhile, so what a world looks like is encoded once.
        ground: grounds with the present weights.
        fit: fits them to labelled factors; told whether it is the last round, before which they are only on their way.
        rounds: of expectation and maximisation.
        progress: called with the number of each round that is done.
    """
    encoders: dict[WorldModel, WorldEncoder] = {}
    encoded = [(part, encoders.setdefault(part.world, WorldEncoder(features, part.world))) for part in parts]
    for number in range(rounds):
        fit([rows for part, encoder in encoded for rows in _expected(part, encoder, ground)], number == rounds - 1)
        if progress is not None:
            progress(number)


def parts_of(lesson: Lesson) -> list[Part]:
    """The noun phrases that a lesson joins, each in the world with the groups that it may speak of."""
    found = []
    trees = coordinated(lesson.tree)
    for tree in trees:
        noun = target_of(to_factor_tree(tree, lesson.world))
        if noun is not None:
            world = with_groups(lesson.world) if speaks_of_groups(tree) else lesson.world
            found.append(Part(noun, world, lesson.targets, lesson.weight, len(trees) == 1))
    return found


def said_of_words(
    parts: Sequence[Part], known_types: Collection[str] | None, known_colors: Collection[str] | None
) -> Taught:
    """How often each noun and each word for a colour was said of what, where only one was possible.

    Args:
        known_types: types that may become known; None: all that are meant.
        known_colors: the same of colours; a word for a colour that no lesson says of such an object is not known.
    """
    nouns: dict[str, Counter[str]] = {}
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
        if part.noun.phrase.color is not None and len(of_color) == 1:
            words.setdefault(part.noun.phrase.color, Counter()).update(of_color)
    return Taught(tuple(types), tuple(colors), nouns, words)


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


def _expected(part: Part, encoder: WorldEncoder, ground: GroundEncoded) -> Iterator[Rows]:
    """The labelled factors of a noun phrase, weighted by what the present model takes its landmarks to be."""
    world, noun = part.world, part.noun
    solution = ground(noun, world, encoder)
    targets = np.array([o.id in part.targets for o in world.meanable])
    for chance, meant in _choices(part, solution):
        share = chance * part.weight
        alike = _alike(noun.phrase, world.meanable, [world.things[k] for k in meant])
        label = np.zeros(len(targets), dtype=np.int64)
        label[meant] = Correspondence.ACTIVE
        # What the modifiers, or the other noun phrases, tell apart is no example.
        kept = ~((alike & bool(noun.children)) | (targets & (not part.alone)))
        kept[meant] = True
        bag = encoder.ranked(noun.phrase, solution.compared)[: len(targets)][kept]
        yield Rows(noun.phrase, bag, label[kept], np.full(len(bag), share))
        for modifier in solution.modifiers:
            yield from _placed(modifier, noun.phrase, encoder, share, meant, targets)


def _choices(part: Part, solution: Solution) -> list[tuple[float, list[int]]]:
    """What a noun phrase may mean of what the lesson means, with weights: numbers of things.

    A phrase for a group means the group whose members are meant. Of several joined phrases, each means one of the
    targets: which, the present model says.
    """
    things = part.world.things
    if in_group(part.noun.phrase):
        groups = [j for j, o in enumerate(things) if o.members and part.targets == set(o.members)]
        if groups:
            return [(1.0, groups)]
    meant = [j for j, o in enumerate(part.world.objects) if o.id in part.targets]
    if part.alone or part.noun.phrase.plural:
        return [(1.0, meant)]
    shares = [solution.probabilities[things[j].id] for j in meant]
    return [(s / sum(shares), [j]) for s, j in zip(shares, meant, strict=True) if s > _NEGLIGIBLE * sum(shares)]


def _placed(
    modifier: ModifierFactor, head: Phrase, encoder: WorldEncoder, share: float, meant: Sequence[int], spared: Bools
) -> Iterator[Rows]:
    """What a modifier and its landmarks teach: the things meant stand so, others that the head allows do not.

    Of both, the landmarks are those that the present model takes them to rest on. So what speaks most for a wrong
    thing is what is learned to speak against it.
    """
    world, phrase = encoder.world, modifier.tree.phrase
    n = len(spared)
    posterior = modifier.posterior[:, :n]
    told_apart = not head.words  # "the second cube in the row": the others are in it too
    near = _alike(head, world.meanable, [world.things[k] for k in meant]) & told_apart
    weight = posterior * np.where(near, 1.0, _FAR_NEGATIVE) * ~spared
    weight[:, meant] = posterior[:, meant] / len(meant)
    stands, differs = Correspondence.ACTIVE, Correspondence.INACTIVE
    if NOT in phrase.words:
        stands, differs = differs, stands
    label = np.full(n, int(differs))
    label[meant] = int(stands)
    kept = weight > _NEGLIGIBLE * _FAR_NEGATIVE
    rests = posterior[:, meant].mean(axis=1)
    combos = np.flatnonzero(kept.any(axis=1))
    if len(combos):
        landmarks = [modifier.landmarks(c, encoder.number) for c in combos.tolist()]
        bag = encoder.placed(landmarks, ranking(phrase))[:, :n]
        kept = kept[combos]
        which = np.broadcast_to(label, kept.shape)[kept]
        yield Rows(phrase, bag[kept], which, share * weight[combos][kept])
    for c in np.flatnonzero(rests > _NEGLIGIBLE).tolist():
        for landmark in modifier.combos[c]:
            yield from _landmark(landmark, encoder, share * float(rests[c]))


def _landmark(landmark: Hypothesis, encoder: WorldEncoder, weight: float) -> Iterator[Rows]:
    """What a phrase for a landmark teaches, and what is said of the landmark in turn."""
    world, chosen = encoder.world, landmark.child.grounding.object
    at = encoder.number[chosen.id]
    label = np.zeros(len(world.things), dtype=np.int64)
    label[at] = Correspondence.ACTIVE
    yield Rows(landmark.tree.phrase, encoder.ranked(landmark.tree.phrase), label, np.full(len(label), weight))
    kept = np.zeros(len(label), dtype=np.bool_)
    kept[: len(world.meanable)] = _alike(landmark.tree.phrase, world.meanable, [chosen])
    kept[at] = True
    for below in landmark.children:
        phrase = below.tree.phrase
        stands, differs = Correspondence.ACTIVE, Correspondence.INACTIVE
        if NOT in phrase.words:
            stands, differs = differs, stands
        of_thing = np.full(len(label), int(differs))
        of_thing[at] = int(stands)
        numbers = tuple(encoder.number[h.child.grounding.object.id] for h in below.children)
        bag = encoder.placed([numbers], ranking(phrase))[0][kept]
        yield Rows(phrase, bag, of_thing[kept], np.full(len(bag), weight))
        for further in below.children:
            yield from _landmark(further, encoder, weight)


def _alike(head: Phrase, things: Sequence[Object], others: Sequence[Object]) -> Bools:
    """Does the head of a noun phrase say the same of each thing as of one of some others, by type and colour?"""
    kinds = {(o.type if head.noun is not None else None, o.color if head.color is not None else None) for o in others}
    found = [
        (o.type if head.noun is not None else None, o.color if head.color is not None else None) in kinds
        for o in things
    ]
    return np.array(found, dtype=np.bool_)
