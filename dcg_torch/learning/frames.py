"""Whose left and right lessons mean: the frame of reference of each, which none of them states."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from dcg_torch.grounding.frames import from_the_other_side
from dcg_torch.grounding.solution import Solution
from dcg_torch.interpretation.factor_tree import speaks_of
from dcg_torch.learning.census import FrameCounts
from dcg_torch.learning.landmarks import Part
from dcg_torch.scene.frames import seen_by_speaker
from dcg_torch.scene.workspace import with_all
from dcg_torch.types import ParseTree, WorldModel


def in_likelier_frames(
    parts: Sequence[Part], solve: Callable[[ParseTree, WorldModel], Solution], counts: FrameCounts | None
) -> tuple[list[Part], FrameCounts | None]:
    """Lessons, each in the frame of reference in which it means its objects likelier, and what that tells of speakers.

    Args:
        solve: grounds a tree of factors in a world, as far as is known before the lessons.
        counts: of the frames before; None: there is one alone.
    """
    if counts is None:
        return list(parts), None
    found = []
    for part in parts:
        other = seen_by_speaker(part.world)
        if other is None:
            found.append(part)
            continue
        other = with_all(other, speaks_of(part.noun))
        across = replace(part, noun=from_the_other_side(part.noun), world=other)
        robots, speakers = (_meant(one, solve(one.noun, one.world)) for one in (part, across))
        share = counts.speakers * speakers / (counts.speakers * speakers + (1.0 - counts.speakers) * robots)
        counts = counts.count(share)
        found.append(across if share > 0.5 else part)
    return found, counts


def _meant(part: Part, solution: Solution) -> float:
    """The probability of what a lesson means; of several things the sum."""
    return max(1e-9, sum(solution.probabilities.get(i, 0.0) for i in part.targets))
