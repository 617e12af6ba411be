"""Descriptions of colours: which of several in view fits "the darker one", "more purple", "bluish gray", "not pink"."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from dcg_torch.names.normal_form import normalise
from dcg_torch.names.palette import Array, Region, color_words, lab, listed_colors, region

FEATURES: Final = ("region", "not region", "tinge", "lightness", "chroma", "compared hue")
"""What the columns of `color_features` say; see there."""
WEIGHTS: Final = (1.0, 1.0, 0.5, 1.5, 1.5, 1.0)
"""The shipped weight of each; they can be learned from use."""
_VIVID = 60.0  # chroma of a vivid colour
_ONE_COLOR = 10.0  # distance up to which several things are of one colour
_GRAYISH = 7.0  # chroma up to which the mean of a region is gray
_COMPARED = 1.5  # log-density by which one of "the darker gray ones" may stay behind the grayest: all are compared
_TYPICAL = 15.0  # differences of lightness or chroma between patches are measured in this


@dataclass(frozen=True, slots=True)
class _Term:
    """One thing that a description says: a column of `FEATURES`, what of, and with which sign.

    Attributes:
        feature: "axes" is of both columns of axes, and so is "middle", of what is near the median of the scene.
        compares: does it ask for more, or the most, of an axis: "darker", "brightest"?
        denied: 0 for what is said of the thing that is meant; what is denied together has the same number.
    """

    feature: str
    region: Region | None = None
    axes: tuple[tuple[str, float], ...] = ()
    sign: float = 1.0
    compares: bool = False
    denied: int = 0


@functools.lru_cache(maxsize=4096)
def _terms(words: tuple[str, ...]) -> tuple[_Term, ...]:
    signs, found = color_words().signs, []
    denials, denied, degree, k = 0, False, 0.0, 0
    while k < len(words):
        word = words[k].lower()
        if word in signs["until"]:
            denied, degree = False, 0.0
        elif word in signs["not"] or (denied and word in signs["either"]):
            denied, denials, degree = True, denials + 1, 0.0
        elif (middle := middle_shade(words[k:])) is not None:
            found.append(replace(middle, denied=denials if denied else 0))
        elif word in signs["more"] or word in signs["less"]:
            degree = 1.0 if word in signs["more"] else -1.0
        else:
            term, length = _term(words, k, degree)
            if term is not None:
                found.append(replace(term, denied=denials) if denied else term)
                degree = 0.0
            k += length - 1
        k += 1
    return tuple(found)


def middle_shade(words: Sequence[str]) -> _Term | None:
    """What words say that begin with "medium green" or "middle purple shade": neither the dark nor the vivid one.

    None of other words: "the middle green one" stands in the middle.
    """
    signs, k = color_words().signs, 1
    if not words or words[0].lower() not in signs["middle"]:
        return None
    while k < len(words) and _stem(normalise(words[k]))[0] in color_words().basic:
        k += 1
    shade = k < len(words) and words[k].lower() in signs["shade"]
    named = k > 1 and words[0].lower() not in signs["middle of places"]
    return _Term("middle", axes=(("lightness", 1.0), ("chroma", 1.0))) if shade or named else None


def comparing_words(words: Sequence[str]) -> tuple[str, ...]:
    """Those of some words that compare colours: "darkest", "light", "bluer".

    >>> comparing_words(("big", "darkest", "one"))
    ('darkest',)
    """
    return tuple(w for w in words if _compares(w))


@functools.lru_cache(maxsize=4096)
def is_shade(words: tuple[str, ...]) -> bool:
    """Do words say more of a colour than names: "dull green", "bluish", "the darker red"?

    >>> is_shade(("the", "green", "one")), is_shade(("the", "dull", "green", "one"))
    (False, True)
    """
    return any(term.feature != "region" or term.axes for term in _terms(words) if not term.denied)


@functools.lru_cache(maxsize=4096)
def _compares(word: str) -> bool:
    name = normalise(word)
    if " " not in name:
        stem, form = _stem(name)
        if form != "er" and stem not in color_words().axes:
            return False  # most words: no list of colours is asked for them
    return any(term.feature in ("axes", "compared hue") for term in _terms((word,)))


def _term(words: tuple[str, ...], start: int, degree: float) -> tuple[_Term | None, int]:
    """The term that begins at a word, and of how many words it is."""
    for length in (3, 2):
        name = normalise(" ".join(words[start : start + length]))
        if len(name.split(" ")) == length and name in listed_colors() and not degree:
            first = normalise(words[start])
            grayish = "gray" in name.split(" ")
            axes = () if grayish else tuple(color_words().axes.get(first, {}).items())
            return _Term("region", region(name), axes), length
    stem, form = _stem(normalise(words[start]))
    axes = tuple(color_words().axes.get(stem, {}).items()) if stem != "gray" or form == "er" else ()
    if axes:
        return _Term("axes", None, axes, degree or 1.0, compares=bool(degree) or form == "er"), 1
    found = region(stem)
    if found is None:
        return None, 1
    if degree or form == "er":
        return _Term("compared hue", found, (), degree or 1.0), 1
    return _Term("tinge" if form == "ish" else "region", found), 1


def _stem(word: str) -> tuple[str, str]:
    """A word without its ending, and which ending it was: "ish", "er" (also "est") or none."""
    known = color_words()
    for ending, form in (("est", "er"), ("er", "er"), ("ish", "ish"), ("ey", "ish"), ("y", "ish"), ("s", "")):
        if not word.endswith(ending) or len(word) < len(ending) + 3:
            continue
        base = word[: -len(ending)]
        for stem in (base, base + "e", re.sub(r"(.)\1$", r"\1", base), re.sub("i$", "y", base)):
            if known.alike.get(stem, stem) in known.basic or stem in known.axes:
                return known.alike.get(stem, stem), form
    return known.alike.get(word, word), ""


def color_features(words: Sequence[str], rgbs: Array) -> Array:
    """What a description says of each of several colours that are in view together.

    Args:
        words: of the description in their order, punctuation as words of its own.
        rgbs: (n, 3), each 0 to 255.

    Returns:
        (n, 6), a column each of `FEATURES`: the log-density of the regions named; log(1 - share) of those denied;
        how far a colour tends to a hue that is a tinge ("bluish"); lightness and chroma, in the direction of the words
        ("darker", "bright"); how far it tends to a hue compared ("pinker", "more blue"). All but the first two are
        relative to the mean of the scene.
    """
    colors, terms = lab(rgbs), _terms(tuple(words))
    found = _said([term for term in terms if not term.denied], colors)
    for number in sorted({term.denied for term in terms} - {0}):
        found[:, FEATURES.index("not region")] += _denial([t for t in terms if t.denied == number], colors)
    return found


def _said(terms: Sequence[_Term], colors: Array) -> Array:
    """(n, 6), the columns of what is said of colours (n, 3) in CIELAB."""
    found = np.zeros((len(colors), len(FEATURES)))
    axes = {"lightness": colors[:, 0], "chroma": np.hypot(colors[:, 1], colors[:, 2])}
    compared = any(term.compares for term in terms)
    for term in terms:
        if term.region is not None:
            found[:, FEATURES.index(term.feature)] += _of_region(term, term.region, colors, compared)
        for axis, amount in term.axes:
            value = axes[axis]
            value = -abs(value - np.median(value)) if term.feature == "middle" else value
            found[:, FEATURES.index(axis)] += term.sign * amount * (value - value.mean()) / _TYPICAL
    fits = found[:, FEATURES.index("region")]
    if compared and fits.any():
        fits[:] = -np.logaddexp(0.0, fits.max() - _COMPARED - fits)
    return found


def _denial(terms: Sequence[_Term], colors: Array) -> Array:
    """(n,) the log of how far each colour is not what is denied: "not bright blue" denies only what is both."""
    fits = _said(terms, colors) @ np.array(WEIGHTS)
    share = np.exp(fits - fits.max())
    alike = np.linalg.norm(colors[:, None] - colors[None], axis=2) < _ONE_COLOR
    whole = (share / alike.sum(axis=1)).sum()  # several of one colour are denied as one is
    denied: Array = np.log1p(-0.95 * np.minimum(1.0, share / whole))
    return denied


def _of_region(term: _Term, of: Region, colors: Array, compared: bool) -> Array:
    if term.feature == "region":
        return of.log_density(colors) + (0.0 if compared else _told_from_grays(of, colors))
    hue = np.array([0.0, *of.mean[1:]])
    length = float(np.linalg.norm(hue))
    # What tends to a hue is what lies near its vivid form; gray, white and black have none, and are it themselves.
    goal, scale = (hue * (_VIVID / length), (0.0, 1.0, 1.0)) if length > 10.0 else (np.array(of.mean), (1.0, 1.0, 1.0))
    toward = -np.linalg.norm((colors - goal) * np.array(scale), axis=1)
    result: Array = term.sign * (toward - toward.mean()) / _TYPICAL
    return result


@functools.cache
def _grays() -> tuple[Region, ...]:
    return tuple(found for name in ("black", "dark gray", "gray", "light gray", "white") if (found := region(name)))


def _told_from_grays(of: Region, colors: Array) -> Array:
    """Of a gray, black or white: the log-probability of that word rather than of another such, for each colour.

    What is black is told from what is dark gray more sharply than either looks typical.
    """
    if math.hypot(*of.mean[1:]) > _GRAYISH:
        return np.zeros(len(colors))
    own, *others = (_narrow(one).log_density(colors) for one in (of, *(g for g in _grays() if g != of)))
    rival: Array = own - np.logaddexp.reduce([own, *others], axis=0)
    return rival


@functools.lru_cache(maxsize=4096)
def looks_like(word: str, rgb: tuple[float, float, float]) -> bool:
    """Is a word for a colour the best of the basic words, or of those for grays, for what something looks like?

    >>> looks_like("black", (20, 20, 20)), looks_like("black", (80, 80, 80)), looks_like("red", (200, 30, 30))
    (True, False, True)
    """
    of, colors = region(normalise(word)), lab(np.array([rgb], dtype=np.float64))
    if of is None:
        return False
    if math.hypot(*of.mean[1:]) <= _GRAYISH:
        return bool(_told_from_grays(of, colors)[0] > math.log(0.5))
    others = [other for name in color_words().basic if (other := region(name)) is not None]
    return all(of.log_density(colors)[0] >= other.log_density(colors)[0] for other in others)


def _narrow(of: Region) -> Region:
    wide, red, yellow = of.spread
    return Region(of.mean, (wide / 2.0, red / 2.0, yellow / 2.0))


def color_scores(words: Sequence[str], rgbs: Array, weights: Sequence[float] = WEIGHTS) -> Array:
    """How well a description fits each colour in view: log-scores up to a constant, (n,). See `color_features`."""
    scores: Array = color_features(words, rgbs) @ np.asarray(weights, dtype=np.float64)
    return scores
