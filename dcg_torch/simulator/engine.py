"""PyBullet, for all modules of this room; the only place that imports it.

It writes a line about its build to standard error as it is imported, which every worker process would print into the
progress bar. That line is thrown away here. Where PyBullet is not installed, the error says so in one line.
"""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator

from dcg_torch.simulator.errors import SimulatorError

__all__ = ["pybullet"]


@contextlib.contextmanager
def _standard_error_away() -> Iterator[None]:
    """Throw away what C code writes to standard error meanwhile."""
    sys.stderr.flush()
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)


try:
    with _standard_error_away():
        import pybullet
except ModuleNotFoundError:
    raise SimulatorError(
        "simulator=pybullet needs PyBullet, which is not installed: pip install pybullet, or take simulator=fake"
    ) from None
