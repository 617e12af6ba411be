"""The plain thing to compare with: scikit-learn's logistic regression on words x object features."""

from __future__ import annotations

import re
from collections.abc import Sequence

from dcg_torch.evaluation.episodes import Episode
from dcg_torch.settings import SettingsError


def bag_of_words(train: Sequence[Episode], test: Sequence[Episode]) -> list[bool]:
    """Which test episodes it gets right: is the likeliest object, row by row, one of those meant?

    Every (command, object) is a row; its features are the pairs of a word of the command and a property of the object
    (type, colour, clear, held, at which side), and the properties alone.

    Raises:
        SettingsError: scikit-learn is not installed.
    """
    try:
        from sklearn.feature_extraction import FeatureHasher
        from sklearn.linear_model import LogisticRegression
    except ImportError:
        raise SettingsError("baseline=true needs scikit-learn; install dcg-torch[bench]") from None
    hasher = FeatureHasher(2**18, input_type="string")
    rows = hasher.transform(row for e in train for row in _rows(e))
    labels = [o.id in e.target for e in train for o in e.objects]
    model = LogisticRegression(max_iter=300).fit(rows, labels)
    right = []
    for e in test:
        scores = model.decision_function(hasher.transform(_rows(e)))
        right.append(set(e.target) == {e.objects[int(scores.argmax())].id})
    return right


def _rows(episode: Episode) -> list[list[str]]:
    words = sorted(set(re.findall(r"[a-z]+", episode.text.lower())))
    columns = {(o.position[0], o.position[1]): 0.0 for o in episode.objects}
    for o in episode.objects:
        at = o.position[0], o.position[1]
        columns[at] = max(columns[at], o.position[2] if len(o.position) == 3 else 0.0)
    xs, ys = sorted(x for x, _ in columns), sorted(y for _, y in columns)
    rows = []
    for o in episode.objects:
        x, y = o.position[0], o.position[1]
        clear = len(o.position) < 3 or o.position[2] >= columns[x, y]
        own = [f"type {o.type}", f"color {o.color}", f"clear {clear}", f"held {o.id == episode.holding}"]
        own += [f"far {x == xs[-1]}", f"near {x == xs[0]}", f"left {y == ys[-1]}", f"right {y == ys[0]}"]
        rows.append([*own, *(f"{word} {property_}" for word in words for property_ in own)])
    return rows
