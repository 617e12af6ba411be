"""Ordinals, extents and ends that a noun phrase names, measured among the things that the rest of it describes."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.extents import of_extents
from dcg_torch.grounding.first_few import first_few
from dcg_torch.grounding.hypotheses import ModifierFactor
from dcg_torch.grounding.landmark_counts import counted_from_landmark, is_anchored
from dcg_torch.grounding.line_ends import of_line_ends
from dcg_torch.grounding.odd_one_out import odd_one
from dcg_torch.grounding.receding_rows import of_receding_row
from dcg_torch.grounding.row_middles import middle_of_row
from dcg_torch.types import Phrase
from dcg_torch.types.arrays import Bools, Floats


def by_measurement(
    phrase: Phrase,
    told: Collection[str],
    modifiers: Sequence[ModifierFactor],
    described: tuple[Bools, Floats],
    encoder: WorldEncoder,
) -> tuple[Phrase, Floats]:
    """What the words of a noun phrase measure of each thing.

    Args:
        told: words that attributes answer.
        modifiers: of the noun phrase.
        described: (things,) what the rest of the phrase describes, and the log-factor of how well it does.

    Returns:
        The phrase without the words that are taken up, and the log-factor of each thing.
    """
    among, fit = described
    phrase, away = counted_from_landmark(phrase, modifiers, fit, encoder)
    phrase, row = of_receding_row(phrase, described, encoder)
    phrase, few = first_few(phrase, modifiers, described, encoder)
    phrase, extent = of_extents(phrase, told, among, encoder, anchored=is_anchored(modifiers))
    phrase, end = of_line_ends(phrase, among, encoder)
    phrase, middle = middle_of_row(phrase, modifiers, among, encoder)
    phrase, odd = odd_one(phrase, among, encoder)
    return phrase, away + row + few + extent + end + middle + odd


def by_measurement_of_few(
    phrase: Phrase, told: Collection[str], described: tuple[Bools, Floats], encoder: WorldEncoder
) -> tuple[Phrase, Floats]:
    """What is measured for a phrase that says how many it picks from: "the left one of the two on the wall"."""
    phrase, row = of_receding_row(phrase, described, encoder)
    phrase, extent = of_extents(phrase, told, described[0], encoder)
    return phrase, row + extent
