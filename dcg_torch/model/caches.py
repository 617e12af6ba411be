"""What a model keeps between calls so that nothing is done twice: a fit, the features of examples and of a world,
the tables of phrases."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.fitting.psi import LogLinearFactor
from dcg_torch.grounding.encoders import Encoders
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.features import FeatureSet
from dcg_torch.grounding.statistics import SoftLabels, Statistics
from dcg_torch.grounding.tables import Tables
from dcg_torch.types import Example, WorldModel
from dcg_torch.types.arrays import Bools, Floats

_MOST_THINGS = 1 << 12
"""Things of all the worlds whose encoders are kept."""


@dataclass
class Kept:
    """What one model keeps between calls; a copy of it starts with the statistics alone.

    Attributes:
        statistics: what features see of examples.
        follows: what the weights follow from as they are; None: they have not been fitted.
        encoders: of the worlds that were grounded in last: what a command teaches is found by grounding there again,
            and the next command may be about the same scene.
        tables: of the phrases that were grounded under the weights as they were last.
    """

    statistics: Statistics
    follows: Followed | None = None
    encoders: Encoders | None = None
    tables: Tables | None = None

    def encoder(self, features: FeatureSet, world: WorldModel) -> WorldEncoder:
        """The encoder of a world under these columns."""
        if self.encoders is None or self.encoders.features is not features:
            self.encoders = Encoders(features, _MOST_THINGS)
        return self.encoders.of(world)

    def phrases(self, features: FeatureSet, factor: LogLinearFactor) -> Tables:
        """The tables of phrases under these columns and weights."""
        if self.tables is None or not self.tables.hold(features, factor):
            self.tables = Tables(features, factor)
        return self.tables


@dataclass(frozen=True)
class Followed:
    """The inputs of a fit: where nothing of them has changed, it would end where it did.

    Attributes:
        features: the columns.
        weight: what the fit has made of them; another one, if someone else has set the weights meanwhile.
        prior: what they are pulled towards; None: zero.
        examples, soft: what they follow.
        free: (L, G) those that do; None: all.
    """

    features: FeatureSet
    weight: object
    prior: Floats | None
    examples: Sequence[Example]
    soft: Sequence[SoftLabels]
    free: Bools | None

    def same(self, other: Followed) -> bool:
        """Would a fit find the same weights again? Examples are the same only if they are the same objects."""
        if self.features is not other.features or self.weight is not other.weight or self.prior is not other.prior:
            return False
        if len(self.examples) != len(other.examples) or len(self.soft) != len(other.soft):
            return False
        return (
            all(one is another for one, another in zip(self.examples, other.examples, strict=True))
            and all(_equal(one, another) for one, another in zip(self.soft, other.soft, strict=True))
            and _same_mask(self.free, other.free)
        )


def _equal(one: SoftLabels, other: SoftLabels) -> bool:
    if one.phrases != other.phrases or one.objects != other.objects or not _same_mask(one.shown, other.shown):
        return False
    return np.array_equal(one.active, other.active) and np.array_equal(one.inactive, other.inactive)


def _same_mask(one: Bools | None, other: Bools | None) -> bool:
    return one is other if one is None or other is None else np.array_equal(one, other)
