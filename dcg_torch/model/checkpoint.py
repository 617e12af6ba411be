"""Models saved to a folder, and loaded; `serialization` says what the files hold."""

from __future__ import annotations

from pathlib import Path

from dcg_torch.model.core import GroundingModel
from dcg_torch.model.serialization import DESCRIPTION, FORMAT, WEIGHTS, CheckpointError, read


def save(model: GroundingModel, directory: Path | str) -> None:
    """The same as `model.save`."""
    model.save(directory)


def load(directory: Path | str, *, device: str = "cpu") -> GroundingModel:
    """The model that was saved: the same probabilities to the last bit, and ready to learn on.

    Args:
        device: see `GroundingModel.to`.

    Raises:
        CheckpointError: a file is missing, broken, or does not fit the other.
        DeviceError: torch cannot use the device here.
    """
    stored = read(directory)
    model = GroundingModel(stored.variant, stored.features, stored.factor, stored.learner)
    model.prior, model.held = stored.prior, stored.held
    return model.to(device)


__all__ = ["DESCRIPTION", "FORMAT", "WEIGHTS", "CheckpointError", "load", "save"]
