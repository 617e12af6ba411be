"""The recogniser that names what the camera shows, with the mistakes that it is told to make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Recogniser:
    """How well objects are named; the default is the paper's, perfect.

    Args:
        min_pixels: an object with fewer visible pixels isn't noticed (one of 0.3 m has about 30 at 8 m).
        wrong_class: probability that an object is taken for one of another type.
        missed: probability that an object isn't recognised at all.
        types: the types it knows; a wrong one is drawn evenly from the others.

    Raises:
        ValueError: a probability outside [0, 1], or `wrong_class` above 0 with fewer than two types.
    """

    min_pixels: int = 8
    wrong_class: float = 0.0
    missed: float = 0.0
    types: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.min_pixels < 1:
            raise ValueError(f"min_pixels is {self.min_pixels}; it must be at least 1")
        for name, value in (("wrong_class", self.wrong_class), ("missed", self.missed)):
            if not 0.0 <= value <= 1.0:
                raise ValueError(f"{name} is {value}; a probability lies between 0 and 1")
        if self.wrong_class > 0.0 and len(set(self.types)) < 2:
            raise ValueError(f"wrong_class is {self.wrong_class}, and types={self.types} leaves no wrong type to draw")

    def labels(self, types: Sequence[str], rng: np.random.Generator) -> list[str | None]:
        """What each object of a world, in order, is recognised as while that world lasts; None: never.

        Every object takes the same two numbers and one choice from `rng`, whatever the probabilities, so that
        the same objects are confused at 5 % and at 10 %.
        """
        labels: list[str | None] = []
        for type_ in types:
            miss, wrong, which = rng.random(3)
            others = sorted(set(self.types) - {type_})
            if miss < self.missed:
                labels.append(None)
            elif wrong < self.wrong_class:
                labels.append(others[int(which * len(others))])
            else:
                labels.append(type_)
        return labels
