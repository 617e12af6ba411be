"""A trained model on disk: its weights as safetensors, all else as JSON. No pickle.

    model.json             format, variant, columns and the learner
    weights.safetensors    the weights that are not zero, and where they are; likewise the prior and what is held

What is read is checked: format, shapes, finite numbers, labels, ids. A folder holds a whole model or none.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import ConfigDict, TypeAdapter, ValidationError
from pydantic.dataclasses import dataclass as checked
from safetensors import SafetensorError
from safetensors.numpy import load as load_bytes
from safetensors.numpy import save as to_bytes

from dcg_torch.fitting.psi import BINARY, TERNARY, LogLinearFactor
from dcg_torch.grounding.features import FeatureSet
from dcg_torch.learning.commit_first import CommitFirst
from dcg_torch.learning.learner import Learner
from dcg_torch.learning.word_posterior import WordPosterior
from dcg_torch.model.variant import Variant
from dcg_torch.storage.atomic_files import read_whole_files, write_whole_files
from dcg_torch.storage.errors import UserError
from dcg_torch.types import Correspondence
from dcg_torch.types.arrays import Bools, Floats

WEIGHTS, DESCRIPTION = "weights.safetensors", "model.json"
FORMAT = 2
"""Of the files; 1 was that of version 0.1, in which a model's kind was told by what else was there."""
_MOST_BEAM = 1000
_LEAST_L2 = 1e-6  # below it a fit is singular
_LARGEST = 1e6  # of a weight, an example's too: beyond it log-probabilities overflow or drown
_Arrays = dict[str, np.ndarray]


class CheckpointError(UserError):
    """A saved model that is missing or not valid; the message is one line."""


@checked(frozen=True, config=ConfigDict(defer_build=True))
class _Description:
    format: Literal[2]
    variant: Variant
    correspondences: tuple[Correspondence, ...]
    language: tuple[str, ...]
    grounding: tuple[str, ...]
    commit_first: CommitFirst | None = None
    word_posterior: WordPosterior | None = None


_ADAPTER = TypeAdapter(_Description)


@dataclass(frozen=True)
class Stored:
    """All that a model is: see `GroundingModel` for what each part is."""

    variant: Variant
    features: FeatureSet
    factor: LogLinearFactor
    learner: Learner
    prior: Floats | None
    held: Bools


def write(stored: Stored, directory: Path | str) -> None:
    """Write a model into `directory`, which is made if need be.

    Both files are of this model, or there is none: a kill in between never leaves one beside another model's.

    Raises:
        CheckpointError: no folder is named.
        OSError: it cannot be written there.
    """
    if not str(directory).strip():
        raise CheckpointError("a model is saved into a folder; give its name")
    directory = Path(directory)
    learner = stored.learner
    description = _Description(
        2,
        stored.variant,
        stored.factor.correspondences,
        tuple(stored.features.language),
        tuple(stored.features.grounding),
        learner if isinstance(learner, CommitFirst) else None,
        learner if isinstance(learner, WordPosterior) else None,
    )
    prior = np.zeros(0) if stored.prior is None else stored.prior
    tensors = _sparse("weight", stored.factor.weight.detach().cpu().numpy()) | _sparse("prior", prior)
    tensors |= {"held": np.flatnonzero(stored.held).astype(np.int32)}
    # Sets in their order of names, so that the same model gives the same bytes.
    text = json.dumps(_ADAPTER.dump_python(description), default=sorted)
    write_whole_files(directory, {WEIGHTS: to_bytes(tensors), DESCRIPTION: text.encode("utf-8")})


def read(directory: Path | str) -> Stored:
    """The model that `write` wrote.

    Raises:
        CheckpointError: a file is missing, broken, or does not fit the other.
    """
    directory = Path(directory)
    described, tensors = _parts(directory)
    shape = len(described.correspondences), len(described.language), len(described.grounding)
    tables = ({name: k for k, name in enumerate(names)} for names in (described.language, described.grounding))
    features = FeatureSet(described.variant.groups, *tables)
    if features.shape != shape[1:]:
        raise CheckpointError(f"{directory}: {DESCRIPTION} names a feature twice")
    try:
        factor = LogLinearFactor(features.pairs, described.correspondences)
    except KeyError as error:
        name = repr(error.args[0])[:80]
        raise CheckpointError(f"{directory}: {DESCRIPTION} names a feature of no family: {name}") from None
    learner = described.commit_first or described.word_posterior
    if learner is None or (described.commit_first and described.word_posterior):
        raise CheckpointError(f"{directory}: {DESCRIPTION} holds no learner, or two")
    _check(described, learner, directory)
    factor.set_weight(_dense("weight", tensors, shape, directory))
    if (tensors["held"] < 0).any() or (tensors["held"] >= math.prod(shape[1:])).any():
        raise CheckpointError(f"{directory}: {WEIGHTS} holds weights of columns that {DESCRIPTION} lacks")
    held = np.zeros(shape[1:], dtype=np.bool_)
    held.reshape(-1)[tensors["held"]] = True
    prior = _dense("prior", tensors, shape, directory)
    return Stored(described.variant, features, factor, learner, prior if prior.any() else None, held)


