"""One thread for the fit: for problems of our sizes more are slower, and on a busy machine very much so."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Iterator

import torch
from threadpoolctl import ThreadpoolController


@functools.cache
def _libraries() -> ThreadpoolController:
    """The linear algebra that numpy and scipy have loaded; finding it takes milliseconds."""
    return ThreadpoolController()


@contextlib.contextmanager
def one_thread() -> Iterator[None]:
    """Let torch and BLAS use one thread in a `with` block, and as many as before after it."""
    before = torch.get_num_threads()
    counts = [(library, library.num_threads) for library in _libraries().lib_controllers]
    several = [(library, count) for library, count in counts if count != 1]  # mostly there are none
    for library, _ in several:
        library.set_num_threads(1)
    if before != 1:
        torch.set_num_threads(1)
    try:
        yield
    finally:
        if before != 1:
            torch.set_num_threads(before)
        for library, count in several:
            library.set_num_threads(count)
