"""What a teacher's sentence says of names, in a world."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from dcg_torch.grounding.solution import Solution
from dcg_torch.learning.learner import Learner
from dcg_torch.types import Object, Symbol, WorldModel


@dataclass(frozen=True, slots=True)
class Told:
    """What came of a teacher's sentence: true where a name was learned.

    Attributes:
        word: the noun.
        type: what it names now.
        object: id of the object that was spoken of.
        problem: why nothing was learned, one sentence; None where something was.
    """

    word: str | None = None
    type: str | None = None
    object: str | None = None
    problem: str | None = None

    def __bool__(self) -> bool:
        return self.problem is None


class Grounds(Protocol):
    """What understanding a teacher takes."""

    @property
    def symbols(self) -> Mapping[str, Symbol]:
        """The words that are held to name a type."""

    def ground(self, command: str, world: WorldModel) -> Solution:
        """What a command means in a world."""


_SURE = 0.5
"""Probability from which on a described object is taken to be the one spoken of."""


def interpret(sentence: str, world: WorldModel, pointing_at: str | None, model: Grounds) -> Told:
    """The name that a sentence gives, and to what type.

    Args:
        pointing_at: id of the object that the teacher points at.
        model: finds the object that the teacher describes.
    """
    from dcg_torch.speech_acts.teaching import read_teaching  # its words are data that only who gives text pays for

    said = read_teaching(sentence)
    if said is None:
        return Told(problem="that teaches no name; say, for example, 'this is a pallet'")
    if said.same_as is not None:
        return _same(said.name, said.same_as, model.symbols)
    if pointing_at is None and said.subject is None:
        return Told(said.name, problem="it is not clear what is pointed at; name the object, or point at one")
    meant: Sequence[Object] = [o for o in world.objects if o.id == pointing_at]
    if said.subject is not None and pointing_at is None:
        found = model.ground(f"go to {said.subject}", world)
        sure = (found.probability or 0.0) >= _SURE
        meant = [o for o in found.objects if not o.hypothetical] if sure else []
    if len(meant) != 1 or meant[0].type is None:
        there = "there is no such object here" if not meant else "it is not clear which one is meant"
        return Told(said.name, problem=f"{there}: {said.subject or pointing_at}")
    return Told(said.name, meant[0].type, meant[0].id)


def _same(one: str, other: str, symbols: Mapping[str, Symbol]) -> Told:
    """One of two nouns is known: the other gets its type."""
    new, known = (one, other) if other in symbols else (other, one)
    if known not in symbols:
        return Told(one, problem=f"neither {one!r} nor {other!r} is known")
    return Told(new, symbols[known].type)


def settled(learner: Learner, word: str, type_: str) -> Learner:
    """A learner that holds for certain that a noun names a type.

    Raises:
        ValueError: nothing of this type was ever met, or there is no word.
    """
    if not word.strip():
        raise ValueError("a word is text that is not empty")
    if type_ not in learner.known_types:
        raise ValueError(f"{type_!r}: nothing of this type was ever met; types are {', '.join(learner.known_types)}")
    return learner.told(word, type_)


def forgotten(learner: Learner, word: str) -> Learner:
    """A learner without all that was heard of a noun.

    Raises:
        ValueError: it was never heard.
    """
    if word not in {entry.word for entry in learner.lexicon()}:
        raise ValueError(f"{word!r}: this noun was never heard; model.lexicon() lists those that were")
    return learner.forget(word)
