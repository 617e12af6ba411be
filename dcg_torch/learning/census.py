"""What is counted: how many objects worlds have, and whose left and right those who speak in them mean."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, replace

from dcg_torch.types import Object


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

    def __post_init__(self) -> None:
        if not all(0.0 <= n < math.inf for n in (self.objects, self.again)) or not self.cells * self.found > 0.0:
            raise ValueError("census: what is counted is not negative, and cells and found are positive")

    @property
    def rate(self) -> float:
        """Expected objects of one type and colour."""
        return self.objects / self.cells

    @property
    def repeats(self) -> float:
        """Expected further objects of a type and colour of which one is there."""
        return self.again / self.found

    def count(self, seen: Collection[Object], cells: int) -> Census:
        """The census with one more world."""
        n, repeated = len(seen), len(seen) - len({(o.type, o.color) for o in seen})
        return Census(self.objects + n, self.cells + cells, self.again + repeated, self.found + n)


@dataclass(frozen=True, slots=True)
class FrameCounts:
    """Commands in the robot's frame of reference and in the speaker's, as far as either can be told.

    The defaults are what is assumed before the first, and give way to what is counted.
    """

    robot: float = 4.0
    speaker: float = 2.0

    @property
    def speakers(self) -> float:
        """The probability of the speaker's frame."""
        return self.speaker / (self.robot + self.speaker)

    def count(self, speakers: float | None) -> FrameCounts:
        """The counts with one more command, in the speaker's frame with that probability; None: both are one."""
        if speakers is None:
            return self
        return replace(self, robot=self.robot + 1.0 - speakers, speaker=self.speaker + speakers)
