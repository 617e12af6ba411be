"""Minimisers of smooth convex functions for `fit`: damped Newton steps, and L-BFGS in numpy or as torch has it.

They stop at an absolute max-norm of the gradient, which the function itself gives beside its value and gradient: it
may use other variables than the weights that its caller means. Near the optimum the value no longer changes in its
last digits while the gradient still falls, so a step is also taken when the value stays the same to rounding and
the slope shrinks (Hager and Zhang, "A new conjugate gradient method ...", SIAM J. Optim. 16, 2005, section 4).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
import torch

from dcg_torch.types.arrays import Floats

_SUFFICIENT, _CURVATURE = 1e-4, 0.9
"""Constants of the strong Wolfe conditions."""
_ROUNDING = 1e-11
"""Relative change of the value that may be rounding alone."""
_DOWNHILL = 0.15
"""Share of the slope at the start that is still steep, for Newton's method."""
_PAIRS = 20
"""Curvature pairs that L-BFGS keeps."""
_TRIALS = 25
"""Steps tried along one direction before the search gives up."""


@dataclass(frozen=True)
class Point:
    """Where a minimiser is and what the function says there.

    Attributes:
        at: the variables.
        norm: what decides when to stop.
        chances: probabilities of the rows, from which the curvature follows; where these are too many, of none.
    """

    at: Floats
    value: float
    gradient: Floats
    norm: float
    chances: Floats


class Direction(NamedTuple):
    """A Newton step, and minus the inverse Hessian as a function of any gradient, where it is cheap to use again."""

    towards: Floats
    again: Callable[[Floats], Floats] | None = None


Function = Callable[[Floats], Point]
Status = Literal["converged", "step limit", "stalled"]


@dataclass(frozen=True)
class Minimum:
    """Where a minimiser ended, after how many steps and evaluations, and why."""

    point: Point
    steps: int
    evaluations: int
    status: Status


def newton(
    function: Function,
    direction: Callable[[Point], Direction],
    start: Floats,
    *,
    tolerance: float,
    max_steps: int,
    guess: Callable[[Floats], Floats | None] | None = None,
) -> Minimum:
    """Newton's method with halved steps where a whole one goes too far.

    A further step by the Hessian of the point before shrinks the gradient about as much as the step from there did. So
    where that is enough it is the last one, without a Hessian of its own.

    Args:
        direction: where to go from a point.
        start: the variables at first.
        tolerance: stop at this `norm`.
        max_steps: at the most.
        guess: variables that may be better than those at first; None where there are none.
    """
    point, evaluations = function(start), 1
    if guess is not None and point.norm > tolerance and (other := guess(start)) is not None:
        guessed, evaluations = function(other), 2
        point = guessed if guessed.value < point.value else point
    for step in range(max_steps + 1):
        if point.norm <= tolerance:
            return Minimum(point, step, evaluations, "converged")
        if step == max_steps:
            break
        towards, again = direction(point)
        better, tried = _along(function, point, towards)
        evaluations += tried
        if better is None:
            return Minimum(point, step, evaluations, "stalled")
        if again and better.norm > tolerance and better.norm * better.norm <= tolerance * point.norm:
            last, evaluations = function(better.at + again(better.gradient)), evaluations + 1
            better = last if last.norm < better.norm else better
        point = better
    return Minimum(point, max_steps, evaluations, "step limit")


def _along(function: Function, start: Point, towards: Floats) -> tuple[Point | None, int]:
    """A good point along a Newton direction, and how many were tried.

    A step is halved until the value falls enough. Where labels are nearly certain the likelihood flattens like an
    exponential, of which Newton's method takes one unit a step: there a step that still leads downhill is doubled.
    """
    slope = float(start.gradient @ towards)
    length, tried = 1.0, 0
    best: Point | None = None
    while tried < _TRIALS:
        point = function(start.at + length * towards)
        tried += 1
        own = float(point.gradient @ towards)
        if best is not None and point.value >= best.value:
            break
        if _low_enough(start, point, length, slope, own):
            best = point
            if length < 1.0 or own > _DOWNHILL * slope:
                break
            length *= 2.0
        elif best is not None:
            break
        else:
            length *= 0.5
    return best, tried


