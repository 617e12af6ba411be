"""Rows that are found once, and trees that keep what they hash to."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys

import numpy as np
import pytest
from making import command_tree

from dcg_torch.scene.row_cache import Arrays, KeptRows


@pytest.mark.parametrize("count", [100, 5_000])
def test_rows_are_found_once_and_come_as_they_are_asked_for(count: int) -> None:
    asked: list[int] = []

    def find(numbers: np.ndarray) -> Arrays:
        asked.extend(numbers.tolist())
        assert count == 100 or len(numbers) == 1
        return np.repeat(10 * numbers[:, None], 3, axis=1), np.stack([numbers[:, None], -numbers[:, None]])

    rows = KeptRows(find, count)
    for numbers in ([4, 2], [2], [7, 4, 5], [4, 2, 7, 5], [5, 5, 2]):
        flat, deep = rows.of(numbers)
        assert flat.tolist() == [[10 * j] * 3 for j in numbers]
        assert deep[:, :, 0].tolist() == [numbers, [-j for j in numbers]]
    assert sorted(asked) == [2, 4, 5, 7]


def test_only_what_is_new_is_found_and_what_was_joined_is_kept() -> None:
    asked: list[list[int]] = []

    def find(numbers: np.ndarray) -> Arrays:
        asked.append(numbers.tolist())
        return (10 * numbers[:, None],)

    rows = KeptRows(find, 9)
    for numbers in ([4, 2], [2, 7], [1, 0, 8, 3, 4], [6, 5, 7, 2]):
        assert rows.of(numbers)[0].ravel().tolist() == [10 * j for j in numbers]
    assert asked == [[4, 2], [7], [1, 0, 8, 3], [6, 5]]
    assert rows.of([6, 5, 7, 2])[0] is rows.of([6, 5, 7, 2])[0]


def test_a_tree_of_another_process_is_found_among_equal_ones() -> None:
    tree = command_tree("cube", "red")
    hash(tree)  # of its text, which hashes to something else in every process
    script = (
        "import pickle, sys; from making import command_tree; tree = pickle.load(sys.stdin.buffer); "
        "assert {command_tree('cube', 'red'): 1}.get(tree) == 1"
    )
    environment = {**os.environ, "PYTHONHASHSEED": "77", "PYTHONPATH": os.pathsep.join(sys.path)}
    subprocess.run([sys.executable, "-c", script], input=pickle.dumps(tree), env=environment, check=True)
