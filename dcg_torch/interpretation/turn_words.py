"""The patterns of how two people speak in turns, from `turns.yaml`."""

from __future__ import annotations

import functools
import re

from dcg_torch.names.normal_form import read_data


@functools.cache
def pattern(name: str) -> re.Pattern[str]:
    """A pattern by its name, with its parts filled in."""
    data = read_data("turns.yaml")
    parts = {key: str(value) for key, value in data["parts"].items()}

    def filled(text: str) -> str:
        return re.sub(r"<([A-Z]+)>", lambda part: filled(parts[part[1]]), text)

    return re.compile(filled(str(data[name])), re.IGNORECASE | re.DOTALL)