def lbfgs(function: Function, start: Floats, *, tolerance: float, max_steps: int) -> Minimum:
    """L-BFGS with a line search for the strong Wolfe conditions (Nocedal and Wright, chapters 3 and 7).

    Args:
        start: the variables at first.
        tolerance: stop at this `norm`.
        max_steps: at the most.
    """
    point, evaluations = function(start), 1
    moves: list[tuple[Floats, Floats, float]] = []
    for step in range(max_steps + 1):
        if point.norm <= tolerance:
            return Minimum(point, step, evaluations, "converged")
        if step == max_steps:
            break
        towards = _two_loops(point.gradient, moves)
        slope = float(point.gradient @ towards)
        length = 1.0 if moves else min(1.0, 1.0 / float(np.abs(point.gradient).sum()))
        other, tried = _search(function, point, towards, slope, length)
        evaluations += tried
        if other is None:
            if not moves:
                return Minimum(point, step, evaluations, "stalled")
            moves.clear()
            continue
        moved, turned = other.at - point.at, other.gradient - point.gradient
        curvature = float(moved @ turned)
        if curvature > 1e-16 * float(turned @ turned):
            moves.append((moved, turned, 1.0 / curvature))
            del moves[:-_PAIRS]
        point = other
    return Minimum(point, max_steps, evaluations, "step limit")


def _two_loops(gradient: Floats, moves: list[tuple[Floats, Floats, float]]) -> Floats:
    """Minus the inverse Hessian, as the curvature pairs say, times the gradient."""
    towards = -gradient
    alphas = []
    for moved, turned, rho in reversed(moves):
        alpha = rho * float(moved @ towards)
        towards -= alpha * turned
        alphas.append(alpha)
    if moves:
        _, turned, rho = moves[-1]
        towards /= rho * float(turned @ turned)
    for (moved, turned, rho), alpha in zip(moves, reversed(alphas), strict=True):
        towards += (alpha - rho * float(turned @ towards)) * moved
    return towards


def _search(function: Function, start: Point, towards: Floats, slope: float, length: float) -> tuple[Point | None, int]:
    """A point along a direction that satisfies the strong Wolfe conditions, and how many were tried."""
    low, low_value, low_slope = 0.0, start.value, slope
    high: tuple[float, float, float] | None = None
    for tried in range(1, _TRIALS + 1):
        point = function(start.at + length * towards)
        own = float(point.gradient @ towards)
        if _low_enough(start, point, length, slope, own) and abs(own) <= -_CURVATURE * slope:
            return point, tried
        rounding = _ROUNDING * abs(start.value)
        if point.value > start.value + _SUFFICIENT * length * slope + rounding or point.value > low_value + rounding:
            high = (length, point.value, own)
        else:
            if own * ((high[0] if high else np.inf) - low) >= 0.0:
                high = (low, low_value, low_slope)
            low, low_value, low_slope = length, point.value, own
        length = 4.0 * length if high is None else _between(low, low_value, low_slope, *high)
    return None, _TRIALS


def _between(
    low: float, low_value: float, low_slope: float, high: float, high_value: float, high_slope: float
) -> float:
    """The minimum of the cubic through both ends, kept away from them."""
    width = high - low
    first = low_slope + high_slope - 3.0 * (high_value - low_value) / width
    under = first * first - low_slope * high_slope
    fraction = 0.5
    if under >= 0.0:
        root = np.copysign(np.sqrt(under), width)
        divisor = high_slope - low_slope + 2.0 * root
        fraction = 1.0 - (high_slope + root - first) / divisor if divisor != 0.0 else 0.5
    return low + width * float(np.clip(fraction if np.isfinite(fraction) else 0.5, 0.1, 0.9))


def _low_enough(start: Point, other: Point, length: float, slope: float, own: float) -> bool:
    """Has the value fallen enough, or does it stand still to rounding while the slope has shrunk?"""
    if other.value <= start.value + _SUFFICIENT * length * slope:
        return True
    return other.value <= start.value + _ROUNDING * abs(start.value) and abs(own) <= _CURVATURE * abs(slope)


def lbfgs_of_torch(function: Function, start: Floats, *, tolerance: float, max_steps: int) -> Minimum:
    """A minimum by `torch.optim.LBFGS`; it stops by the gradient of the variables themselves."""
    moving = torch.from_numpy(start.copy()).requires_grad_()
    optimizer = torch.optim.LBFGS(
        [moving],
        max_iter=max_steps,
        max_eval=2 * max_steps,
        history_size=_PAIRS,
        tolerance_grad=0.5 * tolerance,  # `norm` is that of sums of up to two of its gradients
        tolerance_change=1e-14,
        line_search_fn="strong_wolfe",
    )

    def closure() -> float:
        point = function(moving.detach().numpy())
        moving.grad = torch.from_numpy(point.gradient)
        return point.value

    optimizer.step(closure)  # type: ignore[no-untyped-call]
    state = optimizer.state[moving]
    point = function(moving.detach().numpy().copy())
    steps, evaluations = int(state["n_iter"]), int(state["func_evals"])
    limit = steps >= max_steps or evaluations >= 2 * max_steps
    return Minimum(
        point, steps, evaluations, "converged" if point.norm <= tolerance else "step limit" if limit else "stalled"
    )
