"""Why a command went wrong: one cause a row, the first of `CAUSES` that fits."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from types import MappingProxyType

from dcg_torch.storage.records import Iteration

_NOTHING: Mapping[str, str] = MappingProxyType({})

CAUSES: Mapping[str, str] = MappingProxyType(
    {
        "parse": "the noun or colour read is not the one said",
        "not perceived": "chose nothing, and never saw the object meant",
        "path": "chose the right object and did not get there",
        "wrong lesson": "the word, or the type meant, was bound wrongly by an earlier command",
        "other name": "an unknown word for a type that the robot already has a name for",
        "no grounding": "chose nothing although the object meant was seen",
        "wrong unknown": "an unknown word; chose an object of another type",
        "wrong type": "a word it knew; chose an object of another type",
        "wrong colour": "right type, not the colour said",
        "ambiguous": "right type and colour, another object",
    }
)
"""The causes in the order they are tried, each with what it means."""


def names_of_types(rows: Iterable[Iteration]) -> dict[str, frozenset[str]]:
    """What every noun of the run means: the type it is most often said of, or several where they tie."""
    said: dict[str, Counter[str]] = {}
    for row in rows:
        said.setdefault(row.noun, Counter())[_type_of(row, row.target)] += 1
    return {
        noun: frozenset(name for name, count in types.items() if count == max(types.values()))
        for noun, types in said.items()
    }


def is_right(word: str, meaning: str, names: Mapping[str, frozenset[str]]) -> bool:
    """Does `word` name the type `meaning`, by itself or by how the run's speaker uses it?"""
    return word == meaning or meaning in names.get(word, frozenset())


def error_cause(
    row: Iteration, held: Mapping[str, str] = _NOTHING, names: Mapping[str, frozenset[str]] | None = None
) -> str | None:
    """The first of `CAUSES` that fits a wrong row; None for a correct one.

    Args:
        row: the command.
        held: word -> type as learned before this command, i.e. `symbols` of the trial's previous row.
        names: `names_of_types` of the whole run; by default of this row alone.

    An object that the robot never saw because it settled on another one first is no fault of perception: such a row
    counts by what it chose.
    """
    if row.correct:
        return None
    names = names_of_types([row]) if names is None else names
    meant = _type_of(row, row.target)
    if row.parsed is None or not (_same(row.parsed.noun, row.noun) and _same(row.parsed.color, row.color)):
        return "parse"
    if row.chosen is None and row.target not in row.seen:
        return "not perceived"
    if row.chosen == row.target:
        return "path"
    if row.noun in held:
        # A word is used of one type or another ("block"), so a lesson can be right in general and wrong here.
        if held[row.noun] != meant:
            return "wrong lesson"
    elif row.kind == "unknown":
        holders = [word for word, meaning in held.items() if meaning == meant]
        if meant in row.known_types or any(is_right(word, meant, names) for word in holders):
            return "other name"
        if holders:
            return "wrong lesson"
    if row.chosen is None:
        return "no grounding"
    chosen = next((o for o in row.objects if o.id == row.chosen), None)
    if chosen is None or chosen.type != meant:
        return "wrong unknown" if row.kind == "unknown" else "wrong type"
    if row.color is not None and not _same(chosen.color, row.color):
        return "wrong colour"
    return "ambiguous"


def _type_of(row: Iteration, identifier: str) -> str:
    for thing in row.objects:
        if thing.id == identifier:
            return thing.type
    raise ValueError(
        f"trial {row.trial}, iteration {row.iteration}: object {identifier!r} is not among the row's objects; "
        f"`target` must be the id of one of them"
    )


def _same(a: str | None, b: str | None) -> bool:
    return (a or "").casefold() == (b or "").casefold()
