"""Make the list of colour names of `dcg_torch/names/data` from the tables that matplotlib has.

    python tools/color_names.py

A line is a code and a name: the names of CSS, then those of the XKCD survey (R. Munroe 2010, public domain). Whoever
hears a command needs them, and matplotlib takes a quarter of a second to import.
"""

from __future__ import annotations

import sys

from matplotlib.colors import CSS4_COLORS, XKCD_COLORS

from dcg_torch.names.normal_form import DATA
from dcg_torch.names.palette import LISTED


def lines() -> list[str]:
    """The lines of the file."""
    named = [*CSS4_COLORS.items(), *XKCD_COLORS.items()]
    header = "# Colours by name, made by tools/color_names.py: of CSS, then of the XKCD survey (public domain)."
    return [header, *(f"{code} {name.removeprefix('xkcd:')}".lower() for name, code in named)]


if __name__ == "__main__":
    (DATA / LISTED).write_text("\n".join(lines()) + "\n", encoding="utf-8")
    sys.exit()
