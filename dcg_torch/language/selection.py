"""Words that pick from a set: ordinals, superlatives, "last"; brought to a small closed form.

An ordinal with what it counts along is two words of a noun phrase:

    ("second", "from the left")   the second from the left, the second leftmost
    ("second", "last")            the second to last, the next to last, the penultimate
    ("second", "biggest")         the second biggest; so with every superlative
    ("second",)                   with the preposition "closest to" below: the second closest to the sphere
"""

from __future__ import annotations

from collections.abc import Sequence

from dcg_torch.language.lexicon import NORMAL, SETS

_MOST = "most"


def normal_words(words: Sequence[str]) -> tuple[str, ...]:
    """The describing words of a noun phrase in normal form, each once.

    >>> normal_words(["third", "leftmost"]), normal_words(["nearest", "big"])
    (('third', 'from the left'), ('closest', 'big'))
    """
    out: list[str] = []
    for word in words:
        normal = NORMAL.get(word, word)
        side = normal.removesuffix(_MOST)
        if out and out[-1] in SETS["ordinals"] and normal.endswith(_MOST) and side in SETS["sides"]:
            normal = f"from the {side}"
        out.append(normal)
    return tuple(dict.fromkeys(out))


def is_superlative(word: str) -> bool:
    """Whether a word names an end: "leftmost", "biggest", "last"."""
    return word.endswith(("est", _MOST)) or word in SETS["ordinals"]
