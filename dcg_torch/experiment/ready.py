"""Imported by the process that workers are forked from: all that a trial needs, and the parser's words."""

from __future__ import annotations

import dcg_torch.experiment.worker  # noqa: F401
from dcg_torch.language import default_parser

default_parser().parse("go to the cube")
