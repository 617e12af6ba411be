"""Small changes of an episode after which it is known, by its words and objects alone, how the answer must change.

Each function returns the changed episode and what is right for it, or None where the change does not apply or where
nothing follows from it. Choices among several changes hang on the episode's id, so that they are the same tomorrow.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeVar

from dcg_torch.evaluation.episodes import Episode, EpisodeObject
from dcg_torch.names import log_odds, normalise
from dcg_torch.names.normal import head_index, singular
from dcg_torch.names.palette import color_words

T = TypeVar("T")

COLORS: Final = ("red", "green", "blue", "yellow", "orange", "purple", "pink", "brown", "black", "white")
_SIDES: Final = (
    *(("left", "right"), (r"right(?! (?:next|behind|in|on|by|above|below|under|beside)\b)", "left")),
    *(("leftmost", "rightmost"), ("rightmost", "leftmost"), ("in front of", "behind"), ("behind", "in front of")),
    *((r"(?:nearest|closest) to", "farthest from"), (r"(?:nearest|closest)(?! to)", "farthest")),
    *((r"f[au]rthest(?: away)? from", "closest to"), (r"f[au]rthest(?!(?: away)? from)", "nearest")),
    *(("above", "below"), ("below", "above"), ("top(?! of)", "bottom"), ("bottom", "top")),
    *((r"(?<!in )front(?! of)", "back"), (r"(?<!in the )back(?! up| to)", "front")),
)
_ORDINALS: Final = (("first", "last"), ("last", "first"), ("second", "third"), ("third", "first"), ("fourth", "second"))
_ELSEWHERE: Final = re.compile(
    r"\b(?:puts?|places?|moves?|drops?|sets?|brings?|stacks?|slides?|shifts?|carry|turns?|facing|drive|walk|head|then)\b",
    re.IGNORECASE,
)
"""Words of a text that says where to put a thing, how to get there, or how it stands: its sides need not be those by
which it is told apart."""
_RELATIONAL: Final = re.compile(
    r"\b(?:on|in|at|of|next|near\w*|clos\w*|far\w*|behind|front|back|left\w*|right\w*|between|above|under|below|over|"
    r"with|by|beside|top|bottom|middle|cent\w+|corner|first|second|third|fourth|last|not|except|but|than|\w+est|\w+er)\b"
)
_NAMED = 4.0  # log-odds from which words name a class
_CLOSE = 1.0  # what they may lose against the last word alone: "red cube" names a cube less well than "cube"
_LONGEST = 3  # words of a name
_WORD: Final = re.compile(r"[A-Za-z']+")


@dataclass(frozen=True, slots=True)
class Expected:
    """What is right after the change.

    Attributes:
        among: the ids that may be answered; None where any other answer may do.
        instead_of: the ids that were meant: this very set is wrong now.
        none: is no answer at all right? "must": it alone; "may"; or "no".
    """

    among: frozenset[str] | None
    instead_of: frozenset[str]
    none: str = "no"

    def allows(self, answer: Collection[str]) -> bool:
        """Is an answer right? An empty one is a refusal, or that nothing there is meant."""
        given = frozenset(answer)
        if not given:
            return self.none != "no"
        if self.none == "must" or given == self.instead_of:
            return False
        return self.among is None or given <= self.among


@dataclass(frozen=True, slots=True)
class Perturbed:
    """A changed episode, without a target, and what is right for it."""

    episode: Episode
    expected: Expected


@dataclass(frozen=True, slots=True)
class _Said:
    """Where a text names the class and the colour of what is meant: spans in the text; None where it does not."""

    noun: tuple[int, int]
    color: tuple[int, int] | None


def swap_color(episode: Episode) -> Perturbed | None:
    """Another colour is said, one that a thing of the same class has: the answer must be of that class and colour."""
    target, said = _one_meant(episode), _said(episode)
    if target is None or said is None or said.color is None:
        return None
    alike = [o for o in episode.objects if o.color and _same(o.type, target.type) and not _same(o.color, target.color)]
    if not alike:
        return None
    color = str(_pick(episode, sorted({str(o.color) for o in alike})))
    among = frozenset(o.id for o in alike if o.color == color)
    return _with_text(episode, _replaced(episode.text, said.color, color), among, "may" if _relates(episode) else "no")


def swap_absent_color(episode: Episode) -> Perturbed | None:
    """A colour is said that nothing there has: nothing there is meant."""
    said = _said(episode)
    there = {normalise(o.color).split(" ")[-1] for o in episode.objects if o.color}
    absent = [color for color in COLORS if color not in there]
    if said is None or said.color is None or not absent:
        return None
    return _with_text(episode, _replaced(episode.text, said.color, _pick(episode, absent)), frozenset(), "must")


def swap_noun(episode: Episode) -> Perturbed | None:
    """Another class is said that is there: the answer must be of it, and of the colour said if one of it has that."""
    target, said = _one_meant(episode), _said(episode)
    if target is None or said is None:
        return None
    others = sorted({o.type for o in episode.objects if log_odds(target.type, o.type) < 0.0 and o.type.isascii()})
    if not others:
        return None
    name = _pick(episode, others)
    of_class = [o for o in episode.objects if _same(o.type, name)]
    fitting = [o for o in of_class if said.color is None or _same(o.color, target.color)]
    text = _replaced(episode.text, said.noun, normalise(name))
    may_fail = _relates(episode) or not fitting
    return _with_text(episode, text, frozenset(o.id for o in fitting or of_class), "may" if may_fail else "no")


def swap_side(episode: Episode) -> Perturbed | None:
    """The side is turned round, where several things have the class and colour: another of them must be meant."""
    return None if _ELSEWHERE.search(episode.text) else _turned(episode, _SIDES, at_least=2)


def swap_ordinal(episode: Episode) -> Perturbed | None:
    """Another ordinal is said, where at least three things have the class and colour: another one must be meant."""
    said = _said(episode)
    if said is None or _ELSEWHERE.search(episode.text):
        return None
    before, after = episode.text[: said.noun[0]].lower().split()[-3:], episode.text[said.noun[1] :].lower().split()[:1]
    ordinals = {ordinal for ordinal, _ in _ORDINALS}
    return _turned(episode, _ORDINALS, at_least=3) if ordinals & {*before, *after} else None


def garble(episode: Episode) -> Perturbed | None:
    """Each word of three letters or more loses its vowels and is turned round: nothing is said any more."""
    text = _WORD.sub(
        lambda m: re.sub("[aeiouy']", "", m[0].lower())[::-1] + "x" if len(m[0]) > 2 else "zq", episode.text
    )
    return _with_text(episode, text, frozenset(), "must")


def take_away(episode: Episode) -> Perturbed | None:
    """All things of the class and colour said are gone: nothing there is meant."""
    target, said = _one_meant(episode), _said(episode)
    if target is None or said is None:
        return None
    noun = episode.text[slice(*said.noun)]
    kept = [
        o
        for o in episode.objects
        if max(log_odds(noun, o.type), log_odds(target.type, o.type)) < 0.0
        or (said.color is not None and o.color is not None and not _same(o.color, target.color))
    ]
    if not kept or len(kept) == len(episode.objects):
        return None
    gone = episode.model_copy(update={"objects": tuple(kept), "target": ()})
    return Perturbed(gone, Expected(frozenset(), frozenset(episode.target), "must"))


PERTURBATIONS: Final[Mapping[str, Callable[[Episode], Perturbed | None]]] = {
    "color": swap_color,
    "absent color": swap_absent_color,
    "noun": swap_noun,
    "side": swap_side,
    "ordinal": swap_ordinal,
    "garbled": garble,
    "taken away": take_away,
}


def _turned(episode: Episode, pairs: Sequence[tuple[str, str]], at_least: int) -> Perturbed | None:
    """The text with the only match of the pairs that it has replaced; None where it has none, or several."""
    target = _one_meant(episode)
    if target is None or _said(episode) is None or len(_alike(episode, target)) < at_least:
        return None
    found = [
        (match.span(), other)
        for one, other in pairs
        for match in re.finditer(rf"\b{one}\b", episode.text, flags=re.IGNORECASE)
    ]
    if len(found) != 1:
        return None
    span, other = found[0]
    return _with_text(episode, _replaced(episode.text, span, other), None, "may")


def _one_meant(episode: Episode) -> EpisodeObject | None:
    return next(o for o in episode.objects if o.id in episode.target) if len(episode.target) == 1 else None


def _alike(episode: Episode, target: EpisodeObject) -> list[EpisodeObject]:
    """What has the target's class and, if it has one, its colour."""
    return [o for o in episode.objects if _same(o.type, target.type) and _same(o.color, target.color)]


