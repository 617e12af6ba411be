"""Readings by replay: a parse is a run of choices, and other readings are runs that choose otherwise at one point.

A run asks `Decisions.choose` wherever a sentence can be read in several ways. Each choice has a rule and weighted
options, which are normalised; the sum of what was chosen is the reading's log-weight. `best_first` runs the likeliest
choices, then those that differ from a run made before in one later choice, the likeliest first. A run must ask the same
questions as long as it gets the same answers.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple, TypeVar

T = TypeVar("T")
_NEGLIGIBLE = -4.0  # log-weight, against the best, of what is not followed up


class Choice(NamedTuple):
    """A choice that was made: its rule, the normalised log-weights of its options, the number of the chosen one."""

    rule: str
    weights: tuple[float, ...]
    options: tuple[str, ...]
    chosen: int


class Decisions:
    """The choices of one run. `script` says the option to take at the first choices; later ones take the likeliest."""

    def __init__(self, script: tuple[int, ...] = ()) -> None:
        self._script = script
        self.made: list[Choice] = []

    def choose(self, rule: str, options: Mapping[str, float]) -> str:
        """One of the weighted options of a rule."""
        top = max(options.values())
        total = top + math.log(sum(math.exp(weight - top) for weight in options.values()))
        weights = tuple(weight - total for weight in options.values())
        at = len(self.made)
        chosen = self._script[at] if at < len(self._script) else max(range(len(weights)), key=weights.__getitem__)
        self.made.append(Choice(rule, weights, tuple(options), chosen))
        return self.made[-1].options[chosen]

    @property
    def log_weight(self) -> float:
        """The log-weight of the run."""
        return sum(choice.weights[choice.chosen] for choice in self.made)

    @property
    def rules(self) -> tuple[str, ...]:
        """What was chosen where there was a choice: "goal=destination"; an option's name ends at its first space."""
        return tuple(f"{c.rule}={c.options[c.chosen].split(' ')[0]}" for c in self.made if len(c.options) > 1)


def best_first(run: Callable[[Decisions], T], limit: int) -> Iterator[tuple[T, Decisions]]:
    """At most `limit` runs with their choices, by falling weight of what their scripts are known to cost."""
    heap: list[tuple[float, int, tuple[int, ...]]] = [(0.0, 0, ())]
    number, best = 0, None
    while heap and number < limit:
        cost, _, script = heapq.heappop(heap)
        if best is not None and -cost < best + _NEGLIGIBLE:
            return
        number += 1
        decisions = Decisions(script)
        yield run(decisions), decisions
        best = decisions.log_weight if best is None else best
        made = decisions.made
        for at in range(len(script), len(made)):
            before = tuple(choice.chosen for choice in made[:at])
            for other, weight in enumerate(made[at].weights):
                if other != made[at].chosen:
                    cost = decisions.log_weight - made[at].weights[made[at].chosen] + weight
                    heapq.heappush(heap, (-cost, len(heap) + number * 1000, (*before, other)))
