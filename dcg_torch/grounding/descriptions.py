"""What describes a noun phrase's object: its modifiers' factors, and which things its ranks are among."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from dcg_torch.grounding.bearings import by_bearing
from dcg_torch.grounding.colored_groups import of_colors, without_colors
from dcg_torch.grounding.compass import by_compass
from dcg_torch.grounding.contradictions import of_contradictions
from dcg_torch.grounding.counted_sets import counted_set, evenly, shaded, shades_among, without_shades
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.exact_names import compared_by_name
from dcg_torch.grounding.features import picked_from, ranking
from dcg_torch.grounding.features.name_facts import is_ruled_out
from dcg_torch.grounding.floor_support import by_floor_support
from dcg_torch.grounding.group_membership import beside_members, log_of_group, of_members
from dcg_torch.grounding.hypotheses import Beam, Combos, ModifierFactor
from dcg_torch.grounding.isolation import not_alone, of_isolation
from dcg_torch.grounding.joined_sides import by_joined_side
from dcg_torch.grounding.landmarks import APART, spread
from dcg_torch.grounding.measured_relations import means_all, means_several, of_all, of_denied, of_several, surrounded
from dcg_torch.grounding.measurement import by_measurement, by_measurement_of_few
from dcg_torch.grounding.modifiers import counted_landmark, is_in_a_group, ranks_from
from dcg_torch.grounding.nearness import by_nearness, nearer_between
from dcg_torch.grounding.opposite_sides import by_opposite_side
from dcg_torch.grounding.outlines import by_outline
from dcg_torch.grounding.possession import of_possession
from dcg_torch.grounding.side_counts import counted_on_side, deepest_few
from dcg_torch.grounding.size_deviation import size_deviation
from dcg_torch.grounding.stated_distances import MEASURED, log_distance
from dcg_torch.grounding.support_sides import by_support_side
from dcg_torch.grounding.tables import Tables
from dcg_torch.grounding.tiers import of_tier
from dcg_torch.grounding.vertical_relations import by_height
from dcg_torch.interpretation.comparatives import MORE_THAN, log_more
from dcg_torch.interpretation.plain_words import in_group
from dcg_torch.interpretation.sameness import LIKE, log_same
from dcg_torch.names.attribute_values import says_size, size_side
from dcg_torch.names.attributes import attribute_evidence
from dcg_torch.names.colors import comparing_words
from dcg_torch.names.keys import OF_KEY
from dcg_torch.names.relations import listed
from dcg_torch.names.vocabulary import CELL, GROUP_WORDS, TIER, TOGETHER, counted
from dcg_torch.types import NOT, Correspondence, ParseTree, Phrase, PhraseKind
from dcg_torch.types.arrays import Bools, Floats

_IN_THE_SET = math.log(0.5)
_GROUP_IN_THE_SET = math.log(0.1)
"""The same of groups: a stack of four is less usual than one of three, and may be the tallest."""
_BEHIND = 6.0
"""A thing is compared that is described at least half as well as the best, and not by so many nats less."""

_NEAR = 4.4
"""The same of what its name and its colour alone say: brown is near orange, and no orange."""

_SIZED = 5.0
"""Nats that the smallest of some loses where it is called large."""
_OFF = 0.5
"""How far from the size that is said a thing may be to be compared."""
_COMBINATIONS = 1728
"""Combinations of more than two landmarks that are weighed: all of three beams of twelve."""
_SURROUNDED = "surrounded by"
_LANDMARKS = 8
"""Landmarks that are weighed where several are meant together."""


def modifier_factor(
    tree: ParseTree, beams: Sequence[Beam], encoder: WorldEncoder, tables: Tables, compared: Bools | None = None
) -> ModifierFactor:
    """The factor of a modifier, from its log Psi under every choice of landmarks.

    Args:
        beams: the hypotheses of each landmark.
        compared: (things,) those among which it ranks; None: all of a kind.
    """
    around = tree.phrase.words[0] == _SURROUNDED and tree.children[0].phrase.plural and NOT not in tree.phrase.words
    several, combos = 0 if around else counted_landmark(tree), Combos(beams, _fewer(beams))
    log_psi = _log_psi(tree, combos.things, encoder, tables, compared)
    first = [of[0] for of in combos.things]
    having = of_possession(tree, log_psi, first, combos.log_scores, several, encoder) if len(beams) == 1 else None
    log_psi = log_psi if having is None else having
    if of_each := several > 0 and len(combos) >= several:
        chosen = list(itertools.combinations(range(min(len(combos), _LANDMARKS)), several))
        combos = Combos([beams[0]] * several, chosen)
        log_psi = of_several(tree.phrase, log_psi, first, chosen, encoder)
    landmarks, scores = combos.things, combos.log_scores
    if len(beams) == 1 and not of_each and having is None:
        name = tree.phrase.words[0]
        if around:
            log_psi = surrounded(tree.children[0].phrase, first, log_psi, scores, encoder)
        far = of_denied(name, log_psi, first, scores, encoder, denied=NOT in tree.phrase.words)
        if far is not None:
            log_psi = far
        elif not means_all(tree.phrase):
            log_psi = by_nearness(name, log_psi, first, scores, compared, encoder)
    log_psi = nearer_between(tree.phrase, log_psi, landmarks, scores, compared, encoder)
    if of_each or (len(beams) > 1 and tree.phrase.words[0] not in MEASURED):
        scores = scores - APART * spread(np.array(landmarks), encoder.layout.position[:, :2])
    share = scores - np.logaddexp.reduce(scores)
    return ModifierFactor(tree, combos, log_psi + share[:, None], share, compared, of_each)


def _log_psi(
    tree: ParseTree, landmarks: Sequence[tuple[int, ...]], encoder: WorldEncoder, tables: Tables, compared: Bools | None
) -> Floats:
    """(landmarks, things) log Psi of a modifier, and what is measured of it."""
    name, denied = tree.phrase.words[0], NOT in tree.phrase.words
    if is_in_a_group(tree) and not encoder.layout.members:
        return np.zeros((len(landmarks), len(encoder.all)))  # "in the row" tells nothing where no row is seen
    if name in LIKE:
        return log_same(name, encoder.all, landmarks, denied=denied)
    if name in MORE_THAN:
        return log_more(name, encoder.all, landmarks, denied=denied, viewer=encoder.world.robot)
    if name in MEASURED:
        return log_distance(tree.phrase, landmarks, encoder, denied=denied)
    table = tables.placed(encoder, tree.phrase, landmarks, compared)
    asserted = Correspondence.INACTIVE if denied else Correspondence.ACTIVE
    log_psi: Floats = table[tables.factor.correspondences.index(asserted)]
    if denied:
        return log_psi
    log_psi = by_outline(name, by_floor_support(name, log_psi, landmarks, encoder), landmarks, encoder)
    log_psi = by_support_side(tree.phrase, log_psi, landmarks, encoder)
    log_psi = by_height(name, log_psi, landmarks, encoder, whole=means_several(tree.phrase))
    log_psi = beside_members(name, by_opposite_side(name, log_psi, landmarks, encoder), landmarks, encoder)
    log_psi = deepest_few(tree, of_all(tree.phrase, log_psi, landmarks, encoder), encoder)
    first = [of[0] for of in landmarks]
    log_psi = by_joined_side(tree, log_psi, first, encoder)
    log_psi = by_bearing(tree.phrase, log_psi, first, compared, encoder)
    log_psi = by_compass(tree, log_psi, first, compared, encoder)
    if name not in _MEMBER:
        return log_psi
    return of_members(log_psi, first, encoder, row=counted(tree.children[0].phrase.words) is not None)


def _fewer(beams: Sequence[Beam]) -> Sequence[tuple[int, ...]] | None:
    """Places in beams that are cut so that combinations stay few: "between the bed and the desk and ..."; None: all."""
    if len(beams) <= 2:
        return None
    most = int(_COMBINATIONS ** (1.0 / len(beams)) + 1e-9)
    return list(itertools.product(*[range(min(len(beam), max(1, most))) for beam in beams]))


_MEMBER = listed("one of a group")


@dataclass(frozen=True)
class Comparison:
    """What a noun phrase picks from.

    Attributes:
        among: (things,) what it describes apart from its ranks: as well as half of what it describes best. Or as many
            as it says that there are: "the middle one of the five on the left".
        log_size: (things,) log-factor of the size that it says, of what contradicts a thing more than once, and of
            standing close together.
        phrase: the phrase without the words that `log_size` has taken up.
    """

    among: Bools
    log_size: Floats
    phrase: Phrase


def comparison_set(
    tree: ParseTree, modifiers: Sequence[ModifierFactor], encoder: WorldEncoder, tables: Tables
) -> Comparison:
    """What the words of a noun phrase compare with: what all the rest of it describes.

    Words for a size ("the upper large one") describe by degrees: how far is a thing from the largest, or the smallest?
    They compare with all of the phrase's name where places leave one size alone ("the large one at the top"), or sizes
    that differ by little beside those of all of its kind ("the tiny black specks").
    """
    phrase = without_colors(tree.phrase)
    close = counted(phrase.words, TOGETHER)
    several = close or picked_from(phrase)
    shades = comparing_words(phrase.look) if several else ()  # they compare those, not all in view
    told = of_attributes(phrase.words, encoder)
    fit, odds = _fit_of(_that_describes(phrase, told, shades), encoder, tables)
    named, own = _described(fit, odds), odds
    for modifier in modifiers:
        fit, odds = fit + modifier.log_psi, odds + modifier.log_psi
    phrase, tier = of_tier(phrase, named, modifiers, encoder)
    again = of_contradictions(told, encoder) + of_colors(tree.phrase, encoder, tables) + tier
    again += of_isolation(phrase.words, encoder)
    phrase, log_size, denied = _sized(phrase, told, (fit + again, odds + again), named, encoder, tables)
    denied = denied + _ruled_out(phrase, encoder)
    log_size, fit, odds = log_size + again, fit + again + denied, odds + again + denied
    of_color = own >= own.max() - _NEAR if phrase.color is not None else np.isfinite(own)
    counts = np.where(of_color, own if close else fit + log_size, -np.inf)
    among = counted_set(several, counts, fit, modifiers, encoder, bool(close)) if several else None
    if among is not None:
        phrase, log_extent = by_measurement_of_few(phrase, told, (among[0], fit), encoder)
        phrase = without_shades(phrase, shades)
        log_size = log_size + shades_among(shades, among[0], encoder) + log_extent + evenly(tree, among[0], modifiers)
        return Comparison(among[0], log_size + among[1], phrase)
    log_size = log_size + log_of_group(phrase, encoder)
    groups = phrase.noun in GROUP_WORDS or (phrase.plural and in_group(phrase))
    described = compared_by_name(
        phrase, _described(fit, odds, _GROUP_IN_THE_SET if groups else _IN_THE_SET), own, encoder
    )
    described = counted_on_side(phrase, modifiers, fit, described, encoder)
    if phrase.color is not None:
        described &= own >= own[described].max(initial=-np.inf) - _NEAR
    phrase, log_shade = shaded(tree.phrase, phrase, described, encoder)
    phrase, log_measure = by_measurement(phrase, told, modifiers, (described, fit), encoder)
    return Comparison(described, log_size + log_shade + log_measure, phrase)


def _that_describes(phrase: Phrase, told: Sequence[str], shades: Sequence[str]) -> Phrase:
    """A noun phrase of the words alone that describe by themselves: neither sizes nor shades, which compare."""
    words = tuple(word for word in told if not says_size(word))
    look = tuple(word for word in phrase.look if word not in shades)
    return phrase if (words, look) == (phrase.words, phrase.look) else replace(phrase, words=words, look=look)


def _fit_of(phrase: Phrase, encoder: WorldEncoder, tables: Tables) -> tuple[Floats, Floats]:
    """(things,) log Psi of what a noun phrase says, -inf of what is not perceived; and its log-odds against nothing."""
    table, number = tables.unranked(encoder, phrase), tables.factor.correspondences.index
    fit: Floats = np.where(encoder.perceived, table[number(Correspondence.ACTIVE)], -np.inf)
    return fit, fit - table[number(Correspondence.INACTIVE)]


def _sized(
    phrase: Phrase,
    told: Sequence[str],
    described: tuple[Floats, Floats],
    named: Bools,
    encoder: WorldEncoder,
    tables: Tables,
) -> tuple[Phrase, Floats, Floats]:
    """What the sizes say that a phrase states or denies.

    Returns:
        The phrase without the sizes that are taken up, the log-factor of each thing, and what takes things of other
        sizes out of those that are compared.
    """
    log_size, out = np.zeros(len(named)), np.zeros(len(named))
    sizes = {word: side for word in phrase.words if word not in told and (side := size_side(word)) is not None}
    denied = _denied_sizes(phrase.words)
    kind = of_kind(phrase, encoder, tables) if sizes or denied else named
    off = size_deviation(tuple(sizes.values()), encoder, _described(*described), named, kind) if sizes else None
    if off is not None:
        phrase = replace(phrase, words=tuple(w for w in phrase.words if w not in sizes))
        log_size, out = -_SIZED * off**2, np.where(off > _OFF, -_BEHIND - 1.0, 0.0)
    for side in denied:
        off = size_deviation((side,), encoder, named, kind)
        if off is not None:
            log_size = log_size - _SIZED * (1.0 - off) ** 2
            out = np.where(off < _OFF, -_BEHIND - 1.0, out)
    return phrase, log_size, out


def _ruled_out(phrase: Phrase, encoder: WorldEncoder) -> Floats:
    """(things,) what takes things out of those that are compared that "not red" rules out, another shelf or column."""
    alone, tiers = not_alone(phrase.words, encoder), {word for word in phrase.words if word.startswith(TIER)}
    cells = [{f"{CELL}{cell}" for cell in w.removeprefix(CELL).split("|")} for w in phrase.words if w.startswith(CELL)]
    if not (tiers or cells or alone.any()) and not any(word.startswith(f"{NOT} ") for word in phrase.words):
        return np.zeros(len(encoder.all))
    elsewhere = [not tiers <= o.attributes or any(map(o.attributes.isdisjoint, cells)) for o in encoder.all]
    out = alone | elsewhere | [is_ruled_out(phrase.words, o, named=True) for o in encoder.all]
    return np.where(out, -_BEHIND - 1.0, 0.0)


def _denied_sizes(words: Sequence[str]) -> list[int]:
    """The sizes that words such as "not small" rule out."""
    sides = (size_side(word.removeprefix(f"{NOT} ")) for word in words if word.startswith(f"{NOT} "))
    return [side for side in sides if side is not None]


def of_kind(phrase: Phrase, encoder: WorldEncoder, tables: Tables) -> Bools:
    """(things,) those that the noun of a phrase names."""
    table = tables.unranked(encoder, replace(phrase, color=None, look=(), words=()))
    number = tables.factor.correspondences.index
    fit: Floats = np.where(encoder.perceived, table[number(Correspondence.ACTIVE)], -np.inf)
    return _described(fit, fit - table[number(Correspondence.INACTIVE)])


def of_some_named(phrase: Phrase, encoder: WorldEncoder, tables: Tables) -> Bools | None:
    """(things,) those that a noun names, where they are of several classes ("the vehicle closest to the gate"), or
    without those that other words deny ("the cup on the left that is not red"); else None."""
    if phrase.noun is None:
        return None
    named = of_kind(phrase, encoder, tables)
    left: Bools = named & (_ruled_out(phrase, encoder) == 0.0)
    if left.any() and (left != named).any():
        return left
    types = encoder.type_number[named]
    return named if (types != types[:1]).any() else None


def is_narrowed(phrase: Phrase, encoder: WorldEncoder) -> bool:
    """Does a noun phrase say more than a name of what is ranked from a landmark: "the red one closest to the door"?"""
    looks = phrase.color is not None or bool(phrase.look)
    sized = any(size_side(word) is not None for word in phrase.words)
    return looks or sized or bool(of_attributes(phrase.words, encoder))


def _described(fit: Floats, odds: Floats, least: float = _IN_THE_SET) -> Bools:
    described: Bools = (fit >= fit.max() + least) & (odds >= odds.max() - _BEHIND)
    return described


def of_attributes(words: Sequence[str], encoder: WorldEncoder) -> tuple[str, ...]:
    """Those of a noun phrase's words that say something of an attribute: "the biggest metal cube"."""
    told = {word: set(attribute_evidence((word,), encoder.given)) for word in words}
    return tuple(w for w in words if told[w] - {"attribute: silent"} or OF_KEY in w or w.startswith(f"{NOT} "))


def ranks(tree: ParseTree) -> bool:
    """Is it a noun phrase with words that may rank, or one of several that a modifier ranks?"""
    if tree.phrase.kind is not PhraseKind.NOUN:
        return False
    several = tree.phrase.plural and (tree.phrase.count or 1) > 1
    return ranking(tree.phrase) is not None or (several and any(map(ranks_from, tree.children)))
