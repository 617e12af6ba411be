"""Colour names to paint."""

from __future__ import annotations

import functools
from typing import Final

RGB = tuple[float, float, float]

# The paper's colours and the two extremes, toned so that shading stays visible on them.
_OWN: Final[dict[str, RGB]] = {
    "red": (0.86, 0.10, 0.10),
    "green": (0.10, 0.62, 0.18),
    "blue": (0.12, 0.28, 0.86),
    "black": (0.13, 0.13, 0.14),
    "white": (0.95, 0.95, 0.95),
}


@functools.cache
def rgb(color: str) -> RGB:
    """Red, green and blue in [0, 1] of a colour name.

    Knows the project's own colours, the XKCD survey's names ("sky blue"), CSS names and "#rrggbb".

    Raises:
        ValueError: no such colour.
    """
    name = " ".join(color.lower().split())
    if name in _OWN:
        return _OWN[name]
    from matplotlib.colors import to_rgb  # here, because it costs a tenth of a second to import

    for spelling in (f"xkcd:{name}", name.replace(" ", "")):
        try:
            red, green, blue = to_rgb(spelling)
        except ValueError:
            continue
        return red, green, blue
    raise ValueError(f"no colour named {color!r}; use an XKCD or CSS colour name such as 'teal', or '#rrggbb'")
