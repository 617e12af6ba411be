"""Make the word lists of `dcg_torch/english/data` from WordNet 3.0's files.

    python tools/english_words.py /usr/share/wordnet dcg_torch/english/data

WordNet's files are in Debian's package `wordnet-base`. Written are `english.tsv` (a word and, for each part of
speech that it can be, a letter and how often it was that in WordNet's tagged texts, as a power of two; parts of speech
are n, v, a and r) and `irregular.tsv` (an irregular form, its part of speech, its base). WordNet's notice stands
beside them in `WORDNET-LICENSE.txt`.
"""

from __future__ import annotations

import math
import sys
from collections import Counter, defaultdict
from pathlib import Path

PARTS = {"noun": "n", "verb": "v", "adj": "a", "adv": "r"}
_KINDS = {"1": "n", "2": "v", "3": "a", "4": "r", "5": "a"}
_LONGEST = 20


def counts(folder: Path) -> dict[str, Counter[str]]:
    """Uses of every word of one part, by part of speech, from the list of tagged senses."""
    found: dict[str, Counter[str]] = defaultdict(Counter)
    for line in (folder / "cntlist.rev").read_text(encoding="utf-8").splitlines():
        key, _, uses = line.split()
        word, kind = key.split("%")
        found[word][_KINDS[kind[0]]] += int(uses)
    return found


def words(folder: Path) -> dict[str, str]:
    """Every plain word and what it can be: {"drill": "n3v4"}."""
    used = counts(folder)
    found: dict[str, str] = defaultdict(str)
    for part, letter in PARTS.items():
        for line in (folder / f"index.{part}").read_text(encoding="utf-8").splitlines():
            word = line.split(" ", 1)[0]
            if word.isalpha() and word.isascii() and 1 < len(word) <= _LONGEST:
                found[word] += f"{letter}{min(9, math.ceil(math.log2(1 + used[word][letter])))}"
    return found


def irregular(folder: Path) -> list[tuple[str, str, str]]:
    """Irregular forms: (form, part of speech, base)."""
    out = []
    for part, letter in PARTS.items():
        for line in (folder / f"{part}.exc").read_text(encoding="utf-8").splitlines():
            form, base, *_ = line.split()
            if form.isalpha() and base.isalpha() and form != base:
                out.append((form, letter, base))
    return out


OF_WORDS = """\
# Words of WordNet 3.0 (WORDNET-LICENSE.txt), made by tools/english_words.py: a word, a tab, and for each part of
# speech (n noun, v verb, a adjective, r adverb) how often it is that: the power of two, from 0 to 9."""
OF_FORMS = """\
# Irregular forms of WordNet 3.0 (WORDNET-LICENSE.txt), made by tools/english_words.py: form, part of speech, base."""


def main(source: str, target: str) -> None:
    """Write both lists."""
    rows = [f"{word}\t{kinds}" for word, kinds in sorted(words(Path(source)).items())]
    Path(target, "english.tsv").write_text("\n".join([OF_WORDS, *rows]) + "\n", encoding="utf-8")
    forms = ["\t".join(form) for form in sorted(irregular(Path(source)))]
    Path(target, "irregular.tsv").write_text("\n".join([OF_FORMS, *forms]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