def _said(episode: Episode) -> _Said | None:
    """The first naming of the target's class, if the text names it before any other class; and its colour before it."""
    target = _one_meant(episode)
    words = list(_WORD.finditer(episode.text))
    if target is None:
        return None
    types = {o.type for o in episode.objects}
    for k in range(len(words)):
        named = [
            (score, length, name)
            for length in range(1, min(_LONGEST, len(words) - k) + 1)
            if (text := _compound(words[k : k + length], target.color)) is not None
            for name in types
            if (score := log_odds(text, name)) > max(_NAMED, log_odds(words[k + length - 1][0], name) - _CLOSE)
        ]
        if not named:
            continue
        _, length, name = max(named)
        if not _same(name, target.type):
            return None
        color = [j for j in range(max(0, k - 2), k) if _same(words[j][0], target.color)]
        others = k > 0 and any(_same(words[k - 1][0], o.color) for o in episode.objects) and k - 1 not in color
        if others or singular(words[k + length - 1][0].lower()) != words[k + length - 1][0].lower():
            return None  # "under two blue blocks": it is said of a landmark
        if color and color[0] > 0 and words[color[0] - 1][0].lower() in color_words().axes:
            return None  # "light blue": with another colour it would be another shade of that
        return _Said((words[k].start(), words[k + length - 1].end()), words[color[0]].span() if color else None)
    return None


def _compound(words: Sequence[re.Match[str]], color: str | None) -> str | None:
    """Words as one name; None if they are none, as with a preposition among them, or begin with the colour."""
    parts = [word[0].lower() for word in words]
    return None if head_index(parts) < len(parts) - 1 or _same(parts[0], color) else " ".join(parts)


def _same(one: str | None, other: str | None) -> bool:
    return one == other if one is None or other is None else normalise(one) == normalise(other)


def _relates(episode: Episode) -> bool:
    """Does the text say more than class and colour, so that after a change it may fit nothing?"""
    return _RELATIONAL.search(episode.text.lower()) is not None


def _pick(episode: Episode, choices: Sequence[T]) -> T:
    return choices[zlib.crc32(episode.id.encode()) % len(choices)]


def _replaced(text: str, span: tuple[int, int], word: str) -> str:
    return f"{text[: span[0]]}{word}{text[span[1] :]}"


def _with_text(episode: Episode, text: str, among: frozenset[str] | None, none: str) -> Perturbed:
    changed = episode.model_copy(update={"text": text, "target": ()})
    return Perturbed(changed, Expected(among, frozenset(episode.target), none))
