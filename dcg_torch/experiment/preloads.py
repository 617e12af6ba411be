"""All imports that a trial needs, and the parser's words: for the process that runs trials or forks those."""

from __future__ import annotations

import contextlib
import gc
from collections.abc import Iterator


@contextlib.contextmanager
def _uncollected() -> Iterator[None]:
    """The collector rests in a `with` block: to look for garbage among modules takes a tenth of the time they take.

    What is there at the end stays for good, so that no process that is forked looks through it and copies it.
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
