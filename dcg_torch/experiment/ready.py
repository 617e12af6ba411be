"""Imported by the process that runs trials or forks those that do: all that a trial needs, and the parser's words."""

from __future__ import annotations

import contextlib
import gc
from collections.abc import Iterator


@contextlib.contextmanager
def _uncollected() -> Iterator[None]:
    """What is made in a `with` block is there to stay: the collector does not look through it, now or later.

    To look for garbage among modules takes a tenth of the time that they take, and in every process that is forked it
    would copy them.
    """
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        if collects:
            gc.enable()


with _uncollected():
    import dcg_torch.experiment.worker  # noqa: F401
    from dcg_torch.language import default_parser

    default_parser().parse("go to the cube")
