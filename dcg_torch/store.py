"""A trained model on disk: its weights as safetensors, its symbols, columns and examples as JSON. No pickle."""

from __future__ import annotations

import json
import os
from pathlib import Path

import torch
from pydantic import TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass
from safetensors import SafetensorError
from safetensors.torch import load_file, save_file

from dcg_torch.features import FeatureSet
from dcg_torch.loglinear import LogLinearModel
from dcg_torch.model import GroundingModel, Variant
from dcg_torch.open_world import Mind, OpenWorldModel
from dcg_torch.symbols import Correspondence, Example, Symbol

WEIGHTS, DESCRIPTION = "weights.safetensors", "model.json"


class StoreError(ValueError):
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


_ADAPTER = TypeAdapter(_Description)


def save(model: GroundingModel, directory: Path) -> None:
    """Write a model into `directory`, which is made if need be; each file appears whole or not at all."""
    directory.mkdir(parents=True, exist_ok=True)
    description = _Description(
        model.variant,
        model.loglinear.correspondences,
        tuple(model.features.language),
        tuple(model.features.grounding),
        tuple(model.symbols.values()),
        tuple(model.examples),
        tuple(model.corpus),
        model.mind if isinstance(model, OpenWorldModel) else None,
    )
    weights, text = directory / WEIGHTS, directory / DESCRIPTION
    save_file({"weight": model.loglinear.weight.contiguous()}, f"{weights}.part")
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
        weight = load_file(directory / WEIGHTS)["weight"]
    except (ValidationError, SafetensorError, KeyError) as error:
        raise StoreError(f"{directory}: not a saved model: {' '.join(str(error).split())[:200]}") from None
    features = FeatureSet(
        described.variant.groups,
        {name: k for k, name in enumerate(described.language)},
        {name: k for k, name in enumerate(described.grounding)},
    )
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
    return GroundingModel(
        described.variant, described.symbols, described.examples, features, loglinear, described.corpus
    )
