"""Is what a noun phrase means there at all? The log-odds that it is not, once all has been seen.

A thing that is not there would have just the name and the colour that were said. So each thing that is there is
compared with one of which both are true: how far do its log-odds of the noun, and those of the colour, stay behind? The
thing that stays behind least decides. Where it stands among others and to landmarks says nothing here: people are less
exact about places than about names, and of a thing that is not there nobody knows the place.

    log-odds(not there) = rare + min over things ( strange(noun's gap) + odd(colour's gap) + contrary )

What exceeds 0 of it counts less.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dcg_torch.english.dictionary import english
from dcg_torch.grounding.contradictions import contradicted
from dcg_torch.grounding.encoding import WorldEncoder
from dcg_torch.grounding.features import Group
from dcg_torch.grounding.tables import Tables
from dcg_torch.interpretation.plain_words import in_group
from dcg_torch.names.evidence import evidence, is_generic, may_be_meant_for, unheard_of
from dcg_torch.names.palette import lab, region
from dcg_torch.names.vocabulary import PLACE_WORDS
from dcg_torch.names.weights import names_one_of
from dcg_torch.types import LOOKED_ROUND, OPAQUE, Object, Phrase, PhraseKind
from dcg_torch.types.arrays import Floats

_RARE = -5.0
"""Log-odds that a command means what is not there, where something has the name and the colour that it says."""
_DOUBT = 0.2
"""Of what is likelier absent than there so much counts: people call what is there by odd names about as often as they
speak of what is not there."""
_STRANGE = (5.3, 2.5)
"""From where on a noun's gap counts, and how much each nat: below lies what people call a thing that they know well."""
_SLIP = 8.0
"""Bound of what a noun says: now and then a person says quite another word than the thing has."""
_ODD = (2.5, 1.6)
"""The same of the colour's: a colour has neighbours that people take for it."""
_UNLIKE = (3.0, 1.6)
"""The same of how untypical of the colour word a colour looks that no name is given of."""
_CONTRARY = (5.0, 1.5)
"""Of the first word that an attribute of the thing contradicts, "with a hat" said of who wears none, and of each other:
who has misjudged one thing may have misjudged two."""
_NEW = 6.3
"""Bound of a noun's gap where the noun is a word that nobody knows: it may be a new name of what is there."""
_OF_KIND = {"kind: class is kind": 6.6, "kind: class is far kind": 7.1}
"""Bounds of a noun's gap where the noun names a kind of which the thing is one. People seldom say "the container" of a
bottle, but who says it may mean the bottle that is there."""
_LETTER = 7.0
"""The same where the noun is a word, and one letter makes it a name of what is there: "bell" where there is a ball."""

_TYPES = 4
"""Hypothetical objects of the hand-made examples, from which their weights come: of three types, and of none known."""


def judges_absence(encoder: WorldEncoder) -> bool:
    """Is there anything to judge by?"""
    return encoder.features.groups >= {Group.NAMES, Group.RELATION}


def log_odds_of_absence(tables: Tables, encoder: WorldEncoder, phrase: Phrase) -> float | None:
    """The log-odds that nothing there is meant; None where that is not judged by names.

    That is so before the robot has looked all round, of groups and places, where nothing is there, and where colours
    are judged by looking alone while the noun is no name of a thing, for then it may be a colour ("coffee"). What the
    speaker has ruled out counts for nothing.
    """
    objects = encoder.world.objects
    if not judges_absence(encoder):
        return None
    shown = bool(phrase.look) and any(o.rgb is not None for o in objects)
    if shown and (phrase.color is None or not _named(phrase.noun, objects)):
        return None
    if in_group(phrase) or phrase.noun in PLACE_WORDS:
        return None
    meant = encoder.world.meant
    seen = np.array([not o.hypothetical and (meant is None or o.id in meant) for o in objects], dtype=np.bool_)
    if not seen.any() or not any(o.hypothetical and LOOKED_ROUND in o.attributes for o in objects):
        return None
    strange = np.minimum(_SLIP, _excess(_noun_gap(tables, encoder, phrase), *_STRANGE))
    gap = _look_gap(phrase.color, objects) if shown else _color_gap(tables, encoder, phrase)
    odd = _excess(gap, *(_UNLIKE if shown else _ODD))
    if phrase.words:
        contrary = np.array([contradicted(phrase.words, o) for o in objects])
        odd = odd + _CONTRARY[0] * np.minimum(1.0, contrary) + _CONTRARY[1] * np.maximum(0.0, contrary - 1.0)
    found = _RARE + float((strange + odd)[seen].min())
    return found if found < 0.0 else _DOUBT * found


