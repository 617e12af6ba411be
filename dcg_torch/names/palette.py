"""Colour words as graded regions of a colour space: where in it the things lie that a word is said of.

The space is CIELAB (CIE 15:2004, for D65 and sRGB, IEC 61966-2-1) with chroma compressed as in the CIE94 difference
formula, so that equal steps look about equal among vivid colours too: L* is lightness, 0 to 100; chroma, the distance
from the gray axis, is 0 to about 80. A region is a Student distribution, for people use words loosely. Its mean and
spread come from the names of the XKCD survey (R. Munroe 2010, public domain): that of "blue" from all names that end in
blue.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dcg_torch.names.normal_form import DATA, normalise, read_data

Array = NDArray[np.float64]

LISTED = "listed_colors.txt"
"""The file of names of CSS and of the survey, which `tools/color_names.py` makes; of two alike the later one counts."""
_SPREAD = (24.0, 18.0, 18.0)  # of L*, a*, b*, in a region of which no more is known
_FREEDOM = 4.0  # of the Student distribution
_CIE94 = 0.045  # how fast differences of chroma shrink as chroma grows
_SCALE = 1.9  # keeps chroma 40, a usual one, about where it was


def lab(rgb: Array) -> Array:
    """CIELAB of sRGB colours, chroma compressed.

    Args:
        rgb: (..., 3), each 0 to 255.

    Returns:
        (..., 3): L*, a*, b*.
    """
    part = np.asarray(rgb, dtype=np.float64) / 255.0
    linear = np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)
    matrix = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    xyz = linear @ matrix.T / np.array([0.9505, 1.0, 1.089])
    f = np.where(xyz > (6 / 29) ** 3, np.cbrt(xyz), xyz / (3 * (6 / 29) ** 2) + 4 / 29)
    a, b = 500 * (f[..., 0] - f[..., 1]), 200 * (f[..., 1] - f[..., 2])
    chroma = np.maximum(np.hypot(a, b), 1e-9)
    compress = _SCALE * np.log1p(_CIE94 * chroma) / (_CIE94 * chroma)
    return np.stack([116 * f[..., 1] - 16, compress * a, compress * b], axis=-1)


@dataclass(frozen=True, slots=True)
class Region:
    """Where in CIELAB the things lie that a word is said of: mean and standard deviation of L*, a*, b*."""

    mean: tuple[float, float, float]
    spread: tuple[float, float, float] = _SPREAD

    def log_density(self, colors: Array) -> Array:
        """(n,) the log-density of colours (n, 3) in CIELAB, up to a constant."""
        apart = (colors - np.array(self.mean)) / np.array(self.spread)
        density: Array = -0.5 * (_FREEDOM + 3.0) * np.log1p((apart**2).sum(axis=1) / _FREEDOM)
        return density


@functools.cache
def listed_colors() -> dict[str, tuple[float, float, float]]:
    """Every listed name in normal form, and its colour in CIELAB; the survey's names go before those of CSS."""
    named = _listed_rgb()
    return {name: _triple(v) for name, v in zip(named, lab(np.array(list(named.values()))), strict=True)}


@functools.cache
def _listed_rgb() -> dict[str, tuple[float, float, float]]:
    lines = (line for line in (DATA / LISTED).read_text(encoding="utf-8").splitlines() if line[:2] != "# ")
    named = {normalise(name): code for code, _, name in (line.partition(" ") for line in lines)}
    return {name: _triple(np.array(list(bytes.fromhex(code[1:])), dtype=np.float64)) for name, code in named.items()}


def named_rgb(name: str) -> tuple[float, float, float] | None:
    """What a thing of a listed colour looks like, 0 to 255 each; None where the name is not listed.

    >>> named_rgb("Black")
    (0.0, 0.0, 0.0)
    """
    return _listed_rgb().get(normalise(name))


@dataclass(frozen=True)
class ColorWords:
    """The words of `data/colors.yaml`."""

    basic: frozenset[str]
    alike: dict[str, str]
    exchanged: frozenset[frozenset[str]]
    axes: dict[str, dict[str, float]]
    signs: dict[str, tuple[str, ...]]


@functools.cache
def color_words() -> ColorWords:
    """What the data file says, read at the first call."""
    data = read_data("colors.yaml")
    lists = ("not", "more", "less", "until", "either", "middle", "middle of places", "shade")
    signs = {key: tuple(map(str, data[key])) for key in lists}
    exchanged = frozenset(frozenset(map(str, pair)) for pair in data["exchanged"])
    return ColorWords(frozenset(data["basic"]), data["alike"], exchanged, data["axes"], signs)


@functools.lru_cache(maxsize=4096)
def region(name: str) -> Region | None:
    """The region of a colour name in normal form; None if nothing tells where it is.

    A basic term has the region of all names that end in it, a listed name one around its colour, and a word that is
    only part of names ("army") one around their mean.
    """
    words, listed = color_words(), listed_colors()
    name = words.alike.get(name, name)
    if name in words.basic:
        values = np.array([v for other, v in listed.items() if other.split(" ")[-1] == name and _plain(other)])
        own = np.array(listed[name]) if name in listed else values.mean(axis=0)
        mean, n = (values.sum(axis=0) + 4.0 * own) / (len(values) + 4.0), len(values)
        spread = np.sqrt((((values - mean) ** 2).sum(axis=0) + 8.0 * np.array(_SPREAD) ** 2) / (n + 8.0))
        return Region(_triple(mean), _triple(spread))
    if name in listed:
        return Region(listed[name])
    if " " in name or name in words.axes:
        return None
    partly = [v for other, v in listed.items() if name in other.split(" ")]
    return Region(_triple(np.mean(partly, axis=0))) if partly else None


def _plain(name: str) -> bool:
    """Is a name free of words for grayish shades, which would draw the region of its last word to gray?"""
    return not {"gray", "grayish", "dusty", "dull", "muddy", "dirty", "faded", "muted"} & set(name.split(" ")[:-1])


def _triple(values: Array) -> tuple[float, float, float]:
    return float(values[0]), float(values[1]), float(values[2])


def color_log_likelihood(word: str, rgb: Sequence[float]) -> float:
    """The log-density of one colour in the region of a name, 0 at its middle; 0 too for a name that is unknown.

    Args:
        word: a colour name of one word or several.
        rgb: 0 to 255 each.
    """
    found = region(normalise(word))
    return 0.0 if found is None else float(found.log_density(lab(np.asarray(rgb, dtype=np.float64)[None]))[0])
