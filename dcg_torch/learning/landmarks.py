"""Learning from commands whose objects are known: the landmarks that they speak of are not, and are inferred.

Expectation-maximisation over the landmarks. A lesson says which object a command means, not which cube "next to the
cube" speaks of. So, in turn: with the present model, p(landmark | object meant) for every modifier
(`solution.ModifierFactor`); then examples weighted by it, and one fit of the log-linear factor on all of them. The
first turn knows no relations and spreads over all landmarks that the words allow.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, replace

from dcg_torch.grounding.factor_tree import coordinated, is_group, speaks_of_groups, to_factor_tree
from dcg_torch.grounding.features import GROUNDING_OF
from dcg_torch.grounding.solution import Hypothesis, ModifierFactor, Solution, target_of
from dcg_torch.learning.evidence import Ground
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
    ground: Ground,
    fit: Callable[[list[Example], bool], None],
    *,
    rounds: int,
    progress: Callable[[int], None] | None = None,
) -> None:
    """Expect the landmarks and maximise the likelihood, in turn.

    Args:
        ground: grounds with the present weights.
        fit: fits them to examples; told whether it is the last round, before which they are only on their way.
        rounds: of expectation and maximisation.
        progress: called with the number of each round that is done.
    """
    for number in range(rounds):
        fit([e for part in parts for e in _expected(part, ground)], number == rounds - 1)
        if progress is not None:
            progress(number)


def parts_of(lesson: Lesson) -> list[Part]:
    """The noun phrases that a lesson joins, each in the world with the groups that it may speak of."""
    found = []
    trees = coordinated(lesson.tree)
    for tree in trees:
        noun = target_of(to_factor_tree(tree))
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
        path, node = [], to_factor_tree(lesson.tree)
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


def _expected(part: Part, ground: Ground) -> list[Example]:
    """The examples of a noun phrase, weighted by what the present model takes its landmarks to be."""
    world, noun = part.world, part.noun
    solution = ground(noun, world)
    examples: list[Example] = []
    for chance, meant in _choices(part, solution):
        share = chance * part.weight
        labels: list[Correspondence | None] = [Correspondence.INACTIVE] * len(world.meanable)
        for j, o in enumerate(world.meanable):
            told_apart = bool(noun.children) and any(_alike(noun.phrase, o, world.things[k]) for k in meant)
            if told_apart or (o.id in part.targets and not part.alone):
                labels[j] = None  # here it is the modifiers, or the other noun phrases, that tell them apart
        for j in meant:
            labels[j] = Correspondence.ACTIVE
        examples.append(Example(noun.phrase, world, tuple(labels), weight=share))
        if noun.children:
            open_ = {j for j, o in enumerate(world.things) if o.id in part.targets}
            for modifier in solution.modifiers:
                examples += _placed(modifier, noun.phrase, world, share, meant, open_)
    return examples


def _choices(part: Part, solution: Solution) -> list[tuple[float, list[int]]]:
    """What a noun phrase may mean of what the lesson means, with weights: numbers of things.

    A phrase for a group means the group whose members are meant. Of several joined phrases, each means one of the
    targets: which, the present model says.
    """
    things = part.world.things
    if is_group(part.noun.phrase):
        groups = [j for j, o in enumerate(things) if o.members and part.targets == set(o.members)]
        if groups:
            return [(1.0, groups)]
    meant = [j for j, o in enumerate(part.world.objects) if o.id in part.targets]
    if part.alone or part.noun.phrase.plural:
        return [(1.0, meant)]
    shares = [solution.probabilities[things[j].id] for j in meant]
    return [(s / sum(shares), [j]) for s, j in zip(shares, meant, strict=True) if s > _NEGLIGIBLE * sum(shares)]


def _placed(
    modifier: ModifierFactor,
    head: Phrase,
    world: WorldModel,
    share: float,
    meant: Sequence[int],
    spared: Collection[int],
) -> list[Example]:
    """What a modifier and its landmarks teach: the things meant stand so, others that the head allows do not.

    Of both, the landmarks are those that the present model takes them to rest on. So what speaks most for a wrong
    thing is what is learned to speak against it.
    """
    things = world.things
    alike = [any(_alike(head, o, things[k]) for k in meant) for o in world.meanable]
    posterior = modifier.posterior
    told_apart = not head.words  # "the second cube in the row": the others are in it too
    stands, differs = Correspondence.ACTIVE, Correspondence.INACTIVE
    if NOT in modifier.tree.phrase.words:
        stands, differs = differs, stands
    examples = []
    for c, combo in enumerate(modifier.combos):
        labels: list[Correspondence | None] = [None] * len(things)
        weights = [0.0] * len(things)
        for j in range(len(world.meanable)):
            if j in meant:
                labels[j], weights[j] = stands, posterior[c, j] / len(meant)
            elif j not in spared:
                near = posterior[c, j] * (1.0 if told_apart and alike[j] else _FAR_NEGATIVE)
                labels[j], weights[j] = differs, near
        taught = [w > _NEGLIGIBLE * _FAR_NEGATIVE for w in weights]
        children = tuple(h.child for h in combo)
        kept = tuple(label if t else None for label, t in zip(labels, taught, strict=True))
        if any(taught):
            examples.append(Example(modifier.tree.phrase, world, kept, children, share, tuple(weights)))
        weight = share * float(posterior[c, list(meant)].mean())
        if weight > share * _NEGLIGIBLE:
            for landmark in combo:
                examples += _landmark(landmark, world, weight)
    return examples


def _landmark(landmark: Hypothesis, world: WorldModel, weight: float) -> list[Example]:
    """What a phrase for a landmark teaches, and what is said of the landmark in turn."""
    chosen = landmark.child.grounding.object
    active, inactive = Correspondence.ACTIVE, Correspondence.INACTIVE
    labels = tuple(active if thing.id == chosen.id else inactive for thing in world.things)
    examples = [Example(landmark.tree.phrase, world, labels, (), weight)]
    at = next(j for j, thing in enumerate(world.things) if thing.id == chosen.id)
    for below in landmark.children:
        stands, differs = (inactive, active) if NOT in below.tree.phrase.words else (active, inactive)
        near: list[Correspondence | None] = [None] * len(world.things)
        for j, thing in enumerate(world.meanable):
            if _alike(landmark.tree.phrase, thing, chosen):
                near[j] = differs
        near[at] = stands
        children = tuple(h.child for h in below.children)
        examples.append(Example(below.tree.phrase, world, tuple(near), children, weight))
        for further in below.children:
            examples += _landmark(further, world, weight)
    return examples


def _alike(head: Phrase, one: Object, other: Object) -> bool:
    """Does the head of a noun phrase say the same of both, as far as their types and colours go?"""
    return (head.noun is None or one.type == other.type) and (head.color is None or one.color == other.color)
