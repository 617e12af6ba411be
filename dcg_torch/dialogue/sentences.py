"""What the robot says, as sentences for people. Where things are is said from where the robot stands now."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from dcg_torch.agent.asking import describe
from dcg_torch.dialogue.events import Candidate
from dcg_torch.grounding.solution import Solution
from dcg_torch.learning.beliefs import UNMET
from dcg_torch.learning.lexicon import Entry
from dcg_torch.names.vocabulary import PLACE_WORDS
from dcg_torch.types import DriveResult, Object, Percept, Pose
from dcg_torch.types.geometry import bearing

Names = Mapping[str, str]
"""type -> a word for it that the robot is sure of."""

ENDINGS = {
    DriveResult.ARRIVED: "I am there.",
    DriveResult.NO_WAY: "I find no way there.",
    DriveResult.BLOCKED: "Something is in my way; I did not get there.",
    DriveResult.TOO_FAR: "That is too far for me.",
    DriveResult.STOPPED: "I stopped.",
}
_ROUND = (
    ("in front of me", 0.0),
    ("in front of me to the left", 45.0),
    ("on my left", 90.0),
    ("behind me to the left", 135.0),
    ("behind me", 180.0),
    ("behind me to the right", -135.0),
    ("on my right", -90.0),
    ("in front of me to the right", -45.0),
)


def where(thing: Percept, pose: Pose) -> str:
    """Where a thing is for the robot, as in "1.9 m away, on my left"."""
    angle = math.degrees(bearing(pose, *thing.position[:2]))
    side, _ = min(_ROUND, key=lambda item: abs(math.remainder(angle - item[1], 360.0)))
    return f"{math.dist(thing.position[:2], (pose.x, pose.y)):.1f} m away, {side}"


def the(thing: Percept, percepts: Sequence[Percept], pose: Pose, names: Names) -> str:
    """The shortest description that fits no other object: "the red cube", "the blue thing on my left"."""
    return " ".join(filter(None, describe(thing, percepts, pose, names)))


def a(thing: Percept, names: Names) -> str:
    """A thing's name with its article, as in "a red cube"; without a word for it, what the recogniser calls it."""
    color = f"{thing.color} " if thing.color else ""
    if thing.type in names:
        return with_article(f"{color}{names[thing.type]}")
    return with_article(f'{color}thing that my camera calls "{thing.type}"')


def with_article(name: str) -> str:
    """ "a cube", "an orange cube"."""
    return f"{'an' if name[:1].lower() in 'aeiou' else 'a'} {name}"


def listed(parts: Sequence[str], last: str = "and") -> str:
    """ "a", "a and b", "a, b and c"."""
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} {last} {parts[-1]}"


def numbered(count: int, noun: str) -> str:
    """ "no cubes", "one cube", "3 cubes"."""
    if count == 1:
        return f"one {noun}"
    if noun.endswith(("s", "x", "ch", "sh")):
        several = f"{noun}es"
    elif noun.endswith("y") and noun[-2:-1] not in "aeiou":
        several = f"{noun[:-1]}ies"
    else:
        several = f"{noun}s"
    return f"{count or 'no'} {several}"


def said_of(solution: Solution) -> str:
    """The noun phrase of a command as the person said it, with "the": "the red cube"."""
    noun = solution.noun
    words = [] if noun is None else [w for w in noun.text.split() if w not in {"the", "a", "an", "any", "some"}]
    return f"the {' '.join(words)}" if words and words != ["it"] else "that"


def kind_of(solution: Solution) -> str:
    """The noun phrase of a command without an article, for what may not be there: "red cube"."""
    said = said_of(solution)
    return "such thing" if said == "that" else said.removeprefix("the ")


def candidate(thing: Object, probability: float, names: Names) -> Candidate:
    """A thing that may be meant, as a row of the chart."""
    if thing.hypothetical:
        name = f"unseen {names.get(thing.type or '', thing.type)}" if thing.known else "unseen unknown thing"
    else:
        name = " ".join(filter(None, (thing.color, names.get(thing.type or "", thing.type))))
    return Candidate(thing.id, name, probability, thing.known, thing.hypothetical)


def _met(type_: str) -> str:
    return "something that I have not met yet" if type_ == UNMET else f'what my camera calls "{type_}"'


def meaning(word: str, entry: Entry | None, heard: Mapping[str, str]) -> str:
    """What a word means to the robot, and how it knows.

    Args:
        heard: word -> who or what taught it: "told", or a command.
    """
    if word in PLACE_WORDS:
        return f'"{word}" is a place.'
    if entry is None or not entry.types:
        return f'I have never heard the word "{word}". Click on one and say: this is {with_article(word)}.'
    (best, p), *others = ((_met(t), q) for t, q in entry.types[:3])
    if entry.settled:
        how = "you told me so" if word in heard else "I knew that from the start"
        what = "" if entry.types[0][0] == word else f" {best}"
        return f"{with_article(word).capitalize()} is{what or ' a kind of thing that I know'}; {how}."
    from_ = f', from "{entry.sources[0]}"' if entry.sources else ""
    more = f"; it may also be {listed([f'{t} ({q:.0%})' for t, q in others], 'or')}" if p < 0.9 and others else ""
    return f'I think that "{word}" is {best} ({p:.0%}){from_}{more}.'
