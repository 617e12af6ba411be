"""The data files of the package: no key stands in one twice, where the later one would silently win."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

import dcg_torch

FILES = sorted(Path(dcg_torch.__file__).parent.rglob("*.yaml"))


def twice(node: yaml.Node | None) -> list[str]:
    """The keys that a node or one below it has twice."""
    if isinstance(node, yaml.MappingNode):
        keys = [str(key.value) for key, _ in node.value]
        own = [key for key in dict.fromkeys(keys) if keys.count(key) > 1]
        return own + [key for _, value in node.value for key in twice(value)]
    return [key for one in node.value for key in twice(one)] if isinstance(node, yaml.SequenceNode) else []


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_no_key_stands_twice(path: Path) -> None:
    assert twice(yaml.compose(path.read_text())) == []


def test_a_key_that_stands_twice_is_found() -> None:
    assert twice(yaml.compose("a: 1\nb: [{c: 1, c: 2}]\na: 3\n")) == ["a", "c"]