def less_for_many_types(encoder: WorldEncoder) -> float:
    """What to add to the log-scores of hypothetical objects where absence is not judged by names, all having been seen.

    There is one for each type that is known. Knowing more types makes it no likelier that a command means what is not
    there, so they share what those of the first types have together.
    """
    unseen = [o for o in encoder.world.objects if o.hypothetical]
    if not unseen or not all(LOOKED_ROUND in o.attributes for o in unseen):
        return 0.0
    return min(0.0, math.log(_TYPES / len(unseen)))


def _excess(gap: Floats, start: float, slope: float) -> Floats:
    found: Floats = slope * np.maximum(0.0, gap - start)
    return found


def _noun_gap(tables: Tables, encoder: WorldEncoder, phrase: Phrase) -> Floats:
    """(objects,) how far the log-odds of the noun stay behind those of the thing that it names best.

    Of what is seen: that is one whose class has the noun as its name, or one of a type that the noun is known to name.
    """
    objects = encoder.world.objects
    if phrase.noun is None or is_generic(phrase.noun):
        return np.zeros(len(objects))
    noun = Phrase(PhraseKind.NOUN, phrase.noun, noun=phrase.noun)
    odds = tables.log_odds(encoder, noun)
    unseen = [j for j, o in enumerate(objects) if o.hypothetical and o.type is not None]
    best, *likes = tables.log_odds_of(
        noun, [_like(phrase.noun, None), *(_like(objects[j].type, None, known=True) for j in unseen[:1])]
    )
    for like in likes:  # what it costs to be hypothetical is the same for all types
        best = max(best, float(odds[unseen].max() - odds[unseen[0]] + like))
    gap: Floats = np.maximum(0.0, best - odds)
    if tables.features.knows_noun(phrase.noun):
        return gap
    if unheard_of(phrase.noun) and not english().get(phrase.noun, {}).get("n", 0):  # "weather" is no thing
        gap = np.minimum(gap, _NEW)
    most = {type_: _most_of_type(phrase.noun, type_) for type_ in {o.type for o in objects}}
    return np.minimum(gap, [most[o.type] for o in objects])


def _most_of_type(noun: str, type_: str | None) -> float:
    """The most that a noun's gap is for a thing of a type: none where nobody says what it is, little where a letter is
    wrong, or where it is of the kind that the noun names ("the container" of a bottle)."""
    if type_ is None or type_.startswith(OPAQUE):
        return 0.0
    facts = evidence(noun, type_)
    bound = next((bound for fact, bound in _OF_KIND.items() if fact in facts), math.inf)
    return min(bound, _LETTER) if may_be_meant_for(noun, type_) else bound


def _color_gap(tables: Tables, encoder: WorldEncoder, phrase: Phrase) -> Floats:
    """(objects,) how far the log-odds of the colour stay behind those of a thing of just that colour."""
    objects = encoder.world.objects
    if phrase.color is None:
        return np.zeros(len(objects))
    color = Phrase(PhraseKind.NOUN, phrase.color, color=phrase.color)
    known = next((o.type for o in objects if o.known), None)
    best = tables.log_odds_of(color, [_like(None, phrase.color), _like(known, phrase.color, known=known is not None)])
    gap = best[[int(o.known) for o in objects]] - tables.log_odds(encoder, color)
    return np.where([o.color is not None for o in objects], np.maximum(0.0, gap), 0.0)


def _named(noun: str | None, objects: Sequence[Object]) -> bool:
    """Is a noun the name of something that is there, and no word for whatever there is?"""
    types = {o.type for o in objects if o.type is not None and not o.hypothetical}
    return noun is not None and not is_generic(noun) and names_one_of(noun, types)


def _look_gap(color: str | None, objects: Sequence[Object]) -> Floats:
    """(objects,) how untypical of a colour word each thing looks; 0 for what shows no colour, and for strange words."""
    found, looks = region(color or ""), [j for j, o in enumerate(objects) if o.rgb is not None]
    gap = np.zeros(len(objects))
    if found is not None and looks:
        gap[looks] = -found.log_density(lab(np.array([objects[j].rgb for j in looks], dtype=np.float64)))
    return gap


def _like(type_: str | None, color: str | None, *, known: bool = False) -> Object:
    return Object("", type_, known, color=color)
