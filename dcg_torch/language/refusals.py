"""What is no order about a thing: speech, counting, questions, greetings, following, waiting, bare motion."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from dcg_torch.language.clauses import BEFORE_VERB, Clause
from dcg_torch.language.items import Item, Kind
from dcg_torch.language.lexicon import REFUSALS, SETS, TALK, VERBS

NO_THING = "it names no thing"
NONE = "it asks for none of them"
MOTION = "it says how to move and names no thing to go to"


def talk(words: Sequence[str]) -> list[tuple[int, int, str]]:
    """The parts of a command that order nothing about a thing: first word, index behind the last, the reason."""
    out: list[tuple[int, int, str]] = []
    stops = [i for i, word in enumerate([*words, "."]) if word in SETS["stops"]]
    for before, stop in itertools.pairwise([-1, *stops]):
        # An address ("robot, ...") and politeness are no part of a sentence.
        said = [k for k in range(before + 1, stop) if words[k] not in SETS["before_sentences"]]
        text = " ".join(words[said[0] : said[-1] + 1]) if said else ""
        reason = next((reason for pattern, reason in REFUSALS if pattern.search(text)), None)
        if said and reason is not None:
            out.append((said[0], said[-1] + 1, reason))
    return out


def refuse(clause: Clause, items: Sequence[Item], parts: Sequence[tuple[int, int, str]], words: Sequence[str]) -> None:
    """Mark a clause that orders nothing about a thing.

    A clause is within one of the `parts`, unless an order begins in it; or it is talk by itself.
    """
    first = next((item for item in items if item.kind not in BEFORE_VERB - {Kind.NEGATION}), items[0])
    own = not first.start or words[first.start - 1] not in SETS["subordinates"]
    for start, stop, reason in parts:
        if start <= first.start < stop:
            acts = own and clause.verb is not None and not clause.verb.participle
            ordered = acts and clause.action in SETS["commands"] - VERBS["lesson"]
            clause.refused = None if ordered and first.start > start else reason
    if clause.refused is None and own:
        said = " ".join(words[first.start : items[-1].stop])
        clause.refused = next((reason for pattern, reason in TALK if pattern.search(said)), None)
