"""Devices that sums run on, by their names in torch."""

from __future__ import annotations

import torch

from dcg_torch.storage.errors import UserError


class DeviceError(UserError):
    """A device that is not there, or cannot do what is needed; the message is one line."""


def device_of(name: str) -> torch.device:
    """A device that has numbers, in float64.

    Args:
        name: "cpu", "cuda", "cuda:1" ...

    Raises:
        DeviceError: torch knows no such device, finds none here, or it has no float64.
    """
    try:
        device = torch.device(name)
        float(torch.zeros(1, dtype=torch.float64, device=device))
    except (RuntimeError, AssertionError, TypeError, NotImplementedError) as error:
        said = str(error).strip().split("\n")[0][:120]
        raise DeviceError(f"device={name[:40]}: torch cannot use it here ({said}); take device=cpu") from None
    return device
