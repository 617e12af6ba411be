"""The frame of reference of a command is latent: sides that nobody owns are the robot's, or the speaker's who faces it.

One frame holds for all words of a command. How often speakers of a place mean their own is learned (`learning.frames`);
what a command says of whose sides they are moves it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import replace

from dcg_torch.grounding.solution import Solution
from dcg_torch.interpretation.plain_words import whose_side
from dcg_torch.names.evidence import is_generic
from dcg_torch.names.vocabulary import LATERAL, ORDINALS, OWNERS
from dcg_torch.names.weights import names_one_of
from dcg_torch.scene.bodies import gap
from dcg_torch.scene.frames import seen_before, seen_by_speaker, seen_facing
from dcg_torch.types import Object, ParseTree, Phrase, PhraseKind, WorldModel

_SIDE = r"(?:\w+[ -]+){0,2}?(?:left|right|front|back|side|perspective|point of view|view|viewpoint)\b"
_STANDS = r"(?:as|where) {} (?:see|stand|sit|look|am|are|'m|'re)\b"
_CUES = (
    (re.compile(rf"\bmy {_SIDE}"), 4.0),
    (re.compile(_STANDS.format("i")), 4.0),
    (re.compile(_STANDS.format("you")), -4.0),
    (re.compile(rf"\byour? {_SIDE}"), -4.0),
    (re.compile(r"\byour?\b"), -1.0),
)
"""What is said of the frame, and by how much it moves the log-odds of the speaker's: who says "your left" once sees all
with the robot's eyes, and who speaks of the robot at all mostly does."""


def views(text: str, world: WorldModel, speakers: float | None) -> Sequence[tuple[WorldModel, float]]:
    """The world as the robot sees it, then as the speaker does where that differs; each with its log-probability.

    Args:
        speakers: the probability of the speaker's frame where a command says nothing of it; None: there is one alone.
    """
    other = None if speakers is None else seen_by_speaker(world)
    if speakers is None or other is None:
        return [(world, 0.0)]
    said = text.lower()
    log_odds = math.log(speakers) - math.log1p(-speakers) + sum(by for cue, by in _CUES if cue.search(said))
    return [(world, -math.log1p(math.exp(log_odds))), (other, -math.log1p(math.exp(-log_odds)))]


def faced(tree: ParseTree, world: WorldModel, solve: Callable[[ParseTree], Solution]) -> WorldModel | None:
    """The world as who faces what a command says they face sees it: "facing the bed, the nightstand on the left".

    Args:
        tree: of the likeliest reading.
        world: as the robot sees it.
        solve: grounds a tree in it.
    """
    views_ = (FACING, FACING_FROM)
    place = next((c for c in tree.children if c.phrase.words[:1] and c.phrase.words[0] in views_ and c.children), None)
    if place is None:
        return _from_before(tree, world, solve)
    if place.children[0].phrase.noun is None:
        return None
    if len(tree.children) < 2:  # "facing the windows, it is the one on the right"
        return _from_before(tree, world, solve)
    found = solve(ParseTree(Phrase(PhraseKind.VERB, ""), place.children[:1]))
    thing = found.object
    if thing is None or thing.hypothetical:
        return None
    away = place.phrase.words[0] == FACING_FROM
    seen = seen_facing(found.world, thing, away=away)
    noun = next((node.phrase.noun for node in tree.children[0].walk() if node.phrase.kind is PhraseKind.NOUN), None)
    whole = away or place.children[0].phrase.plural  # "facing the windows": all along that wall
    return seen if seen is None or whole or noun is None else _of_those_beside(seen, thing, noun)


def _from_before(tree: ParseTree, world: WorldModel, solve: Callable[[ParseTree], Solution]) -> WorldModel | None:
    """ "The left pillow on the couch" is left for who stands before that, where nobody knows who stands where."""
    if world.robot is not None:
        return None
    sided = next((node for node in tree.walk() if node.phrase.kind is PhraseKind.NOUN and _is_sided(node)), None)
    if sided is None:
        return None
    words = tuple(word for word in sided.phrase.words if not _says_side(word) and word not in ORDINALS)
    rest = tuple(child for child in sided.children if not _is_side(child))
    bare = ParseTree(replace(sided.phrase, words=words), rest)
    found = solve(ParseTree(Phrase(PhraseKind.VERB, ""), (bare,)))
    likely = max(found.probabilities.values(), default=0.0) * _AS_LIKELY
    return seen_before(found.world, {id_ for id_, p in found.probabilities.items() if p >= likely})


def _is_sided(noun: ParseTree) -> bool:
    return any(map(_says_side, noun.phrase.words)) or any(map(_is_side, noun.children))


def _says_side(word: str) -> bool:
    return word.removeprefix("from the ").removesuffix("most") in LATERAL


def _is_side(place: ParseTree) -> bool:
    """ "On the left", and not "on the left of the bed"."""
    side = place.children[0] if len(place.children) == 1 else place
    return place.phrase.kind is PhraseKind.PREPOSITION and side.phrase.noun in LATERAL and not side.children


_AS_LIKELY = 0.5
"""Share of the likeliest one's probability from which things are among those of which one is on the left."""


def _of_those_beside(world: WorldModel, faced: Object, noun: str) -> WorldModel:
    """ "Facing the bed, the pillow on the right" is one of the two on the bed, where all others are far from it."""
    named = [o for o in world.objects if o.position is not None and o.type and names_one_of(noun, (o.type,))]
    gaps = sorted((gap(o, faced), o.id) for o in named if o.id != faced.id)
    if len(gaps) < _BESIDE + 1 or is_generic(noun):
        return world
    least = gaps[_BESIDE - 1][0] + world.unit
    near = {id_ for distance, id_ in gaps if distance < least}
    if len(near) != _BESIDE or gaps[_BESIDE - 1][0] > world.unit:
        return world
    far = {id_ for _, id_ in gaps} - near
    meant = {o.id for o in world.objects} if world.meant is None else {*world.meant}
    return replace(world, meant=frozenset(meant - far))


_BESIDE = 2
"""How many of a kind beside a thing that is faced are told apart by sides."""


FACING = "facing"
FACING_FROM = "facing from"
"""With one's back to it."""


def from_the_other_side(tree: ParseTree) -> ParseTree:
    """What is said, as who sees with the speaker's eyes would say it: "my left" instead of "your left".

    People stay where they are: "my side of the table" is still where the speaker is.
    """
    kept = whose_side(tree.phrase) is not None
    words = tree.phrase.words if kept else tuple(_OTHER.get(word, word) for word in tree.phrase.words)
    return replace(
        tree, phrase=replace(tree.phrase, words=words), children=tuple(map(from_the_other_side, tree.children))
    )


def as_viewed(tree: ParseTree, world: WorldModel) -> ParseTree:
    """A tree as it is said in a world that is seen otherwise than by the robot; else as it is.

    Where nobody knows where the robot is "your left" is the left of who faces what is told.
    """
    if world.viewer is None:
        return tree
    return from_the_other_side(tree) if world.robot is not None else _unowned(tree)


def _unowned(tree: ParseTree) -> ParseTree:
    phrase = tree.phrase
    if phrase.noun in LATERAL:
        phrase = replace(phrase, words=tuple(word for word in phrase.words if word not in OWNERS))
    return ParseTree(phrase, tuple(map(_unowned, tree.children)))


_OTHER = dict(zip(OWNERS, reversed(OWNERS), strict=True))
