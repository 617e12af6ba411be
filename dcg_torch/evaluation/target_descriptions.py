"""What an episode's text says of the thing that is meant, by its words and objects alone; changed texts from it."""

from __future__ import annotations

import re
import zlib
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Final, TypeVar

from dcg_torch.evaluation.episodes import Episode, EpisodeObject
from dcg_torch.names import log_odds, normalise
from dcg_torch.names.normal_form import head_index, singular
from dcg_torch.names.palette import color_words

T = TypeVar("T")

RELATIONAL: Final = re.compile(
    r"\b(?:on|in|at|of|next|near\w*|clos\w*|far\w*|behind|front|back|left\w*|right\w*|between|above|under|below|over|"
    r"with|by|beside|top|bottom|middle|cent\w+|corner|first|second|third|fourth|last|not|except|but|than|\w+est|\w+er)\b"
)
_NAMED = 4.0  # log-odds from which words name a class
_CLOSE = 1.0  # what they may lose against the last word alone: "red cube" names a cube less well than "cube"
_LONGEST = 3  # words of a name
WORD: Final = re.compile(r"[A-Za-z']+")


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
class Said:
    """Where a text names the class and the colour of what is meant: spans in the text; None where it does not."""

    noun: tuple[int, int]
    color: tuple[int, int] | None


def one_meant(episode: Episode) -> EpisodeObject | None:
    """The thing meant; None where there are several, or none."""
    return next(o for o in episode.objects if o.id in episode.target) if len(episode.target) == 1 else None


def alike(episode: Episode, target: EpisodeObject) -> list[EpisodeObject]:
    """What has the target's class and, if it has one, its colour."""
    return [o for o in episode.objects if same(o.type, target.type) and same(o.color, target.color)]


def said_of(episode: Episode) -> Said | None:
    """The first naming of the target's class, if the text names it before any other class; and its colour before it."""
    target = one_meant(episode)
    words = list(WORD.finditer(episode.text))
    if target is None:
        return None
    types = {o.type for o in episode.objects}
    for k in range(len(words)):
        found = naming_at(words, k, types, target.color)
        if found is None:
            continue
        length, name = found
        if not same(name, target.type):
            return None
        color = [j for j in range(max(0, k - 2), k) if same(words[j][0], target.color)]
        others = k > 0 and any(same(words[k - 1][0], o.color) for o in episode.objects) and k - 1 not in color
        if others or singular(words[k + length - 1][0].lower()) != words[k + length - 1][0].lower():
            return None  # "under two blue blocks": it is said of a landmark
        if color and color[0] > 0 and words[color[0] - 1][0].lower() in color_words().axes:
            return None  # "light blue": with another colour it would be another shade of that
        return Said((words[k].start(), words[k + length - 1].end()), words[color[0]].span() if color else None)
    return None


def naming_at(
    words: Sequence[re.Match[str]], k: int, types: Collection[str], color: str | None
) -> tuple[int, str] | None:
    """How many words from the k-th on name one of the classes, and which; None if they name none.

    Args:
        color: a colour that is no part of a name.
    """
    named = [
        (score, length, name)
        for length in range(1, min(_LONGEST, len(words) - k) + 1)
        if (text := _compound(words[k : k + length], color)) is not None
        for name in types
        if (score := log_odds(text, name)) > max(_NAMED, log_odds(words[k + length - 1][0], name) - _CLOSE)
    ]
    return max(named)[1:] if named else None


def _compound(words: Sequence[re.Match[str]], color: str | None) -> str | None:
    """Words as one name; None if they are none, as with a preposition among them, or begin with the colour."""
    parts = [word[0].lower() for word in words]
    return None if head_index(parts) < len(parts) - 1 or same(parts[0], color) else " ".join(parts)


def same(one: str | None, other: str | None) -> bool:
    """Are two names one but for the way they are written?"""
    return one == other if one is None or other is None else normalise(one) == normalise(other)


def relates(episode: Episode) -> bool:
    """Does the text say more than class and colour, so that after a change it may fit nothing?"""
    return RELATIONAL.search(episode.text.lower()) is not None


def pick(episode: Episode, choices: Sequence[T]) -> T:
    """A choice that hangs on the episode's id."""
    return choices[zlib.crc32(episode.id.encode()) % len(choices)]


def replaced(text: str, span: tuple[int, int], word: str) -> str:
    """The text with a word in the place of a span."""
    return f"{text[: span[0]]}{word}{text[span[1] :]}"


def with_text(episode: Episode, text: str, among: frozenset[str] | None, none: str) -> Perturbed:
    """The episode with another text, and what is right for it (see `Expected`)."""
    changed = episode.model_copy(update={"text": text, "target": ()})
    return Perturbed(changed, Expected(among, frozenset(episode.target), none))