def _parts(directory: Path) -> tuple[_Description, _Arrays]:
    """Both files, of one saving even while another one goes on."""
    try:
        content = read_whole_files(directory, (WEIGHTS, DESCRIPTION))
    except FileNotFoundError as error:
        raise CheckpointError(f"{error.filename}: no saved model here; save one with model.save") from None
    except OSError as error:
        raise CheckpointError(f"{error.filename}: cannot be read: {error.strerror}") from None
    return _description(directory / DESCRIPTION, content[DESCRIPTION]), _tensors(directory / WEIGHTS, content[WEIGHTS])


def _description(path: Path, content: bytes) -> _Description:
    try:
        return _ADAPTER.validate_json(content)
    except ValidationError as error:
        where = ".".join(map(str, error.errors()[0]["loc"])) or "the file"
        if where == "format":
            said = f"its format is not {FORMAT}, the one that this version reads; make the model anew"
        else:
            said = f"not a saved model: {where[:80]}: {error.errors()[0]['msg'][:80]}"
        raise CheckpointError(f"{path}: {said}") from None


def _tensors(path: Path, content: bytes) -> _Arrays:
    try:
        tensors: _Arrays = load_bytes(content)
    except (SafetensorError, KeyError, ValueError):
        raise CheckpointError(f"{path}: not a file of weights; it may be cut short: save the model again") from None
    wanted = {"weight", "weight at", "prior", "prior at", "held"}
    if set(tensors) != wanted:
        raise CheckpointError(f"{path}: holds {len(tensors)} tensors, not the {len(wanted)} of a model")
    for name, tensor in tensors.items():
        kind = np.float64 if name in ("weight", "prior") else np.int32
        if tensor.dtype != kind or tensor.ndim != 1 or not np.isfinite(tensor).all():
            raise CheckpointError(f"{path}: {name} is not a list of finite numbers of the kind {np.dtype(kind)}")
        if kind is np.float64 and (np.abs(tensor) > _LARGEST).any():
            raise CheckpointError(f"{path}: {name} holds numbers beyond {_LARGEST:g}; no training gives such")
    return tensors


def _check(described: _Description, learner: CommitFirst | WordPosterior, directory: Path) -> None:
    """See that a model of this description can ground and learn."""
    variant, where = described.variant, directory / DESCRIPTION
    if described.correspondences != (TERNARY if variant.ternary else BINARY):
        raise CheckpointError(f"{where}: its correspondences are not those of its variant")
    if not _LEAST_L2 <= variant.l2 < math.inf or not 1 <= variant.beam <= _MOST_BEAM:
        raise CheckpointError(f"{where}: l2 must be at least {_LEAST_L2:g} and finite, beam from 1 to {_MOST_BEAM}")
    for number, example in enumerate(learner.examples):
        ids = {thing.id for thing in example.world.things}
        if len(example.correspondences) > len(example.world.things):
            raise CheckpointError(f"{where}: example {number} has more labels than things")
        if example.weights is not None and len(example.weights) < len(example.correspondences):
            raise CheckpointError(f"{where}: example {number} has fewer weights than labels")
        if any(c.grounding.object.id not in ids for c in example.children):
            raise CheckpointError(f"{where}: example {number} has a child about an object that is not in its world")
        if not all(abs(w) <= _LARGEST for w in (example.weight, *(example.weights or ()))):
            raise CheckpointError(f"{where}: example {number} has a weight that is not finite, or beyond {_LARGEST:g}")
    if isinstance(learner, WordPosterior):
        for beliefs in (learner.nouns, learner.colors):
            sums = [v for h in beliefs.heard.values() for v in (h.absent, *h.more.values())]
            met = set(beliefs.types)
            named = {*beliefs.settled.values(), *(t for h in beliefs.heard.values() for t in h.more)}
            if not np.isfinite(sums).all() or not named <= met:
                raise CheckpointError(f"{where}: the evidence about words is not finite, or of types never met")


def _sparse(name: str, tensor: np.ndarray) -> _Arrays:
    """The entries that are not zero, and where they are in the flattened tensor."""
    at = np.flatnonzero(tensor).astype(np.int32)
    return {name: tensor.reshape(-1)[at], f"{name} at": at}


def _dense(name: str, tensors: _Arrays, shape: tuple[int, ...], directory: Path) -> np.ndarray:
    at, values = tensors[f"{name} at"], tensors[name]
    if len(at) != len(values) or (at < 0).any() or (at >= math.prod(shape)).any():
        raise CheckpointError(f"{directory}: {WEIGHTS} and {DESCRIPTION} are not of one model")
    out = np.zeros(math.prod(shape))
    out[at] = values
    return out.reshape(shape)
