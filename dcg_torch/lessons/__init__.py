"""The hand-made initial training set, and the reader of files like it."""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Literal

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from dcg_torch.grounding.features import GROUNDING_OF
from dcg_torch.learning.labelling import labelled
from dcg_torch.learning.learner import TrainingSet
from dcg_torch.scene.upsilon import world_model
from dcg_torch.types import (
    Child,
    Correspondence,
    Example,
    Grounding,
    Percept,
    Phrase,
    PhraseKind,
    Symbol,
    WorldModel,
)


class _Strict(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class _Entry(_Strict):
    command: str
    verb: str
    negated: bool = False
    preposition: str | None = None
    noun: str
    color: str | None = None
    see: tuple[str, ...]
    means: str
    inverted: Literal["verb", "preposition"] | None = None


class _File(_Strict):
    symbols: dict[str, str] = Field(min_length=1)
    colors: tuple[str, ...]
    examples: tuple[_Entry, ...] = Field(min_length=1)


class TrainingFileError(ValueError):
    """A training file that is missing or not valid; the message is one line."""


def initial_training() -> TrainingSet:
    """The 53 hand-made positive examples, with the negatives they imply (Alg. 1, line 5)."""
    return read_training(Path(str(files(__package__).joinpath("initial.yaml"))))


def read_training(path: Path) -> TrainingSet:
    """Read a training file.

    Raises:
        TrainingFileError: the file is absent, not YAML, or an entry of it is not valid.
    """
    try:
        raw = _File.model_validate(yaml.safe_load(path.read_text(encoding="utf-8")))
    except FileNotFoundError:
        raise TrainingFileError(f"{path}: no such training file") from None
    except (UnicodeDecodeError, yaml.YAMLError) as error:
        raise TrainingFileError(f"{path}: not readable as YAML: {' '.join(str(error).split())}") from None
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "the file"
        raise TrainingFileError(f"{path}: {where}: {first['msg']}") from None
    types = tuple(dict.fromkeys(raw.symbols.values()))
    examples: list[Example] = []
    for number, entry in enumerate(raw.examples, start=1):
        try:
            examples += _examples(entry, types)
        except ValueError as error:
            raise TrainingFileError(f"{path}: example {number} ({entry.command!r}): {error}") from None
    return TrainingSet(tuple(Symbol(w, t) for w, t in raw.symbols.items()), raw.colors, tuple(examples))


def _examples(entry: _Entry, known_types: tuple[str, ...]) -> list[Example]:
    """The noun phrase's example, the preposition's if there is one, and the verb's."""
    seen = world_model([_percept(text) for text in entry.see], known_types)
    world = WorldModel(tuple(replace(o, position=None) for o in seen.objects))  # a list of what is seen says no places
    found = [o for o in world.objects if o.id == entry.means]
    if len(found) != 1:
        raise ValueError(f"means {entry.means!r}, which is not among {[o.id for o in world.objects]}")
    phrases = [Phrase(PhraseKind.NOUN, entry.noun, noun=entry.noun, color=entry.color)]
    if entry.preposition is not None:
        phrases.append(Phrase(PhraseKind.PREPOSITION, entry.preposition, (entry.preposition,)))
    verb = (entry.verb, "not") if entry.negated else (entry.verb,)
    phrases.append(Phrase(PhraseKind.VERB, entry.verb, verb))
    examples: list[Example] = []
    children: tuple[Child, ...] = ()
    for phrase in phrases:
        sign = Correspondence.INVERTED if entry.inverted == phrase.kind.value else Correspondence.ACTIVE
        meant = Child(Grounding(GROUNDING_OF[phrase.kind], found[0]), sign)
        examples.append(labelled(phrase, meant, children, world))
        children = (meant,)
    return examples


def _percept(text: str) -> Percept:
    """A percept from "red fire hydrant"."""
    color, _, kind = text.partition(" ")
    if not kind:
        raise ValueError(f"sees {text!r}; write a colour and a type, as in 'red cube'")
    return Percept(text, kind, color, (0.0, 0.0, 0.0))
