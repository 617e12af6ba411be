"""Training files: symbols, colours and labelled examples, as in the hand-made `initial.yaml`."""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, ValidationError

from dcg_torch.grounding.features import GROUNDING_OF
from dcg_torch.learning.labelling import labelled
from dcg_torch.learning.learner import TrainingSet
from dcg_torch.scene.upsilon import world_model
from dcg_torch.storage.errors import UserError
from dcg_torch.storage.untrusted_files import Strict, at_home, problem_of, read_yaml, shown
from dcg_torch.types import Child, Correspondence, Example, Grounding, Percept, Phrase, PhraseKind, Symbol, WorldModel

_Words = Annotated[str, Field(strict=True, min_length=1, max_length=200, pattern=r"\S")]


class TrainingEntry(Strict):
    """One positive example: a command, its parse, what is seen ("red cube"), and which of it is meant.

    `means` is one of `see`, or "hypothetical cube" for a known type that is out of view, or "hypothetical unknown".
    `inverted` names the phrase that means the opposite of its grounding.
    """

    command: _Words
    verb: _Words
    negated: bool = Field(False, strict=True)
    preposition: _Words | None = None
    noun: _Words
    color: _Words | None = None
    see: tuple[_Words, ...]
    means: _Words
    inverted: Literal["verb", "preposition"] | None = None


class TrainingFile(Strict):
    """A training file: the words that are known with the types they name, the colours, and the examples."""

    symbols: dict[_Words, _Words] = Field(min_length=1)
    colors: tuple[_Words, ...]
    examples: tuple[TrainingEntry, ...] = Field(min_length=1)


class TrainingFileError(UserError):
    """A training file that is missing or not valid; the message is one line."""


def initial_training() -> TrainingSet:
    """The 53 hand-made positive examples, with the negatives they imply (Alg. 1, line 5)."""
    return read_training(Path(str(files(__package__).joinpath("initial.yaml"))))


def training_set(path: str | Path | None) -> TrainingSet:
    """The training set of a setting `training=FILE`; None is the one that comes along."""
    return initial_training() if path is None else read_training(at_home(path))


def read_training(path: str | Path) -> TrainingSet:
    """Read a training file.

    Raises:
        TrainingFileError: the file is absent, not YAML, or an entry of it is not valid.
    """
    path = Path(path)
    try:
        raw = TrainingFile.model_validate(read_yaml(path, "training file", TrainingFileError))
    except ValidationError as error:
        raise TrainingFileError(f"{path}: {problem_of(error, TrainingFile)}") from None
    types = tuple(dict.fromkeys(raw.symbols.values()))
    examples: list[Example] = []
    for number, entry in enumerate(raw.examples, start=1):
        try:
            examples += _examples(entry, types)
        except ValueError as error:
            raise TrainingFileError(f"{path}: example {number} ({shown(entry.command)}): {error}") from None
    return TrainingSet(tuple(Symbol(w, t) for w, t in raw.symbols.items()), raw.colors, tuple(examples))


def _examples(entry: TrainingEntry, known_types: tuple[str, ...]) -> list[Example]:
    """The noun phrase's example, the preposition's if there is one, and the verb's."""
    seen = world_model([_percept(text) for text in entry.see], known_types)
    world = WorldModel(tuple(replace(o, position=None) for o in seen.objects))  # a list of what is seen says no places
    found = [o for o in world.objects if o.id == entry.means]
    if len(found) != 1:
        some = ", ".join(shown(o.id) for o in world.objects[-12:])
        raise ValueError(f"means {shown(entry.means)}, which is not among {some}")
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
        raise ValueError(f"sees {shown(text)}; write a colour and a type, as in 'red cube'")
    return Percept(text, kind, color, (0.0, 0.0, 0.0))
