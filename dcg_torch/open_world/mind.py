"""What an open-world model has learned and takes for granted: frozen values."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field

from dcg_torch.learning.beliefs import Beliefs, Prior
from dcg_torch.learning.soft_labels import Unseen
from dcg_torch.types import Percept

OUT_OF_VIEW = 1.0 - 57.0 / 360.0
"""Share of the ground that is out of view before the robot turns."""


@dataclass(frozen=True, slots=True)
class Census:
    """How many objects there are in a world that was looked at all round.

    Attributes:
        objects, cells: objects found, and pairs of type and colour that were looked for.
        again, found: objects found of a type and colour of which one was there already, and all that were found.

    The defaults are what is assumed before the first world, and give way to what is counted.
    """

    objects: float = 1.5
    cells: float = 10.0
    again: float = 0.25
    found: float = 10.0

    @property
    def rate(self) -> float:
        """Expected objects of one type and colour."""
        return self.objects / self.cells

    @property
    def repeats(self) -> float:
        """Expected further objects of a type and colour of which one is there."""
        return self.again / self.found

    def count(self, percepts: Collection[Percept], cells: int) -> Census:
        """With one more world."""
        repeated = len(percepts) - len({(p.type, p.color) for p in percepts})
        n = len(percepts)
        return Census(self.objects + n, self.cells + cells, self.again + repeated, self.found + n)


@dataclass(frozen=True, slots=True)
class OpenWorld:
    """What is assumed of the world and of speakers.

    Attributes:
        nouns: of nouns.
        colors: of colour words, which are hardly ever wrong.
        hidden: number of objects of a type and colour to be expected though the robot has looked round: hidden
            ones, and such that a speaker believes to be there.
        strength: see `soft.soft_examples`.
    """

    nouns: Prior = field(default_factory=Prior)
    colors: Prior = field(default_factory=lambda: Prior(slip=0.005))
    hidden: float = 0.01
    strength: float = 5.0


@dataclass(frozen=True)
class Mind:
    """All that an open-world model has learned; its weights follow from it.

    Attributes:
        beliefs: what the nouns name.
        color_beliefs: what the colour words name.
        assumed: what it takes for granted.
        census: how many objects there are.
    """

    beliefs: Beliefs
    color_beliefs: Beliefs
    assumed: OpenWorld = OpenWorld()
    census: Census = Census()

    @property
    def colors(self) -> int:
        """Number of colours met."""
        return max(1, len(self.color_beliefs.types))

    @property
    def unseen(self) -> Unseen:
        """How much what the robot has not seen weighs."""
        hidden = self.assumed.hidden
        return Unseen(
            ahead=_rivals((self.census.rate * (self.colors - 1) + self.census.repeats) * OUT_OF_VIEW) + hidden,
            ahead_colored=_rivals(self.census.repeats * OUT_OF_VIEW) + hidden,
            left=hidden,
        )

    def expected_unseen(self, *, looked: bool) -> float:
        """Objects of one type and colour that may have been there unseen."""
        return self.census.rate * (self.assumed.hidden if looked else OUT_OF_VIEW)


def _rivals(expected: float) -> float:
    """The odds of the unseen objects of a kind against one that is seen, when each is meant as likely as any other.

    With n of them, n Poisson, that one is meant with probability E[1 / (1 + n)], which is more than 1 / (1 + E[n]).
    """
    return expected / -math.expm1(-expected) - 1.0 if expected > 1e-9 else expected / 2.0
