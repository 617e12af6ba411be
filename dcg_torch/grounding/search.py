"""Leaf-to-root inference over the trees of one command in one world; `graph` says what is sought."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from dcg_torch.grounding.absence import judges_absence, less_for_many_types, log_odds_of_absence
from dcg_torch.grounding.contradictions import of_missing_marks
from dcg_torch.grounding.decision import instead_of, rather_near
from dcg_torch.grounding.descriptions import (
    comparison_set,
    is_narrowed,
    modifier_factor,
    of_attributes,
    of_some_named,
    ranks,
)
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.features import GROUNDING_OF
from dcg_torch.grounding.hypotheses import NOTHING_BELOW, Beam, Combos, Hypothesis, ModifierFactor
from dcg_torch.grounding.joined_sides import joined
from dcg_torch.grounding.landmarks import landmarks_of, only_named, without_landmarks
from dcg_torch.grounding.measured_relations import ranked_among
from dcg_torch.grounding.modifiers import is_in_a_group, is_to_a_place, picks_a_side, ranks_from, tells_which_few
from dcg_torch.grounding.patterns import Spread
from dcg_torch.grounding.phrase_scores import FEW, Scored
from dcg_torch.grounding.solution import Solution, target_of
from dcg_torch.grounding.tables import Tables
from dcg_torch.grounding.thing_values import ByThing
from dcg_torch.interpretation.plain_words import in_group
from dcg_torch.names.vocabulary import counted
from dcg_torch.types import Correspondence, ParseTree, Phrase, PhraseKind
from dcg_torch.types.arrays import Bools, Floats

_NOT_THIS = 50.0
"""Nats that take a hypothetical object out."""


@dataclass
class _Found:
    """What was found of a phrase: its scores, and its best hypotheses once they have been asked for."""

    scored: Scored
    beam: Beam | None = None


class Search:
    """Leaf-to-root inference in one world. What several trees have in common is scored once.

    Args:
        encoder: of the world.
        tables: of the phrases.
        beam: hypotheses of a phrase that its parent considers.
    """

    def __init__(self, encoder: WorldEncoder, tables: Tables, beam: int) -> None:
        self.encoder = encoder
        self._tables = tables
        self._beam = beam
        self._meanable = len(encoder.world.objects) + len(encoder.world.groups)
        self._found: dict[tuple[ParseTree, bool], _Found] = {}
        self._modifiers: dict[tuple[ParseTree, bytes | None], ModifierFactor] = {}
        self._absence: dict[Phrase, float | None] = {}
        self._nouns: dict[Phrase, Floats] = {}

    def solve(self, tree: ParseTree, *, brief: bool = False) -> Solution:
        """The best configuration, and the probabilities of all that it may be about.

        Args:
            brief: leave out the runner-up.
        """
        world = self.encoder.world
        if not world.objects:
            return Solution(tree, world, problem="there is nothing here to mean")
        root = self._picked(tree, landmark=False)
        number, totals = self.encoder.number, root.totals()[: self._meanable]
        found = target_of(tree)
        totals = rather_near(totals, found, self.encoder)
        best = self._best(root, 1)[0]
        id_ = instead_of(best.meant, totals, self.encoder, several=found is not None and found.phrase.plural)
        best = best if id_ == best.meant.id else self._best_about(id_, root) or best
        noun = None if found is None else self._picked(found, landmark=False)
        fits = None if noun is None or noun.log_fit is None else np.exp(noun.log_fit)
        odds = (
            None
            if noun is None or noun.log_odds is None
            else np.exp(np.minimum(np.maximum(noun.log_odds, -700.0), 700.0))
        )
        return Solution(
            tree,
            world,
            best,
            ByThing(number, np.exp(totals - np.logaddexp.reduce(totals))),
            {} if fits is None else ByThing(number, fits),
            {} if odds is None else ByThing(number, odds),
            None if brief else self.runner_up(tree, best),
            () if noun is None else tuple(noun.modifiers),
            None if noun is None else noun.compared,
            1.0 if noun is None else self._named(noun),
        )

    def _named(self, noun: Scored) -> float:
        """How well the noun phrase names what it names best of all that is there."""
        if noun.named is None:
            return 0.0
        seen = noun.named[: len(noun.scores[0])][self.encoder.perceived[: len(noun.scores[0])]]
        return float(np.exp(seen.max())) if len(seen) else 0.0

    def runner_up(self, tree: ParseTree, best: Hypothesis) -> Hypothesis | None:
        """The best configuration of a tree about another object than that of the best; None if there is none."""
        root = self._picked(tree, landmark=False)
        scores = np.where(root.about(best.meant.id, self.encoder.number), -np.inf, root.scores)
        found = self._best(root, 1, scores)[0]
        return found if math.isfinite(found.log_score) else None

    def _best_about(self, id_: str, root: Scored) -> Hypothesis | None:
        """The best configuration about a thing; None if there is none."""
        scores = np.where(root.about(id_, self.encoder.number), root.scores, -np.inf)
        found = self._best(root, 1, scores)[0]
        return found if math.isfinite(found.log_score) else None

    def _picked(self, tree: ParseTree, *, landmark: bool) -> Scored:
        """The scores of a phrase that picks one grounding.

        Args:
            landmark: is it one of a modifier? It alone may be a place: what a command is about is an object.
        """
        return self._found_of(tree, landmark).scored

    def _beam_of(self, tree: ParseTree, *, landmark: bool) -> Beam:
        found = self._found_of(tree, landmark)
        if found.beam is None:
            wide = judges_absence(self.encoder)
            found.beam = self._best(found.scored, found.scored.worth_keeping(self._beam) if wide else self._beam)
        return found.beam

    def _found_of(self, tree: ParseTree, landmark: bool) -> _Found:
        key = (tree, landmark)
        kept = self._found.get(key)
        if kept is not None:
            return kept
        below = [c for c in tree.children if c.phrase.kind is not PhraseKind.MODIFIER]
        combos = Combos([self._beam_of(child, landmark=False) for child in below]) if below else NOTHING_BELOW
        is_noun = tree.phrase.kind is PhraseKind.NOUN
        scored = self._noun(tree, combos) if is_noun else self._above(tree, combos)
        if landmark:
            scored = only_named(tree, scored, self.encoder) if is_noun else scored
        else:
            scored = self._only_objects(tree, scored)
            scored = self._or_absent(tree, scored) if is_noun else scored
        kept = self._found[key] = _Found(scored)
        return kept

    def _modifier(self, tree: ParseTree, compared: Bools | None = None) -> ModifierFactor:
        """The factor of a modifier; what it ranks, it ranks among `compared`."""
        key = (tree, None if compared is None else compared.tobytes())
        found = self._modifiers.get(key)
        if found is None:
            beams = [self._beam_of(child, landmark=True) for child in tree.children]
            found = self._modifiers[key] = modifier_factor(tree, beams, self.encoder, self._tables, compared)
        return found

    def _all_modifiers(self, tree: ParseTree) -> list[ModifierFactor]:
        """Of a noun phrase. "The closest to you" on the left is one of those that are on the left."""
        several = counted(tree.phrase.words) is not None
        told = tells_which_few(tree) if several else []
        few = {of.children: of for of in told}
        own = [
            few.get(c.children, joined(tree, ranked_among(tree, c)))
            for c in tree.children
            if c.phrase.kind is PhraseKind.MODIFIER
        ]
        if not own:
            return []
        faced, named = self._beside_what_is_faced(tree), of_some_named(tree.phrase, self.encoder, self._tables)
        # "The red shape by the box" is nearer to it than other red ones.
        if named is not None and tree.phrase.color is not None:
            named = comparison_set(tree, (), self.encoder, self._tables).among
        kind = named if faced is None else faced
        picks = [c for c in own if c not in told and (ranks_from(c) or (several and picks_a_side(c)))]
        others = {id(c): self._modifier(c, kind) for c in own if c not in picks}
        sized = self.encoder.layout.bodies is not None
        parts = [others[id(c)] for c in own if id(c) in others and (is_to_a_place(c, sized=sized) or is_in_a_group(c))]
        narrowed = is_narrowed(tree.phrase, self.encoder) or named is not None
        some = len(others) < len(own) and (several or bool(parts) or narrowed)
        compared = comparison_set(tree, parts, self.encoder, self._tables).among if some else None
        return [others[id(c)] if id(c) in others else self._modifier(c, compared) for c in own]

    def _beside_what_is_faced(self, tree: ParseTree) -> Bools | None:
        """(things,) those of a noun phrase's kind that may be meant by who faces what they are beside; else None."""
        world = self.encoder.world
        if world.meant is None or world.viewer is None:
            return None
        named = comparison_set(tree, (), self.encoder, self._tables).among
        found: Bools = named & np.array([o.id in world.meant for o in self.encoder.all], dtype=np.bool_)
        return found if found.any() else None

    def _noun(self, tree: ParseTree, combos: Combos) -> Scored:
        """Of a noun phrase: the opposite of an object is no object, so that it is ACTIVE or not."""
        modifiers = self._all_modifiers(tree)
        picks = comparison_set(tree, modifiers, self.encoder, self._tables) if ranks(tree) else None
        compared, phrase = (None, tree.phrase) if picks is None else (picks.among, picks.phrase)
        table = self._unranked(phrase) if compared is None else self._tables.noun(self.encoder, phrase, compared)
        correspondences = self._tables.factor.correspondences
        inactive, active = (table[correspondences.index(c)] for c in (Correspondence.INACTIVE, Correspondence.ACTIVE))
        # Summed exactly, so that the order of the objects changes no bit and equal things keep equal scores.
        base = (math.fsum(inactive.tolist()) + combos.log_scores)[:, None]
        placed: Floats | float = 0.0
        further = (None if picks is None else picks.log_size, of_missing_marks(phrase.words, self.encoder))
        for own in (*further, *[modifier.log_psi for modifier in modifiers]):
            if own is not None:
                base, placed = base + own, placed + own
        return Scored(
            tree,
            combos,
            [Correspondence.ACTIVE],
            (base + active - inactive)[:, :, None],
            None,
            modifiers,
            active - inactive + placed,
            active + placed,
            active,
            compared,
        )

    def _unranked(self, phrase: Phrase) -> Floats:
        """(P, things) of a noun phrase that ranks among nothing less than all: several readings have it in common."""
        found = self._nouns.get(phrase)
        if found is None:
            found = self._nouns[phrase] = self._tables.noun(self.encoder, phrase)
        return found

    def _above(self, tree: ParseTree, combos: Combos) -> Scored:
        """Of a verb or preposition: all groundings but those of its children are alike."""
        meant = [c for c in self._tables.factor.correspondences if c is not Correspondence.INACTIVE]
        n, base = self._meanable, combos.log_scores
        spread = Spread(self._tables, tree.phrase, GROUNDING_OF[tree.phrase.kind], n)
        scores = np.empty((len(combos), n, len(meant)))
        if len(combos.beams) == 1:  # as nearly all have
            cells = spread.of_one(combos.beams[0]) + base[:, None, None]
            scores[:] = cells[:, :1]
            scores[range(len(combos)), combos.beams[0].things] = cells[:, 1]
        else:
            for own, combo, things, total in zip(scores, combos, combos.things, base.tolist(), strict=True):
                cells = spread.of([h.child for h in combo], things) + total
                own[:] = cells[0]
                own[list(dict.fromkeys(things))] = cells[1:]
        if n <= FEW:
            return Scored(tree, combos, meant, scores)
        code = np.zeros(n, dtype=np.int64)
        some = [j for things in combos.things for j in things]
        code[some] = np.array(some) + 1
        return Scored(tree, combos, meant, scores, code)

    def _only_objects(self, tree: ParseTree, found: Scored) -> Scored:
        """Without places, objects that the speaker has ruled out, and groups of which a phrase does not speak."""
        world = self.encoder.world
        if world.meant is None and not world.groups and not world.places:
            return found
        meanable = self._meanable
        if world.meant is None and not world.groups and found.scores.shape[1] == meanable:
            return found
        scores = found.scores[:, :meanable]
        odds, fit = (None if v is None else v[:meanable] for v in (found.log_odds, found.log_fit))
        code, noun = found.code, target_of(tree)
        things = noun is not None and not in_group(noun.phrase)
        number = noun.phrase.count if noun is not None and noun.phrase.plural else None
        if world.meant is not None or (things and world.groups):
            out = np.zeros(meanable, dtype=np.bool_)
            out[len(world.objects) :] = [things and number != len(group.members) for group in world.groups]
            if world.meant is not None:
                out |= [o.id not in world.meant for o in world.meanable]
            scores = np.where(out[None, :, None], -np.inf, scores)
            odds, fit = (None if v is None else np.where(out, -np.inf, v) for v in (odds, fit))
            code = None
        return found._replace(scores=scores, log_odds=odds, log_fit=fit, code=code)

    def _or_absent(self, tree: ParseTree, found: Scored) -> Scored:
        """With as much for what is not there as `absence` says, where it says something."""
        if not judges_absence(self.encoder):
            return found
        log_odds = self._log_odds_of_absence(tree.phrase)
        doubted = landmarks_of(tree) if log_odds is not None else ()
        if log_odds is not None and doubted:
            odds = [self._log_odds_of_absence(landmark) for landmark in doubted]
            log_odds = without_landmarks(log_odds, [o for o in odds if o is not None], found, self.encoder)
        there = self.encoder.perceived[: found.scores.shape[1]]
        if log_odds is None:
            shift = np.where(there, 0.0, less_for_many_types(self.encoder))
        else:  # what is not there is one thing, whatever its type is
            totals = np.logaddexp.reduce(found.scores, axis=(0, 2))
            one = np.where(there, -np.inf, totals).argmax()
            shift = np.where(there, 0.0, -_NOT_THIS)
            shift[one] = log_odds + np.logaddexp.reduce(totals[there]) - totals[one]
        if not shift.any() or not np.isfinite(shift).all():
            return found
        return found._replace(scores=found.scores + shift[:, None])

    def _log_odds_of_absence(self, phrase: Phrase) -> float | None:
        bare = replace(phrase, text="", words=self._told(phrase), context=(), among=None)
        if bare not in self._absence:
            self._absence[bare] = log_odds_of_absence(self._tables, self.encoder, bare)
        return self._absence[bare]

    def _told(self, phrase: Phrase) -> tuple[str, ...]:
        """The words of a noun phrase that say something of groups or attributes."""
        return phrase.words if in_group(phrase) else of_attributes(phrase.words, self.encoder)

    def _best(self, scored: Scored, beam: int, scores: Floats | None = None) -> Beam:
        """The best configurations of a phrase; see `Scored.highest`."""
        tree, kind = scored.tree, GROUNDING_OF[scored.tree.phrase.kind]
        highest = scored.highest(beam, scores)
        return Beam(tree, kind, self.encoder.all, scored.combos, scored.modifiers, highest)
