"""Learning from commands whose objects are known: the landmarks that they speak of are not, and are inferred.

Expectation-maximisation over the landmarks. A lesson says which object a command means, not which cube "next to the
cube" speaks of. So, in turn: with the present model, p(landmark | object meant) for every modifier (`graph.Placed`);
then examples weighted by it, and one fit of the log-linear model on all of them. The first turn knows no relations
and spreads over all landmarks that the words allow.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

from dcg_torch.grounding.graph import FactorGraph, Hypothesis, Placed
from dcg_torch.grounding.fit import FitResult
from dcg_torch.model import GroundingModel
from dcg_torch.relational import coordinated, grouped, is_group
from dcg_torch.types import NOT, Correspondence, Example, Object, ParseTree, Phrase, PhraseKind, Symbol, WorldModel

_NEGLIGIBLE = 0.02
"""Landmarks less probable than this teach nothing."""
_FAR_NEGATIVE = 0.1
"""Weight of the objects that the noun phrase may rule out by itself, as negative examples of its modifiers."""
_STEPS = 300
"""L-BFGS iterations of the last round."""


@dataclass(frozen=True)
class Lesson:
    """A command and the ids of the objects it means; `weight` scales its likelihood."""

    tree: ParseTree
    world: WorldModel
    targets: frozenset[str]
    weight: float = 1.0


def teach(
    model: GroundingModel,
    lessons: Sequence[Lesson],
    *,
    known_types: Collection[str] | None = None,
    known_colors: Collection[str] | None = None,
    rounds: int = 4,
    beam: int = 12,
    progress: Callable[[int], None] | None = None,
) -> FitResult:
    """Train a model on lessons, which are added to its corpus.

    Args:
        known_types: types that may become known; None: all that are meant in the lessons.
        known_colors: the same of colours; a word for a colour that no lesson says of such an object is not known.
        rounds: of expectation and maximisation.
        beam: landmarks considered for each modifier.
        progress: called with the number of each round that is done.
    """
    prepared = [part for lesson in lessons for part in _parts(model, lesson)]
    words, colors = _inventory(prepared, known_types, known_colors)
    phrases = [Example(node.phrase, part.world, ()) for part in prepared for node in part.noun.walk()]
    for word in words:
        model.symbols.setdefault(word.word, word)
    model.features = model.features.extended(words, colors, phrases)
    model.loglinear.grow(model.features.pairs)
    before = list(model.corpus)
    for number in range(rounds):
        model.corpus = before + [e for part in prepared for e in _expect(model, part, beam)]
        # The weights are only on their way until the landmarks have settled.
        fitted = model.train(max_steps=_STEPS if number == rounds - 1 else _STEPS // 4)
        if progress is not None:
            progress(number)
    return fitted


@dataclass(frozen=True)
class _Part:
    """One noun phrase that a lesson is about; `alone` if the lesson joins no others to it."""

    noun: ParseTree
    world: WorldModel
    targets: frozenset[str]
    weight: float
    alone: bool


def _parts(model: GroundingModel, lesson: Lesson) -> list[_Part]:
    """The noun phrases that a lesson joins, each in the world with the groups that it may speak of."""
    found = []
    trees = coordinated(lesson.tree)
    for tree in trees:
        noun = _noun(model.readable(tree))
        if noun is not None:
            found.append(_Part(noun, grouped(lesson.world, tree), lesson.targets, lesson.weight, len(trees) == 1))
    return found


def _noun(tree: ParseTree) -> ParseTree | None:
    """The noun phrase of the object meant."""
    return next((node for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN), None)


def _inventory(
    prepared: Sequence[_Part], known_types: Collection[str] | None, known_colors: Collection[str] | None
) -> tuple[list[Symbol], list[str]]:
    """The symbols that the lessons make known, each noun for the type it means most, and their colours."""
    meant: dict[str, Counter[str]] = {}
    colors: dict[str, None] = {}
    for part in prepared:
        for o in part.world.objects:
            if o.id in part.targets and o.type is not None and (known_types is None or o.type in known_types):
                if part.noun.phrase.noun is not None and part.alone:
                    meant.setdefault(part.noun.phrase.noun, Counter())[o.type] += 1
                if o.color is not None and (known_colors is None or o.color in known_colors):
                    colors[o.color] = None
        for node in part.noun.walk():
            if node.phrase.color is not None and (known_colors is None or node is part.noun):
                colors[node.phrase.color] = None
    return [Symbol(word, types.most_common(1)[0][0]) for word, types in meant.items()], list(colors)


def _expect(model: GroundingModel, part: _Part, beam: int) -> list[Example]:
    """The examples of a noun phrase, weighted by what the present model takes its landmarks to be."""
    world, noun = part.world, part.noun
    graph = FactorGraph(noun, world)
    examples: list[Example] = []
    for chance, meant in _choices(model, part, graph):
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
            for modifier in graph.modifiers(model.features, model.loglinear, beam=beam):
                examples += _placed(modifier, noun.phrase, world, share, meant, open_)
    return examples


def _choices(model: GroundingModel, part: _Part, graph: FactorGraph) -> list[tuple[float, list[int]]]:
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
    probabilities = graph.solve(model.features, model.loglinear).probabilities
    shares = [probabilities[things[j].id] for j in meant]
    return [(s / sum(shares), [j]) for s, j in zip(shares, meant, strict=True) if s > _NEGLIGIBLE * sum(shares)]


def _placed(
    modifier: Placed, head: Phrase, world: WorldModel, share: float, meant: Sequence[int], spared: Collection[int]
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
