"""Make the noun table of `dcg_torch/names/data`, then the weights of the facts between nouns and class names.

    python tools/noun_table.py DICT_DIR

DICT_DIR holds `data.noun` and `index.noun` (wndb(5WN) describes them); Debian's package `wordnet-base` installs them
into /usr/share/wordnet. The table keeps nouns for things that can be pointed at, the order of their senses, and what
each is a kind of. Definitions, names of persons and places, and all abstract nouns are left out. The weights are
learned from `data/nouns.yaml`.
"""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dcg_torch.names.evidence import evidence
from dcg_torch.names.normal_form import DATA, read_data
from dcg_torch.names.weights import FACTS, WEIGHTS
from dcg_torch.names.wordnet import TABLE

Array = NDArray[np.float64]
_L2 = 0.1
_STEPS = 100
_TOLERANCE = 1e-6

_THINGS = frozenset({3, 5, 6, 8, 13, 17, 20, 25, 27})
_OTHERS = frozenset({10, 14, 15, 18})
"""Lexicographer files kept (lexnames(5WN)): tops, animals, artefacts, body parts, food, natural objects, plants,
shapes, substances; and behind them, where one of them is a noun's commonest, communication, groups, places, people.
Who points at a tool or a mug means no dupe and no fool."""


def main(arguments: list[str]) -> int:
    """Write the table; the exit status: 0 done, 2 the dictionary is not there."""
    if len(arguments) != 1:
        print("usage: python tools/noun_table.py DICT_DIR (the folder of WordNet's data.noun)", file=sys.stderr)
        return 2
    directory = Path(arguments[0])
    try:
        data = (directory / "data.noun").read_text(encoding="ascii")
        index = (directory / "index.noun").read_text(encoding="ascii")
    except (OSError, UnicodeDecodeError) as error:
        print(
            f"{directory}: no WordNet dictionary ({error}); install Debian's wordnet-base, or give its folder",
            file=sys.stderr,
        )
        return 2
    arrays = make_table(data, index)
    TABLE.parent.mkdir(exist_ok=True)
    np.savez_compressed(TABLE, allow_pickle=False, **arrays)
    print(f"{TABLE.name}: {len(arrays['senses_of'])} nouns, {TABLE.stat().st_size} bytes")
    print(f"{WEIGHTS}: {write_weights()} facts")
    return 0


def write_weights() -> int:
    """Learn the weight of each fact from `nouns.yaml` and write them; how many there are."""
    lessons = read_data("nouns.yaml")
    weights = fit_weights(lessons["classes"], lessons["nouns"])
    lines = [f'"{fact}": {weight}\n' for fact, weight in weights.items()]
    header = "# Log-odds of each fact; made by `python tools/noun_table.py` from nouns.yaml.\n"
    (DATA / WEIGHTS).write_text(header + "".join(lines), encoding="utf-8")
    return len(weights)


def make_table(data: str, index: str) -> dict[str, np.ndarray]:
    """The arrays that `wordnet.Nouns` reads.

    Args:
        data: the text of `data.noun`, a line a synset.
        index: the text of `index.noun`, a line a lemma, its senses in the order of their frequency.

    Returns:
        `lemmas` (bytes, sorted, newline-separated), `senses_of` (n,) how many senses each has, `senses` their synsets
        one after another, `kinds_of` (s,) how many hypernyms each synset has, `kinds` those one after another.
    """
    file_of, hypernyms = {}, {}
    for offset, file, above in _synsets(data):
        file_of[offset], hypernyms[offset] = file, above
    senses_of: dict[str, dict[int, None]] = {}  # "ash-bin" and "ash bin" are one
    for lemma, offsets in _lemmas(index):
        kept = [o for o in offsets if o in file_of]
        if kept:
            other = file_of[kept[0]] in _OTHERS
            kept = [o for o in kept if file_of[o] in _THINGS] + [o for o in kept if other and file_of[o] in _OTHERS]
            senses_of.setdefault(lemma, {}).update(dict.fromkeys(kept))
    lemmas = sorted((lemma, list(senses)) for lemma, senses in senses_of.items())
    used = sorted(_with_ancestors({s for _, senses in lemmas for s in senses}, hypernyms))
    number = {offset: k for k, offset in enumerate(used)}
    kinds = [[number[h] for h in hypernyms[offset] if h in number] for offset in used]
    return {
        "lemmas": np.frombuffer("\n".join(lemma for lemma, _ in lemmas).encode(), dtype=np.uint8),
        "senses_of": np.array([len(senses) for _, senses in lemmas], dtype=np.uint8),
        "senses": np.array([number[s] for _, senses in lemmas for s in senses], dtype=np.uint32),
        "kinds_of": np.array([len(k) for k in kinds], dtype=np.uint8),
        "kinds": np.array([h for k in kinds for h in k], dtype=np.uint32),
    }


