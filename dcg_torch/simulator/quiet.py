"""Imports PyBullet without the line about its build that it writes to standard error.

Every worker process would write it into the progress bar. To be imported before any other module that imports
pybullet, so that a user who did nothing wrong reads nothing there.
"""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Iterator


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


with _standard_error_away():
    import pybullet  # noqa: F401
