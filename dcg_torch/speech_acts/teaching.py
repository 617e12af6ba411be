"""What a teacher's sentence says about names: "this is a pallet", "the thing behind you is called a wug"."""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass
from importlib.resources import files

import yaml

from dcg_torch.english.dictionary import english
from dcg_torch.language.parser import parse_command


@dataclass(frozen=True, slots=True)
class Teaching:
    """A name, and what it is the name of.

    Attributes:
        name: the noun, in the singular.
        subject: a phrase that describes the object; None: the one pointed at.
        same_as: another noun that names the same kind; then there is no object.
    """

    name: str
    subject: str | None = None
    same_as: str | None = None


@dataclass(frozen=True, slots=True)
class _Patterns:
    fillers: re.Pattern[str]
    pointing: frozenset[str]
    denying: frozenset[str]
    same: tuple[re.Pattern[str], ...]
    naming: tuple[re.Pattern[str], ...]


@functools.cache
def _patterns() -> _Patterns:
    data = yaml.safe_load(files(__package__).joinpath("data", "teaching.yaml").read_text("utf-8"))
    return _Patterns(
        re.compile(rf"(?:(?:{'|'.join(data['fillers'])})\b[ ,.!]*)+"),
        frozenset(data["pointing"]),
        frozenset(data["denying"]),
        *(tuple(re.compile(p) for p in data[kind]) for kind in ("same", "naming")),
    )


def read_teaching(text: str) -> Teaching | None:
    """What a sentence teaches; None if it is no teacher's sentence."""
    patterns = _patterns()
    said = " ".join(text.lower().replace("\u2019", "'").split()).strip(" .!?")
    if (filler := patterns.fillers.match(said)) is not None:
        said = said[filler.end() :]
    for pattern in patterns.same:
        if (found := pattern.fullmatch(said)) is not None:
            one, other = _noun(found["one"]), _noun(found["other"])
            return Teaching(other, same_as=one) if one and other else None
    for pattern in patterns.naming:
        found = pattern.fullmatch(said)
        if found is not None and found["name"].split(" ")[0] in patterns.denying:
            return None  # "this is not a lamp" tells no name
        if found is not None and "article" in pattern.groupindex and not found["article"] and _tells_how(found["name"]):
            return None  # "that is wrong"
        if found is not None and (name := _noun(found["name"])) is not None:
            subject = found["subject"]
            return Teaching(name, None if subject in patterns.pointing else subject)
    return None


def _tells_how(phrase: str) -> bool:
    """Whether words without an article say how or where a thing is: the last is an adjective or adverb sooner than a
    noun ("wrong", "too far"), or the first an adverb ("on fire")."""
    first, *_, last = [dict(english().get(word, {})) for word in (phrase.split() * 2)]
    noun = last.get("n", -1)
    return max(last.get("a", -1), last.get("r", -1)) > noun or first.get("r", -1) > max(first.get("n", -1), 0)


def _noun(phrase: str) -> str | None:
    """The noun of a phrase, in the singular."""
    return parse_command(f"go to the {phrase}").noun
