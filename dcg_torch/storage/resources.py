"""Where the files that come along are: `conf` and `worlds`, in a checkout or in an installed wheel."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent.parent


def resource(name: str) -> Path:
    """The folder `name` that came with this package: the wheel's copy if there is one, else the checkout's.

    Raises:
        FileNotFoundError: neither is there.
    """
    places = (_PACKAGE / "_data" / name, _PACKAGE.parent / name)
    for place in places:
        if place.is_dir():
            return place
    raise FileNotFoundError(f"{name}: in none of {', '.join(map(str, places))}; install the package again")
