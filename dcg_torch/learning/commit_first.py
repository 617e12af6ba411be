"""Learning from an outcome: Algorithm 1, lines 16 to 24, as pure functions of examples and symbols."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

from dcg_torch.grounding.features import FeatureSet
from dcg_torch.grounding.graph import Solution
from dcg_torch.types import Child, Correspondence, Example, Object, Phrase, PhraseKind, Symbol, WorldModel


def unsupervised_training(solution: Solution) -> list[Example]:
    """T_u: the command's phrases labelled with the grounding that was acted on (line 16).

    For every phrase the chosen grounding is a positive example and the others are negative ones, save those
    that the phrase describes just as well: they are no evidence against the words. Nor is the unseen one of the
    type that was found: the preference for what is in view has been taught, and would grow with every command.
    """
    if solution.best is None:
        return []
    return [
        labelled(h.tree.phrase, h.child, h.factor_children, solution.world, unseen_alike=True)
        for h in solution.best.walk()
    ]


def labelled(
    phrase: Phrase, meant: Child, children: tuple[Child, ...], world: WorldModel, *, unseen_alike: bool = False
) -> Example:
    """One positive example, with the negatives that it implies: all that the phrase does not describe as well.

    Args:
        unseen_alike: leave the hypothetical object of the meant one's type unlabelled too.
    """
    chosen = meant.grounding.object

    def label(o: Object) -> Correspondence | None:
        if o.id == chosen.id:
            return meant.correspondence
        if phrase.kind is PhraseKind.MODIFIER:
            return None  # it describes, it does not pick: others may stand so too
        if phrase.kind is PhraseKind.NOUN and (
            described_alike(phrase, o, chosen) or (unseen_alike and o.hypothetical and o.type == chosen.type)
        ):
            return None
        return Correspondence.INACTIVE

    return Example(
        phrase, world, tuple(label(o) for o in (world.objects if chosen in world.objects else world.things)), children
    )


def described_alike(phrase: Phrase, one: Object, other: Object) -> bool:
    """Would a noun phrase that means `other` describe `one` as well?

    Both of one type, in or out of view alike, and of one colour if the phrase states any.
    """
    same_kind = one.type == other.type and one.known == other.known and one.hypothetical == other.hypothetical
    return same_kind and (phrase.color is None or one.color == other.color)


def new_symbol(solution: Solution, features: FeatureSet, *, synonyms: float | None = None) -> Symbol | None:
    """gamma': the symbol to learn, if an unknown noun met a perceived object of unknown type (lines 17 and 18).

    Args:
        synonyms: beyond the paper, an unknown noun may also become another word for a known type: where nothing of
            unknown type is in the world, and the grounding has at least this probability.
    """
    obj, noun = solution.object, solution.noun
    if obj is None or obj.hypothetical or obj.type is None:
        return None
    if noun is None or noun.noun is None or features.knows_noun(noun.noun):
        return None
    if obj.known:
        strange = any(not o.known for o in solution.world.objects)
        if synonyms is None or strange or (solution.probability or 0.0) < synonyms:
            return None
    return Symbol(noun.noun, obj.type, obj.color, noun.color)


def replace_unknown(examples: Iterable[Example], known_types: Collection[str]) -> list[Example]:
    """The examples with every object's `known` as it is under `known_types` (line 23).

    An example recorded while a type was unknown changes its meaning when the type is learned: positives and
    negatives alike. Examples that mention no such object are returned as they are.
    """
    renewed: dict[int, WorldModel] = {}  # examples of one world go on sharing it
    return [_relabel(e, known_types, renewed) for e in examples]


def _relabel(example: Example, known_types: Collection[str], renewed: dict[int, WorldModel]) -> Example:
    def renew(o: Object) -> Object:
        known = o.type in known_types
        return o if o.known == known else replace(o, known=known)

    old = example.world
    if id(old) not in renewed:
        objects = tuple(renew(o) for o in old.objects)
        same = all(new is was for new, was in zip(objects, old.objects, strict=True))
        renewed[id(old)] = old if same else replace(old, objects=objects)
    world = renewed[id(old)]
    if world is old:
        return example
    places = {o.id for o in old.places}  # these are known from the start
    children = tuple(
        c
        if c.grounding.object.id in places
        else replace(c, grounding=replace(c.grounding, object=renew(c.grounding.object)))
        for c in example.children
    )
    return replace(example, world=world, children=children)


def contrast(example: Example, symbols: Mapping[str, Symbol]) -> Example:
    """A noun phrase's example over all of M.Gamma: with a factor for every known type that was not meant.

    Upsilon is the product of the symbolic objects and their attributes (Section II), so training sees, beside the
    object that was meant, one of every other known type with the same attributes, INACTIVE. Without these, what is
    known of a word learned in one lesson could not outweigh a matching colour.
    """
    meant = [
        o for o, c in zip(example.world.objects, example.correspondences, strict=False) if c is not None and c != 0
    ]
    if example.phrase.kind is not PhraseKind.NOUN or len(meant) != 1:
        return example
    named = symbols.get(example.phrase.noun or "")
    spared = {meant[0].type, None if named is None else named.type}
    others = [
        replace(meant[0], id=f"{meant[0].id} as {t}", type=t, known=True)
        for t in dict.fromkeys(s.type for s in symbols.values())
        if t not in spared
    ]
    return replace(
        example,
        world=replace(example.world, objects=(*example.world.objects, *others)),
        correspondences=(*example.correspondences, *(Correspondence.INACTIVE for _ in others)),
    )
