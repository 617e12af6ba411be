"""The scores of a phrase that picks one grounding: values of a search."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from dcg_torch.grounding.hypotheses import Combos, Highest, ModifierFactor
from dcg_torch.scene.order import highest
from dcg_torch.types import Correspondence, ParseTree, PhraseKind
from dcg_torch.types.arrays import Bools, Floats, Ints

FEW = 256
"""Things up to which it does not pay to look for those whose scores are equal."""
_WELL, _WIDER = math.log(0.05), 4
"""Log of the share of the likeliest one's probability from which others are kept beyond the beam, and up to how many
beams."""


class Scored(NamedTuple):
    """The scores of a phrase that picks.

    Attributes:
        combos: the choices of hypotheses of the children.
        meant: the correspondences that are not INACTIVE.
        scores: (combos, groundings, meant) log-score of every configuration.
        code: (groundings,) equal numbers for groundings whose scores are equal, whatever the combo; None: unknown.
        modifiers: of a noun phrase; what follows is of use for one alone.
        log_odds: (groundings,) of ACTIVE against INACTIVE, modifiers included.
        log_fit: (groundings,) log Psi(ACTIVE) by itself, modifiers included.
        named: (groundings,) log Psi(ACTIVE) without the modifiers.
        compared: (things,) those among which the phrase ranks; None where it does not.
    """

    tree: ParseTree
    combos: Combos
    meant: Sequence[Correspondence]
    scores: Floats
    code: Ints | None = None
    modifiers: Sequence[ModifierFactor] = ()
    log_odds: Floats | None = None
    log_fit: Floats | None = None
    named: Floats | None = None
    compared: Bools | None = None

    def totals(self) -> Floats:
        """(groundings,) the log-sum over all configurations about each grounding."""
        if self.code is None or len(self.code) <= FEW:
            found: Floats = np.logaddexp.reduce(self.scores, axis=(0, 2))
            return found
        _, first, which = np.unique(self.code, return_index=True, return_inverse=True)
        few: Floats = np.logaddexp.reduce(self.scores[:, first], axis=(0, 2))
        return few[which]

    def highest(self, count: int, scores: Floats | None = None) -> Highest:
        """The best configurations; equal scores stay in the order of the world's objects.

        Args:
            scores: others than its own, which differ from them for whole combos, if there are any.
        """
        scores = self.scores if scores is None else scores
        columns = None
        if self.code is not None and len(self.code) > FEW and self.combos.beams:
            # Of those whose scores are equal none but the first few can be among the best.
            rest = (self.code == 0).nonzero()[0][:count]
            columns = np.sort(np.concatenate([rest, self.code.nonzero()[0]]))
            scores = scores[:, columns]
        _, n, m = scores.shape
        flat = scores.reshape(-1)
        best = highest(flat, count)
        at = best.tolist()
        things = [k // m % n for k in at]
        if columns is not None:
            things = columns[things].tolist()
        return Highest([k // (m * n) for k in at], things, [self.meant[k % m] for k in at], flat[best].tolist())

    def worth_keeping(self, beam: int) -> int:
        """How many configurations are kept where more than a beam may well be meant; of very many things a beam."""
        if not beam < self.scores.shape[1] <= FEW:
            return beam
        likely = int((self.scores >= self.scores.max() + _WELL).sum())
        return max(beam, min(likely, _WIDER * beam))

    def about(self, meant: str, number: Mapping[str, int]) -> Bools:
        """(combos, groundings, 1) or what broadcasts to it: which configurations are about an object.

        Args:
            number: of every thing by its id.
        """
        if self.tree.phrase.kind is PhraseKind.NOUN or not self.combos.beams:
            found: Bools = np.arange(self.scores.shape[1])[None, :, None] == number[meant]
        else:
            first = self.combos.beams[0].meant
            found = np.array([first[pick[0]] == number[meant] for pick in self.combos.picks])[:, None, None]
        return found
