"""A trained model on disk: its weights as safetensors, its symbols, columns and examples as JSON. No pickle.

Of a `LexicalModel` the corpus is kept as its sufficient statistics, beside the weights.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import torch
from pydantic import TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass
from safetensors import SafetensorError
from safetensors.torch import load_file, save_file

from dcg_torch.errors import UserError
from dcg_torch.grounding.encoding import Statistics
from dcg_torch.grounding.features import FeatureSet
from dcg_torch.grounding.psi import LogLinearModel, Merged
from dcg_torch.lexical import LexicalModel
from dcg_torch.model import GroundingModel, Variant
from dcg_torch.open_world import Mind, OpenWorldModel
from dcg_torch.relational import Workspace
from dcg_torch.types import Correspondence, Example, Symbol
from dcg_torch.words import Words

WEIGHTS, DESCRIPTION = "weights.safetensors", "model.json"


class StoreError(UserError):
    """A saved model that is missing or not valid; the message is one line."""


@dataclass(frozen=True)
class _Description:
    variant: Variant
    correspondences: tuple[Correspondence, ...]
    language: tuple[str, ...]
    grounding: tuple[str, ...]
    symbols: tuple[Symbol, ...]
    examples: tuple[Example, ...]
    corpus: tuple[Example, ...] = ()
    mind: Mind | None = None
    words: Words | None = None
    workspace: Workspace | None = None
    apart: tuple[tuple[str, ...], tuple[str, ...]] | None = None  # the columns of a corpus's statistics
    places: tuple[str, ...] = ()


_PARTS = ("language", "grounding", "phrase", "count")
_ADAPTER = TypeAdapter(_Description)


def save(model: GroundingModel, directory: Path) -> None:
    """Write a model into `directory`, which is made if need be; each file appears whole or not at all."""
    directory.mkdir(parents=True, exist_ok=True)
    tensors = {"weight": model.loglinear.weight.contiguous()}
    words, workspace, statistics = None, None, None
    if isinstance(model, LexicalModel):
        words, workspace, statistics = model.words, model.workspace, model.statistics
        for k, part in enumerate(statistics.parts):
            tensors |= {f"{name} {k}": torch.from_numpy(np.ascontiguousarray(getattr(part, name))) for name in _PARTS}
    description = _Description(
        model.variant,
        model.loglinear.correspondences,
        tuple(model.features.language),
        tuple(model.features.grounding),
        tuple(model.symbols.values()),
        tuple(model.examples),
        () if isinstance(model, LexicalModel) else tuple(model.corpus),
        model.mind if isinstance(model, OpenWorldModel) else None,
        words,
        workspace,
        None if statistics is None else (tuple(statistics.features.language), tuple(statistics.features.grounding)),
        tuple(sorted(statistics.places)) if statistics else (),
    )
    weights, text = directory / WEIGHTS, directory / DESCRIPTION
    save_file(tensors, f"{weights}.part")
    # Sets in their order of names, so that the same model gives the same bytes.
    Path(f"{text}.part").write_text(json.dumps(_ADAPTER.dump_python(description), default=sorted), encoding="utf-8")
    os.replace(f"{weights}.part", weights)
    os.replace(f"{text}.part", text)


def load(directory: Path) -> GroundingModel:
    """The model that `save` wrote: the same probabilities to the last bit, and ready to learn on.

    Raises:
        StoreError: a file is missing, broken, or does not fit the other.
    """
    for name in (DESCRIPTION, WEIGHTS):
        if not (directory / name).is_file():
            raise StoreError(f"{directory / name}: no saved model here; save one with dcg_torch.save")
    try:
        described = _ADAPTER.validate_json((directory / DESCRIPTION).read_bytes())
        tensors = load_file(directory / WEIGHTS)
        weight = tensors["weight"]
    except (ValidationError, SafetensorError, KeyError) as error:
        raise StoreError(f"{directory}: not a saved model: {' '.join(str(error).split())[:200]}") from None
    features = _features(described.variant, described.language, described.grounding)
    expected = (len(described.correspondences), len(described.language), len(described.grounding))
    if tuple(weight.shape) != expected or weight.dtype != torch.float64:
        raise StoreError(
            f"{directory}: weights of {weight.dtype} and shape {tuple(weight.shape)}, not float64 and {expected}; "
            f"{WEIGHTS} and {DESCRIPTION} are not of one model"
        )
    if features.shape != expected[1:]:
        raise StoreError(f"{directory}: {DESCRIPTION} names a feature twice")
    try:
        pairs = features.pairs
    except KeyError as error:
        raise StoreError(f"{directory}: {DESCRIPTION} names features that do not exist: {error}") from None
    loglinear = LogLinearModel(pairs, described.correspondences)
    loglinear.weight = weight
    if described.mind is not None:
        return OpenWorldModel(
            described.variant, described.symbols, described.examples, features, loglinear, mind=described.mind
        )
    if described.words is not None and described.apart is not None:
        lexical = LexicalModel(
            described.variant,
            described.symbols,
            described.examples,
            features,
            loglinear,
            words=described.words,
            statistics=_statistics(described, tensors, directory),
        )
        lexical.workspace = described.workspace
        return lexical
    return GroundingModel(
        described.variant, described.symbols, described.examples, features, loglinear, described.corpus
    )


def _features(variant: Variant, language: tuple[str, ...], grounding: tuple[str, ...]) -> FeatureSet:
    """The columns of these names, in their order."""
    tables = ({name: k for k, name in enumerate(names)} for names in (language, grounding))
    return FeatureSet(variant.groups, *tables)


def _statistics(described: _Description, tensors: dict[str, torch.Tensor], directory: Path) -> Statistics:
    assert described.apart is not None
    numbers = sorted(int(name.split()[1]) for name in tensors if name.startswith("count "))
    try:
        parts = tuple(Merged(*(tensors[f"{name} {k}"].numpy() for name in _PARTS)) for k in numbers)
    except KeyError as error:
        raise StoreError(f"{directory}: {WEIGHTS} lacks {error} of the corpus") from None
    return Statistics(_features(described.variant, *described.apart), parts, frozenset(described.places))
