"""The text of String messages: plain, or a JSON object whose id tells a message sent twice from one said twice."""

from __future__ import annotations

import json
import re
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from dcg_torch.agent.asking import Question, Reply
from dcg_torch.grounding.solution import Solution
from dcg_torch.storage.untrusted_files import plain

LONGEST = 2_000
"""Characters of a note, at the most."""
_NO = {"no", "none", "none of them", "neither"}
_ORDINALS = ("first", "second", "third", "fourth", "fifth")


class BadNoteError(ValueError):
    """A message that is no note; the message is one line."""


class Note(BaseModel):
    """What somebody said: `id` may be left out, and so may the id of the object that is pointed at."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)
    text: str = Field(min_length=1, max_length=1_000, pattern=r"\S")
    id: str | None = Field(default=None, min_length=1, max_length=100)
    pointing_at: str | None = Field(default=None, max_length=100)


def read_note(data: str) -> Note:
    """The note of a message.

    Raises:
        BadNoteError: it is empty, too long, or JSON of another form.
    """
    if len(data) > LONGEST:
        raise BadNoteError(f"{len(data)} characters; say it in at most {LONGEST}")
    try:
        if data.lstrip().startswith("{"):
            return Note.model_validate_json(data)
        return Note(text=" ".join(data.split()))
    except ValidationError as error:
        where = ".".join(map(str, error.errors()[0]["loc"])) or "the message"
        raise BadNoteError(f"{plain(where)}: {plain(error.errors()[0]['msg'], 100)}") from None


def read_correction(text: str) -> tuple[str, str]:
    """The word and the type of "WORD = TYPE".

    Raises:
        BadNoteError: it has another form.
    """
    word, equals, type_ = (" ".join(part.split()) for part in text.partition("="))
    if not (word and equals and type_):
        raise BadNoteError("a correction is written WORD = TYPE, as in: pallet = euro pallet")
    return word.lower(), type_


def read_reply(text: str, question: Question) -> Reply | None:
    """What an answer means: an id, "yes", "no", "the second one"; None where it answers nothing."""
    said = text.strip()
    words = re.findall(r"\w+", said.lower())
    if said in question.candidates:
        return Reply(said)
    if " ".join(words) in _NO:
        return Reply(None)
    named = [k for k, ordinal in enumerate(_ORDINALS[: len(question.candidates)]) if ordinal in words]
    if len(named) == 1:
        return Reply(question.candidates[named[0]])
    return Reply(question.candidates[0]) if words[:1] == ["yes"] and len(question.candidates) == 1 else None


def understood(note: Note, solution: Solution, most: int = 20) -> dict[str, Any]:
    """What a command is taken to mean, for others to read; the `most` probable objects."""
    noun, thing = solution.noun, solution.object
    ranked = sorted(solution.probabilities.items(), key=lambda item: (-item[1], item[0]))[:most]
    return {
        "id": note.id,
        "text": note.text,
        "noun": None if noun is None else noun.noun,
        "color": None if noun is None else noun.color,
        "object": None if thing is None or thing.hypothetical else thing.id,
        "unseen": thing is not None and thing.hypothetical,
        "away": solution.inverted,
        "probability": solution.probability,
        "probabilities": dict(ranked),
    }


def to_text(content: dict[str, Any]) -> str:
    """A reply as JSON in one line."""
    return json.dumps(content, ensure_ascii=False, allow_nan=False)
