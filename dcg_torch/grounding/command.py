"""[phi*, gamma*] of a command: a sum over its readings, and over the frames of reference in which it may be said."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from dcg_torch.grounding.frames import faced, views
from dcg_torch.grounding.readings import SharedSearch, sum_over_frames, told_where, worth_grounding
from dcg_torch.grounding.solution import Solution
from dcg_torch.grounding.speakers import about_the_speaker
from dcg_torch.interpretation.parser_protocol import ReadCommand
from dcg_torch.types import WorldModel


def ground_command(
    command: ReadCommand,
    world: WorldModel,
    search_in: Callable[[WorldModel], SharedSearch],
    learned: Mapping[str, float],
    speakers: float | None,
    *,
    related: bool,
) -> Solution:
    """What a command means in a world.

    Args:
        command: what a parser made of it.
        search_in: the search in a world, as a viewer sees it.
        learned: log-weights of the choices between readings.
        speakers: the share of commands that are said as the speaker sees things; None: not known.
        related: are there relations, and with them frames of reference and several readings? Else the first counts.
    """
    if related:
        command, world = about_the_speaker(command, world)
    if not command.readings:
        return Solution(None, world, problem=command.problem)
    readings = worth_grounding(command, world, learned)
    world = told_where(world, readings)
    search = search_in(world)
    facing = faced(readings[0].tree, world, search.ground) if speakers is not None else None
    seen = views(command.text, world, speakers) if facing is None else [(facing, 0.0)]
    searches = [(search if view is world else search_in(view), log_probability) for view, log_probability in seen]
    return sum_over_frames(searches, readings if related else readings[:1])
