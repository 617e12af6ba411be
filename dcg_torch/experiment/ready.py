"""Imported by the process that runs trials or forks those that do: all that a trial needs, and the parser's words.

Next to nothing of what is imported is garbage, and to look for it all the while takes a tenth of the time.
"""

from __future__ import annotations

import gc

_COLLECTS = gc.isenabled()
gc.disable()

import dcg_torch.experiment.worker  # noqa: E402, F401
from dcg_torch.language import default_parser  # noqa: E402

default_parser().parse("go to the cube")
if _COLLECTS:
    gc.enable()
