"""How well things fit a command apart from its nouns: what its nouns may be evidence of.

"The zorp behind the blue cube" teaches "zorp" from what stands behind the blue cube, and "the cube next to the zorp"
from what stands next to the cube meant. The factor graph says how well a thing fits, with the noun in question left
out of its phrase; nothing else decides.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from dcg_torch.grounding.features import FeatureSet
from dcg_torch.grounding.graph import FactorGraph, Solution
from dcg_torch.grounding.psi import LogLinearFactor
from dcg_torch.types import ParseTree, PhraseKind

_NEGLIGIBLE = 0.02
"""Objects that are meant with less probability say nothing of landmarks."""


def target(tree: ParseTree) -> ParseTree | None:
    """The noun phrase of the object meant, with all that describes it."""
    return next((node for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN), None)


def described_fit(
    solution: Solution, features: FeatureSet, model: LogLinearFactor, beam: int
) -> dict[str, float] | None:
    """object id -> how well the describing words and the modifiers of the object meant fit it.

    Returns:
        Weights of mean 1 over the objects that have been perceived; None if nothing describes.
    """
    noun = target(solution.tree)
    if noun is None or not (noun.phrase.words or noun.children):
        return None
    bare = replace(noun, phrase=replace(noun.phrase, noun=None, color=None))
    found = FactorGraph(bare, solution.world).solve(features, model, beam=beam).probabilities
    seen = [o.id for o in solution.world.objects if not o.hypothetical]
    mean = sum(found[i] for i in seen) / max(1, len(seen))
    return {i: found[i] / mean for i in seen} if mean > 0.0 else None


def landmark_fits(
    solution: Solution, features: FeatureSet, model: LogLinearFactor, beam: int
) -> list[tuple[str, Mapping[str, float]]]:
    """Of every landmark of the object meant: its noun, and thing id -> probability that it is the landmark.

    The landmark's own noun is left out, so that what is believed of it already is not taken for evidence.
    """
    noun = target(solution.tree)
    out: list[tuple[str, Mapping[str, float]]] = []
    if noun is None:
        return out
    for m, modifier in enumerate(noun.children):
        for k, landmark in enumerate(modifier.children):
            word = landmark.phrase.noun
            if word is None:
                continue
            bare = replace(landmark, phrase=replace(landmark.phrase, noun=None))
            without = replace(modifier, children=(*modifier.children[:k], bare, *modifier.children[k + 1 :]))
            tree = replace(noun, children=(*noun.children[:m], without, *noun.children[m + 1 :]))
            graph = FactorGraph(tree, solution.world)
            meant = graph.solve(features, model, beam=beam).probabilities
            fits: defaultdict[str, float] = defaultdict(float)
            placed = next(p for p in graph.modifiers(features, model, beam=beam) if p.tree == without)
            seen = [
                j for j, o in enumerate(solution.world.objects) if not o.hypothetical and meant[o.id] >= _NEGLIGIBLE
            ]
            shares = np.array([meant[solution.world.objects[j].id] for j in seen])
            for combo, probability in zip(placed.combos, placed.posterior[:, seen] @ shares, strict=True):
                fits[combo[k].child.grounding.object.id] += float(probability)
            out.append((word, dict(fits)))
    return out