def _synsets(data: str) -> Iterator[tuple[int, int, list[int]]]:
    """Offset, lexicographer file and hypernyms of each synset of things that is no single person or place."""
    for line in data.split("\n"):
        if not line or line.startswith(" "):
            continue
        fields = line.partition(" | ")[0].split(" ")
        words = int(fields[3], 16)
        pointers = fields[5 + 2 * words :]
        found = [(pointers[k], int(pointers[k + 1])) for k in range(0, 4 * int(fields[4 + 2 * words]), 4)]
        if int(fields[1]) in _THINGS | _OTHERS and not any(symbol == "@i" for symbol, _ in found):
            yield int(fields[0]), int(fields[1]), [offset for symbol, offset in found if symbol == "@"]


def _lemmas(index: str) -> Iterator[tuple[str, list[int]]]:
    """Each lemma, with spaces, and the offsets of its synsets."""
    for line in index.split("\n"):
        if not line or line.startswith(" "):
            continue
        fields = line.split()
        yield fields[0].replace("_", " ").replace("-", " "), [int(f) for f in fields[-int(fields[2]) :]]


def _with_ancestors(synsets: set[int], hypernyms: dict[int, list[int]]) -> set[int]:
    found, open_ = set(), list(synsets)
    while open_:
        one = open_.pop()
        if one in hypernyms and one not in found:
            found.add(one)
            open_ += hypernyms[one]
    return found


def fit_weights(classes: Sequence[str], meanings: Mapping[str, Collection[str]]) -> dict[str, float]:
    """The weights under which the nouns are likeliest to mean what they mean (L2-regularised maximum likelihood).

    Args:
        classes: all classes in view.
        meanings: the classes that each noun may mean, none of them included as an empty collection.
    """
    nouns = sorted(meanings)
    facts = [[evidence(noun, name) for name in classes] + [()] for noun in nouns]
    patterns = sorted({one for row in facts for one in row})
    design = np.array([[fact in pattern for fact in FACTS] for pattern in patterns], dtype=np.float64)
    number = {pattern: k for k, pattern in enumerate(patterns)}
    problem = _Problem(
        design,
        np.array([[number[one] for one in row] for row in facts]),
        np.array([[*(name in meanings[noun] for name in classes), not meanings[noun]] for noun in nouns]),
    )
    weights = np.zeros(len(FACTS))
    for _ in range(_STEPS):
        loss, gradient, curvature = problem.derivatives(weights)
        step = np.linalg.solve(curvature, gradient)
        while np.abs(step).max() > _TOLERANCE and problem.derivatives(weights - step)[0] > loss:
            step /= 2.0
        weights -= step
        if np.abs(step).max() <= _TOLERANCE:
            break
    return {fact: round(float(weight), 2) for fact, weight in zip(FACTS, weights, strict=True)}


@dataclass(frozen=True)
class _Problem:
    """n nouns, c choices for each, p different sets of facts, f facts.

    Attributes:
        design: (p, f), the facts of each set.
        pattern: (n, c), which set of facts holds between a noun and a choice.
        meant: (n, c), may the noun mean the choice?
    """

    design: Array
    pattern: NDArray[np.int64]
    meant: NDArray[np.bool_]

    def derivatives(self, weights: Array) -> tuple[float, Array, Array]:
        """The loss, its gradient (f,), and the curvature (f, f) of its convex part, which makes each step downhill."""
        scores = (self.design @ weights)[self.pattern]
        all_, right = _softmax(scores), _softmax(np.where(self.meant, scores, -np.inf))
        loss = -np.log((all_ * self.meant).sum(axis=1)).sum() + _L2 / 2 * weights @ weights
        share = self._by_pattern(all_)
        gradient = (share - self._by_pattern(right)).sum(axis=0) @ self.design + _L2 * weights
        mean = share @ self.design
        spread = self.design.T @ (share.sum(axis=0)[:, None] * self.design) - mean.T @ mean
        return float(loss), gradient, spread + _L2 * np.eye(len(weights))

    def _by_pattern(self, values: Array) -> Array:
        """Values (n, c) summed by pattern: (n, p)."""
        n, p = len(values), len(self.design)
        cells = np.arange(n)[:, None] * p + self.pattern
        sums: Array = np.bincount(cells.ravel(), weights=values.ravel(), minlength=n * p).astype(np.float64)
        return sums.reshape(n, p)


def _softmax(scores: Array) -> Array:
    weight = np.exp(scores - scores.max(axis=1, keepdims=True))
    result: Array = weight / weight.sum(axis=1, keepdims=True)
    return result


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
