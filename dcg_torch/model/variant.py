"""What tells the models of the paper, and those beyond it, apart: feature groups and what enters the world model."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from dcg_torch.grounding.features import PAPER, FeatureSet, Group
from dcg_torch.learning.learner import Learner, TrainingSet
from dcg_torch.learning.places import group_nouns, place_examples, place_symbols
from dcg_torch.types import Correspondence, Example


@dataclass(frozen=True)
class Variant:
    """What a model variant is: its feature groups, and the objects that enter its world model.

    Attributes:
        groups: feature groups that are on.
        unknown: perceived objects of unknown type enter Upsilon (DCG-UPUP).
        hypothetical: hypothetical objects enter Upsilon (DCG-UPUP-Away).
        learns: the robot learns from outcomes (Alg. 1, lines 16 to 25).
        ternary: correspondences of eq. 4 (with INVERTED) rather than of eqs. 6, 8 and 9.
        l2: strength of the penalty on the weights.
        beam: hypotheses of a child phrase that its parent considers.
    """

    groups: frozenset[Group] = PAPER
    unknown: bool = True
    hypothetical: bool = True
    learns: bool = True
    ternary: bool = True
    l2: float = 0.05
    beam: int = 8

    @property
    def related(self) -> bool:
        """Whether it knows relations between things."""
        return Group.RELATION in self.groups


def restrict(examples: Iterable[Example], variant: Variant) -> list[Example]:
    """The examples as a variant sees them: without the objects that it does not represent.

    An example about such an object is left out, and with binary correspondences so is one of INVERTED.
    """
    kept = []
    for e in examples:
        objects, labels = e.world.objects, e.correspondences
        if not (variant.unknown and variant.hypothetical):
            seen = [(o.known or variant.unknown) and (variant.hypothetical or not o.hypothetical) for o in objects]
            objects = tuple(o for o, keep in zip(objects, seen, strict=True) if keep)
            labels = tuple(c for c, keep in zip(labels, seen, strict=True) if keep)
        signs = {*labels, *(c.correspondence for c in e.children)}
        if signs <= {None, Correspondence.INACTIVE} or (not variant.ternary and Correspondence.INVERTED in signs):
            continue
        if len(objects) == len(e.world.objects):
            kept.append(e)
        elif all(c.grounding.object in objects for c in e.children):
            kept.append(replace(e, world=replace(e.world, objects=objects), correspondences=labels))
    return kept


def initial_features(variant: Variant, training: TrainingSet, learner: Learner) -> FeatureSet:
    """The columns of a variant before it is trained (Alg. 1, lines 3 and 4)."""
    examples = learner.training_examples(FeatureSet(frozenset()))
    if not variant.related:
        return learner.columns(FeatureSet.initial(variant.groups, training.symbols, training.colors, list(examples)))
    words, said = [*training.symbols, *place_symbols()], [*examples, *place_examples()]
    features = FeatureSet.initial(variant.groups, words, training.colors, said)
    return learner.columns(features.include(nouns=group_nouns()))
