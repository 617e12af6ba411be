"""People told of in a few words each: "bearded, no glasses, black hair", "a man. no hair. has glasses".

No sentence and often no noun: each piece names what somebody has or has not, how he is, where he is or looks. Where
every piece is one of these they are put together as one noun phrase: "the bearded person with black hair, without
glasses". What holds one piece of another kind is read as ever.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Sequence
from typing import Any, NamedTuple

from dcg_torch.english.forms import parts
from dcg_torch.names.attribute_values import says_value
from dcg_torch.names.normal_form import read_data


class _Piece(NamedTuple):
    """What one piece tells: how somebody is, who it is, "with ..." or "without ...", where, or how he is in a noun."""

    like: str = ""
    who: str = ""
    has: str = ""
    where: str = ""
    named: str = ""


def as_one_phrase(text: str) -> str:
    """A text of such pieces as one noun phrase; any other as it is."""
    pieces = [part.strip() for part in _pattern("apart").split(text.strip().lower().rstrip(".!? ")) if part.strip()]
    told = [_told(piece) for piece in pieces]
    found = [piece for piece in told if piece is not None]
    named = list(dict.fromkeys(piece.who for piece in found if piece.who))
    if len(found) < max(2, len(told)) or len(named) > 1 or not any(piece.has for piece in found):
        return text
    nouns = _each(found, "named")
    who = named or nouns[:1] or [str(_data()["telegram"]["whoever"])]
    like = [*_each(found, "like"), *(nouns if named else nouns[1:])]
    behind = ", ".join([*_each(found, "has"), *_each(found, "where")])
    return " ".join(["the", *like, *who, behind])


def _each(pieces: Sequence[_Piece], what: str) -> list[str]:
    return [getattr(piece, what) for piece in pieces if getattr(piece, what)]


def _told(piece: str) -> _Piece | None:
    """What a piece tells; None where it is of no such kind."""
    begun = _pattern("begun").match(piece)
    who, rest = "", piece
    if begun is not None:
        who, rest = _data()["telegram"]["begun_by"].get(begun["who"], ""), piece[begun.end() :]
    if (had := _pattern("has").match(rest)) is not None:
        return _Piece("", who, f"{'without' if had['no'] else 'with'} {had['what']}")
    if _pattern("where").match(rest) is not None:
        return _Piece("", who, "", rest)
    if (named := _pattern("person").match(rest)) is not None and all(map(says_value, named["like"].split())):
        return _Piece(named["like"].strip(), named["who"])
    plain = _pattern("being").sub("", rest).replace("-", " ")
    if not says_value(plain):
        return None
    uses = parts(plain)  # "grandma" is somebody, "bald" how he is
    return _Piece(plain, who) if who or uses.get("a", 0) >= uses.get("n", 0) else _Piece(named=plain)


@functools.cache
def _data() -> dict[str, Any]:
    return read_data("people.yaml")


@functools.cache
def _pattern(name: str) -> re.Pattern[str]:
    """One of `data/people.yaml`, small letters."""
    filled = str(_data()["telegram"][name])
    for part, value in _data()["parts"].items():
        filled = filled.replace(f"<{part}>", str(value))
    return re.compile(filled)
