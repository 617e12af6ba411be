"""Marginals of a distribution over assignments of words to types.

Every word names one type, and several words may name one; each word after the first on a type costs a factor
`repeat` < 1, so that the words repel one another (repeat = 0: one-to-one, 1: independent words):

    P(t_1 ... t_W)  ~  prod_w psi[w, t_w]  *  prod_t repeat ** max(0, words on t - 1)

`exact` sums over the sets of types that are taken, word by word; `propagate` is loopy belief propagation on the
same factors. With repeat = 0 the latter is the data-association recursion of Williams and Lau (2014,
"Approximate evaluation of marginal association probabilities with belief propagation", IEEE Trans. AES 50(4)).
Propagation errs most on small tight clusters, as when two words share two types, and those are cheap to sum; so
`marginals` propagates over all and then sums exactly within each cluster that is small.

Conventions: psi is (W, T), non-negative, every row has a positive entry; `free[t]` is False for columns whose
words do not repel each other (types that have a name for certain carry their factor in psi; "some type not met
yet" is no single type).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dcg_torch.types.arrays import Bools, Floats, Ints

EXACT_COST = 300_000
"""Words times types times sets of types, up to which the sum is exact (a few milliseconds)."""
_BLOCK = 1 << 16
"""Entries that propagation works out together."""
_DAMPED = 0.5
"""The part of a change that is a step as long as, or since, nothing better is known."""
_ACCELERATED = 100
"""Sweeps up to which the last two changes say how large a part is taken."""
_LINKED = 0.005  # probability from which on a word and a type belong to one cluster


@dataclass(frozen=True)
class Marginals:
    """What an assignment's distribution says of single words and types.

    Attributes:
        word: (W, T) probability that word w names type t; rows sum to 1.
        taken: (T,) probability that some word names t.
        sweeps: of belief propagation; 0 where the sum was exact.
    """

    word: Floats
    taken: Floats
    sweeps: int = 0


def marginals(psi: Floats, repeat: float, free: Bools) -> Marginals:
    """The marginals: exact where that is cheap, otherwise propagated, and exact within small clusters.

    Raises:
        ValueError: `repeat` outside [0, 1], or shapes that don't fit.
    """
    _check(psi, repeat, free)
    if _cheap(len(psi), int(free.sum())):
        return exact(psi, repeat, free)
    found = propagate(psi, repeat, free)
    for words, types in _clusters(found.word > _LINKED, free):
        if len(types) > 1 and _cheap(len(words), len(types)):
            columns = np.sort(np.concatenate([types, np.flatnonzero(~free)]))
            block = np.ix_(words, columns)
            summed = exact(np.maximum(psi[block], 1e-300), repeat, free[columns])
            # what lies outside the cluster is little, and stays as propagated
            found.word[block] = summed.word * found.word[block].sum(axis=1, keepdims=True)
            found.taken[types] = np.maximum(summed.taken[np.isin(columns, types)], 0.0)
    return found


def _cheap(words: int, types: int) -> bool:
    return types <= 16 and max(1, words) * max(1, types) * 2**types <= EXACT_COST


def _clusters(linked: Bools, free: Bools) -> list[tuple[Ints, Ints]]:
    """Words and repelling types that hang together, as (indices of words, indices of types)."""
    of_word: list[list[int]] = [[] for _ in range(len(linked))]
    of_type: list[list[int]] = [[] for _ in free]
    for w, t in np.argwhere(linked & free).tolist():
        of_word[w].append(t)
        of_type[t].append(w)
    left = set(range(len(linked)))
    found = []
    while left:
        words, types, fresh = set[int](), set[int](), {left.pop()}
        while fresh:
            words |= fresh
            new = {t for w in fresh for t in of_word[w]} - types
            types |= new
            fresh = {w for t in new for w in of_type[t]} - words
        left -= words
        found.append((np.array(sorted(words)), np.array(sorted(types), dtype=np.int64)))
    return found


def exact(psi: Floats, repeat: float, free: Bools) -> Marginals:
    """Forward and backward sums over (words so far, set of types taken): O(W T 2^T)."""
    _check(psi, repeat, free)
    psi = _scaled(psi)
    columns = np.flatnonzero(free)
    sets = np.arange(2 ** len(columns))
    has = [(sets >> bit) & 1 == 1 for bit in range(len(columns))]
    other = psi[:, ~free].sum(axis=1)
    forward = np.zeros((len(psi) + 1, len(sets)))
    forward[0, 0] = 1.0
    for w, row in enumerate(psi):
        before, after = forward[w], forward[w] * other[w]
        for bit, t in enumerate(columns):
            after[has[bit]] += row[t] * (repeat * before[has[bit]] + before[~has[bit]])
        forward[w + 1] = after / after.sum()
    backward = np.ones(len(sets))
    word = np.zeros(psi.shape)
    for w in range(len(psi) - 1, -1, -1):
        row, before, after = psi[w], forward[w], backward
        backward = after * other[w]
        word[w, ~free] = row[~free] * (before @ after)
        for bit, t in enumerate(columns):
            then = after[has[bit]]  # the set with t in it, whether or not it was there before
            word[w, t] = row[t] * ((repeat * before[has[bit]] + before[~has[bit]]) @ then)
            backward[has[bit]] += row[t] * repeat * then
            backward[~has[bit]] += row[t] * then
        backward = backward / backward.max()
        word[w] /= word[w].sum()
    taken = np.zeros(psi.shape[1])
    taken[columns] = [forward[-1][mask].sum() for mask in has]
    return Marginals(word, taken)


def propagate(psi: Floats, repeat: float, free: Bools, *, tolerance: float = 1e-6, most: int = 500) -> Marginals:
    """Loopy belief propagation, all messages at once.

    With odds[w, t] the message "w names t" of a word to a type and P the product of (1 + repeat * odds) over the
    other words, the type answers with the ratio repeat P / (repeat + P - 1), or 1 / (1 + sum of odds) at repeat 0.

    A step is a part of the change of the answers: a whole one can swing where words are many and repel weakly. How
    large a part is told by the last two changes (dynamic relaxation: Irons and Tuck, "A version of the Aitken
    accelerator for computer iteration", Int. J. Numer. Methods Eng. 1, 1969).
    """
    _check(psi, repeat, free)
    psi, held = _scaled(psi), np.flatnonzero(~free)
    answer, work, before = np.ones(psi.shape), np.empty(psi.shape), np.zeros(psi.shape)
    blocks = _blocks(*psi.shape)
    total, part = np.ones(psi.shape[1]), _DAMPED
    sweeps, change = 0, np.inf
    while sweeps < most and change >= tolerance:
        sweeps += 1
        total = _totals(psi, answer, repeat, blocks, work)
        along, size = 0.0, 0.0
        for rows in blocks:
            own, old = _changes(total, repeat, held, answer[rows], work[rows]), before[rows]
            old -= own  # how the change has turned
            size += float(np.vdot(old, old))
            along += float(np.vdot(old, own))
        if 1 < sweeps < _ACCELERATED and size > 0.0:
            part = min(max(part * (1.0 + along / size), 0.2), 1.5)
        elif sweeps >= _ACCELERATED:
            part = _DAMPED
        change = 0.0
        for rows in blocks:
            step = np.multiply(work[rows], part, out=before[rows])
            np.maximum(step, -0.9 * answer[rows], out=step)  # answers stay positive
            answer[rows] += step
            change = max(change, step.max(initial=0.0), -step.min(initial=0.0))
        work, before = before, work
    pull = psi * answer
    word = pull / pull.sum(axis=1, keepdims=True)
    # Of each type the belief about "no word at all", from the same messages.
    some = total if repeat == 0.0 else (total - 1.0) / repeat
    return Marginals(word, np.where(free, some / (1.0 + some), 0.0), sweeps)


def _blocks(words: int, types: int) -> list[slice]:
    """Rows that are worked through together: what is worked out of them stays in the processor's cache."""
    step = max(1, _BLOCK // max(1, types))
    return [slice(start, start + step) for start in range(0, words, step)]


def _totals(psi: Floats, answer: Floats, repeat: float, blocks: Sequence[slice], odds: Floats) -> Floats:
    """(T,) of each type the product of (1 + repeat * odds) over all words, or the sum of odds at repeat 0.

    The odds are written into `odds`; there is no telling beyond 1e300.
    """
    total = np.full(psi.shape[1], 0.0 if repeat == 0.0 else 1.0)
    with np.errstate(over="ignore"):
        for rows in blocks:
            own = np.multiply(psi[rows], answer[rows], out=odds[rows])
            others = own.sum(axis=1, keepdims=True) - own
            own /= np.maximum(others, 1e-300, out=others)
            np.minimum(own, 1e12, out=own)
            if repeat == 0.0:
                total += own.sum(axis=0)
            else:
                total *= (repeat * own + 1.0).prod(axis=0)
    np.minimum(total, 1e300, out=total)
    return total


def _changes(total: Floats, repeat: float, held: Ints, answer: Floats, odds: Floats) -> Floats:
    """The types' answers to some words less those before; written over the odds."""
    if repeat == 0.0:
        np.subtract(1.0 + total, odds, out=odds)
        renewed = np.divide(1.0, odds, out=odds)
    else:
        odds *= repeat
        odds += 1.0
        others = np.divide(total, odds, out=odds)  # P
        under = others + (repeat - 1.0)
        others *= repeat
        renewed = np.divide(others, under, out=odds)
    renewed -= answer
    renewed[:, held] = 0.0
    return renewed


def _scaled(psi: Floats) -> Floats:
    return psi / psi.max(axis=1, keepdims=True) if len(psi) else psi


def _check(psi: Floats, repeat: float, free: Bools) -> None:
    if not 0.0 <= repeat <= 1.0:
        raise ValueError(f"repeat is {repeat}; a factor for further words lies between 0 and 1")
    if psi.ndim != 2 or free.shape != psi.shape[1:]:
        raise ValueError(f"psi of shape {psi.shape} and free of shape {free.shape} don't fit")
    if len(psi) and not (psi.max(axis=1, initial=0.0) > 0.0).all():
        raise ValueError("a word has no type that it could name")
