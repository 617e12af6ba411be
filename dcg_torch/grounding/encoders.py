"""The encoders of worlds, each made once: many commands are said in one scene, and a robot looks again and again."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable
from dataclasses import replace

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.features import FeatureSet, KindColumns
from dcg_torch.types import WorldModel

_MOST_KINDS = 1 << 14
"""Kinds of things whose columns are kept from world to world, where not all is kept."""


class Encoders:
    """The encoders of worlds under the same columns. Worlds that are equal share one.

    Args:
        features: the columns.
        most: things of all the worlds that are kept, beyond which all are forgotten but the newest; None: none is.
    """

    def __init__(self, features: FeatureSet, most: int | None = None) -> None:
        self.features = features
        self._most = most
        self._forget()

    def _forget(self) -> None:
        self._alike: defaultdict[Hashable, list[WorldEncoder]] = defaultdict(list)
        self._kinds: KindColumns = {}
        self._things = 0

    def of(self, world: WorldModel) -> WorldEncoder:
        """The encoder of a world; of one where some alone can be meant it is that of the same world where all can."""
        for encoder in self._alike[_outline(world)]:
            if encoder.world is world or encoder.world == world:
                return encoder
        whole = None if world.meant is None else self.of(replace(world, meant=None))
        self._make_room(len(world.objects))
        new = WorldEncoder(self.features, world, self._kinds) if whole is None else whole.meaning(world)
        self._alike[_outline(world)].append(new)
        return new

    def _make_room(self, things: int) -> None:
        if self._most is not None and (self._things + things > self._most or len(self._kinds) > _MOST_KINDS):
            self._forget()
        self._things += things


def _outline(world: WorldModel) -> Hashable:
    """What equal worlds share and few others do; of many things not all are looked at."""
    ends = world.objects[:1], world.objects[-1:]
    return ends, len(world.objects), len(world.places), len(world.groups), world.robot, world.viewer, world.meant
