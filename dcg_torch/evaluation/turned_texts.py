"""Sides and ordinals of a text turned into others, and which thing is meant then, by the episode's own coordinates.

The target says in which frame a word is meant: "the left cube" that is the leftmost as its speaker sees it becomes
"the right cube", and that is the other end of the same line. A text whose target is not where its words say that it is
proves nothing, and is left out, and so is one that says a second relation: what it means after the change, and if it
means anything, nobody can say. Where nobody knows where the robot stands, all that can be asked is that another thing
of the description is answered, or none.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from dcg_torch.evaluation.episodes import Episode, EpisodeObject
from dcg_torch.evaluation.measures import FAR, NEAR, OPPOSITE, distance, measures, ranked, to_corner, volume
from dcg_torch.evaluation.target_descriptions import (
    RELATIONAL,
    WORD,
    Perturbed,
    Said,
    alike,
    naming_at,
    one_meant,
    replaced,
    said_of,
    same,
    with_text,
)

_SIDES: Final = (
    *(("left", "right"), (r"right(?! (?:next|behind|in|on|by|above|below|under|beside)\b)", "left")),
    *(("leftmost", "rightmost"), ("rightmost", "leftmost"), ("in front of", "behind"), ("behind", "in front of")),
    *((r"(?:nearest|closest) to", "farthest from"), (r"(?:nearest|closest)(?! to)", "farthest")),
    *((r"f[au]rthest(?: away)? from", "closest to"), (r"f[au]rthest(?!(?: away)? from)", "nearest")),
    *(("above", "below"), ("below", "above"), ("top(?! of)", "bottom"), ("bottom", "top")),
    *((r"(?<!in )front(?! of)", "back"), (r"(?<!in the )back(?! up| to)", "front")),
)
_ORDINALS: Final = (("first", "last"), ("last", "first"), ("second", "third"), ("third", "first"), ("fourth", "second"))
_PLACE: Final = {"first": 0, "second": 1, "third": 2, "fourth": 3, "last": -1}
_TOWARDS: Final = re.compile(
    r"\b(?:nearest|closest|closer|f[au]rthest|most)(?: to| towards| on)?(?: the| your)?"
    r"(?= (?:left|right|top|bottom|front|back)\b)",
    re.IGNORECASE,
)
"""Words before a side that say no other one: "closest to the left" is the leftmost."""
_CORNER: Final = re.compile(r"\b(top|bottom|front|back) (left|right)(?: hand)? corner\b", re.IGNORECASE)
_COUNTED: Final = re.compile(
    r"\b(left|right|top|bottom|front|back|nearest|closest|farthest|furthest|biggest|largest|smallest|tallest|shortest)"
)
_SUPERLATIVE: Final = re.compile(r" \w+(?:est|most)\b", re.IGNORECASE)
_SIZED: Final = re.compile(r"\b(?:small|little|tiny|big|large|huge|tall|short)\b", re.IGNORECASE)
_SAME_SIZE: Final = 0.01
_CLEARLY: Final = 0.7  # of the way from a landmark to what is on a side of it leads to that side, or more
_SPLIT: Final = re.compile(
    r"\b(?:nearest|closest|f[au]rthest) (?!away|to|from)(?:\w+ ){1,3}(?:to|from) (?!the left|the right|left|right)",
    re.IGNORECASE,
)
"""A superlative and what it counts from with the thing between: "the closest cone to you"."""
_SAYS_WHERE: Final = re.compile(
    r"(?<!\w)(?:(?:on|in|at|to|from|of|by|the|your|its|away|most|far|hand|side|edge|end|first|second|third|fourth|last|"
    r"left|right|leftmost|rightmost|top|bottom|front|back|nearest|closest|farthest|furthest|biggest|largest|smallest|"
    r"tallest|shortest|behind|above|below|robot|you|yourself|me|scene|picture|image|board|table|room|row|line|counting|"
    r"counted)(?!\w)[ ,.-]*)+",
    re.IGNORECASE,
)
"""One side, distance or ordinal, with the small words around it."""
_WHOLE: Final = re.compile(r" of (?:the |this )?(?:scene|picture|image|board|table|grid|screen|room|row|line)\b")
_PEOPLE: Final = re.compile(r"\s*(?:the robot|you|yourself|me)\b", re.IGNORECASE)
_MOVED: Final = r"(?:puts?|places?|moves?|drops?|sets?|brings?|stacks?|slides?|shifts?|carry)"
_DESTINATION: Final = re.compile(rf"(?:\band|\bthen|,)(?: then)? {_MOVED}\b.*$", re.IGNORECASE | re.DOTALL)
_ELSEWHERE: Final = re.compile(rf"\b(?:{_MOVED}|turns?|facing|drive|walk|head|then)\b", re.IGNORECASE)
"""Words of a text that says where to put a thing, how to get there, or how it stands: its sides need not be those by
which it is told apart."""


@dataclass(frozen=True, slots=True)
class _Described:
    """A text that says one thing's class, up to where it is to be put; and what has that class, colour and size.

    Attributes:
        says_more: does it say more than these and one side, a distance or an ordinal?
    """

    episode: Episode
    target: EpisodeObject
    head: str
    said: Said
    things: tuple[EpisodeObject, ...]
    says_more: bool


def swap_side(episode: Episode) -> Perturbed | None:
    """The side is turned round, where several things have the class and colour: what is at the other end is meant."""
    of = _described(episode)
    if of is None or len(of.things) < 2 or _SPLIT.search(f"{of.head} "):
        return None
    corner = _CORNER.search(of.head)
    if corner is not None:
        one, other = (word.lower() for word in corner.groups())
        span = corner.start(1), corner.end(2)
        frames = [(ranked(of.things, m)[0], ranked(of.things, back)[0]) for m, back in to_corner((one, other), episode)]
        return _changed(of, span, f"{OPPOSITE[one]} {OPPOSITE[other]}", _meant(of, frames), "no")
    hits = _hits(_SIDES, _TOWARDS.sub(lambda m: " " * len(m[0]), of.head))
    if len(hits) != 1:
        return None
    span, other = hits[0]
    word, rest = of.head[slice(*span)].lower(), of.head[span[1] :]
    if " " in word or word in ("behind", "above", "below") or (rest.startswith(" of") and not _WHOLE.match(rest)):
        return _turned_relation(of, span, other, word.replace("in front of", "front").replace("behind", "back"))
    counted = {_PLACE[name] for name in _words_near(of) if name in _PLACE} or {0}
    k = min(counted)
    if len(counted) > 1 or k >= len(of.things):
        return None
    orders = [ranked(of.things, measure) for measure in measures(word.removesuffix("most"), episode)]
    return _changed(of, span, other, _meant(of, [(order[k], order[-1 - k]) for order in orders]), "no")


def swap_ordinal(episode: Episode) -> Perturbed | None:
    """Another ordinal is said, where at least three things have the class and colour: another one must be meant."""
    of = _described(episode)
    if of is None or len(of.things) < 3:
        return None
    hits = _hits(_ORDINALS, of.head)
    if len(hits) != 1 or of.head[slice(*hits[0][0])].lower() not in _words_near(of):
        return None
    span, other = hits[0]
    if other == "first" and _SUPERLATIVE.match(of.head[span[1] :]):
        other = "second"  # nobody says "the first biggest"
    before, after = _PLACE[of.head[slice(*span)].lower()], _PLACE[other]
    counted = list(dict.fromkeys(_COUNTED.findall(of.head.lower()))) or ["left", "right", "near"]
    if max(before, after) >= len(of.things):
        return None
    orders = [ranked(of.things, measure) for word in counted for measure in measures(word, episode)]
    return _changed(of, span, other, _meant(of, [(order[before], order[after]) for order in orders]), "no")


def _turned_relation(of: _Described, span: tuple[int, int], other: str, word: str) -> Perturbed | None:
    """The other side of a landmark: what is described and lies there is meant, or nothing if it lies there too little.

    Args:
        word: a side, or "closest to" and its like: then the other end of all is meant.
    """
    people = _PEOPLE.match(of.head[span[1] :]) is not None
    if word.split(" ")[0] in NEAR | FAR:
        found = measures(word.split(" ")[0], of.episode) if people else []
        if not people:
            mark = _landmark(of, span[1])
            if mark is None:
                return None
            away = distance(mark.position[:2])
            found = [away if word.split(" ")[0] in FAR else lambda o: -away(o)]
        orders = [ranked(of.things, measure) for measure in found]
        return _changed(of, span, other, _meant(of, [(order[0], order[-1]) for order in orders]), "no")
    mark, found = None if people else _landmark(of, span[1]), measures(word, of.episode)
    if mark is None or of.says_more:
        return None
    if not found:
        return _changed(of, span, other, None, "may")
    there: set[str] = set()
    for measure in found:
        off = {o.id: measure(o) - measure(mark) for o in of.things}
        clear = {o.id: abs(off[o.id]) >= _CLEARLY * math.dist(o.position, mark.position) for o in of.things}
        if off[of.target.id] > 0.0 and clear[of.target.id] and any(off[i] < 0.0 and clear[i] for i in off):
            there |= {i for i in off if off[i] < 0.0}
    return _changed(of, span, other, frozenset(there), "may")


def _meant(of: _Described, frames: Sequence[tuple[str | None, str | None]]) -> frozenset[str] | None:
    """What is meant after the change in the frames in which the target was meant before; none where the text says more.

    None: nobody can know, for the coordinates say nothing of such a side.

    Args:
        frames: for each, the id that is meant before and after; None where two can hardly be told apart.
    """
    if of.says_more:
        return frozenset()
    if not frames:
        return None
    return frozenset(after or "" for before, after in frames if before == of.target.id)


def _changed(
    of: _Described, span: tuple[int, int], other: str, meant: frozenset[str] | None, none: str
) -> Perturbed | None:
    """The changed episode; None where the coordinates say that the target was not meant before, or still is.

    Args:
        meant: the ids that are meant then; None: any other of those described may be.
        none: may none be answered?
    """
    if meant is None:
        meant, none = frozenset(o.id for o in of.things) - {of.target.id}, "may"
    if not meant or meant & {of.target.id, ""}:
        return None
    return with_text(of.episode, replaced(of.episode.text, span, other), meant, none)


def _described(episode: Episode) -> _Described | None:
    target, said, gone = one_meant(episode), said_of(episode), _DESTINATION.search(episode.text)
    head = episode.text[: gone.start()] if gone else episode.text
    if target is None or said is None or said.noun[1] > len(head) or _ELSEWHERE.search(head):
        return None
    named = said.color is None and any(same(word[0], target.color) for word in WORD.finditer(head))
    things = (
        alike(episode, target) if said.color or named else [o for o in episode.objects if same(o.type, target.type)]
    )
    if _SIZED.search(head[: said.noun[0]]) and volume(target):
        things = [o for o in things if math.isclose(volume(o), volume(target), rel_tol=_SAME_SIZE)]
    left = _SAYS_WHERE.sub(" ", _CORNER.sub(" ", _TOWARDS.sub(" ", f"{head[: said.noun[0]]}  {head[said.noun[1] :]}")))
    return _Described(episode, target, head, said, tuple(things), RELATIONAL.search(left.lower()) is not None)


def _words_near(of: _Described) -> set[str]:
    """The three words before the name of the class, and the one after it: where an ordinal counts such things."""
    begin, end = of.said.noun
    return {*of.head[:begin].lower().split()[-3:], *of.head[end:].lower().split()[:1]}


def _hits(pairs: Sequence[tuple[str, str]], text: str) -> list[tuple[tuple[int, int], str]]:
    """Where one of the pairs stands, and what it turns into."""
    return [
        (match.span(), other) for one, other in pairs for match in re.finditer(rf"\b{one}\b", text, flags=re.IGNORECASE)
    ]


def _landmark(of: _Described, begin: int) -> EpisodeObject | None:
    """The one thing that the first name after a place in the text can mean; None if it is none or one of several."""
    words = [word for word in WORD.finditer(of.head) if word.start() >= begin]
    types = {o.type for o in of.episode.objects}
    for k in range(len(words)):
        named = naming_at(words, k, types, None)
        if named is not None:
            color = [w[0] for w in words[max(0, k - 1) : k] if any(same(w[0], o.color) for o in of.episode.objects)]
            found = [
                o
                for o in of.episode.objects
                if same(o.type, named[1]) and o.id != of.target.id and (not color or same(o.color, color[0]))
            ]
            return found[0] if len(found) == 1 else None
    return None
