"""Files that people and machines get wrong: examples of each kind, and strategies that make more of them."""

from __future__ import annotations

import copy
import json
from typing import Any

import yaml
from hypothesis import strategies as st

# Scalars that PyYAML's constructors stumble over, each in another way.
SCALARS = [
    "2001-99-99",
    "9" * 5_000,
    "!!int abc",
    '!!int ""',
    "!!float abc",
    "!!timestamp abc",
    "!!bool abc",
    "!!binary ä",
    "!!python/object/apply:os.system [echo]",
    "!!set {a, b}",
    "&a [*a]",
    "{[1]: 2}",
    "{<<: 3}",
    ".inf",
    "[" * 1_000,
    "*nobody",
    '"\\x1b[31m"',
    "\x00",
]

WORLD: dict[str, Any] = {
    "name": "two",
    "robot": {"x": 1.0, "y": -0.5, "yaw": 0.25},
    "objects": [
        {"id": "a", "type": "cube", "color": "red", "position": [1, 2]},
        {"id": "b", "type": "fire hydrant", "color": "blue", "position": [-1.5, 2], "yaw": 1.0},
    ],
    "commands": [{"text": "go to the cube", "target": "a", "noun": "cube", "color": None}],
}
TRAINING: dict[str, Any] = {
    "symbols": {"cube": "cube", "block": "cube"},
    "colors": ["red"],
    "examples": [
        {
            "command": "go to the cube",
            "verb": "go",
            "preposition": "to",
            "noun": "cube",
            "see": ["red cube"],
            "means": "red cube",
        },
        {"command": "find the dax", "verb": "find", "noun": "dax", "see": [], "means": "hypothetical unknown"},
    ],
}
EPISODE: dict[str, Any] = {
    "id": "e1",
    "text": "take the red cube",
    "robot": {"x": 0.0, "y": 0.0, "yaw": 0.0},
    "speaker": {"x": 1.0, "y": 2.0},
    "holding": None,
    "group": "g",
    "objects": [
        {"id": "a", "type": "cube", "color": "red", "position": [1, 2, 0], "size": 0.2, "rgb": [255, 0, 0]},
        {"id": "b", "type": "ball", "color": None, "position": [3.5, 2], "held": True, "material": "wood"},
    ],
    "target": ["a"],
}

_numbers = st.one_of(
    st.sampled_from([0, -1, 1e308, -1e308, 5e-324, float("inf"), float("nan"), 2**63, 10**400, True]), st.floats()
)
_texts = st.one_of(
    st.sampled_from(["", " ", "\x1b[31m", "a" * 5_000, "../../x", "null", "2", "\u2028", "hypothetical cube"]),
    st.text(),
)
values = st.recursive(
    st.one_of(st.none(), st.booleans(), _numbers, _texts),
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(_texts, inner, max_size=4)),
    max_leaves=12,
)


@st.composite
def mutated(draw: st.DrawFn, good: dict[str, Any]) -> Any:
    """A good value in which one to three places were replaced, removed, renamed, doubled or wrapped."""
    value = copy.deepcopy(good)
    for _ in range(draw(st.integers(1, 3))):
        holder, key = _place(draw, value)
        if holder is None:
            return draw(values)
        what = draw(st.sampled_from(["replace", "remove", "rename", "double", "wrap"]))
        if what == "replace":
            holder[key] = draw(values)
        elif what == "remove":
            del holder[key]
        elif what == "wrap":
            holder[key] = [holder[key]]
        elif isinstance(holder, dict):
            holder[draw(st.one_of(_texts, st.just(f"{key}s"), st.just(str(key).upper())))] = holder[key]
            if what == "rename":
                holder.pop(key)
        else:
            holder.insert(key, copy.deepcopy(holder[key]))
    return value


def _place(draw: st.DrawFn, value: Any) -> tuple[Any, Any]:
    """A random place in a value: what holds it, and its key there."""
    holder, key = None, None
    while isinstance(value, (dict, list)) and value:
        holder = value
        key = draw(
            st.sampled_from(sorted(value, key=str)) if isinstance(value, dict) else st.integers(0, len(value) - 1)
        )
        value = holder[key]
        if draw(st.booleans()):
            break
    return holder, key


@st.composite
def yaml_files(draw: st.DrawFn, good: dict[str, Any]) -> bytes:
    """A YAML file near a good one: values changed, or the text."""
    value = draw(mutated(good))
    text = yaml.safe_dump(
        value, sort_keys=False, allow_unicode=True, default_flow_style=draw(st.sampled_from([None, True]))
    )
    return draw(damaged(text.encode("utf-8", "surrogatepass"), [s.encode("utf-8") for s in SCALARS]))


@st.composite
def json_lines(draw: st.DrawFn, good: dict[str, Any]) -> bytes:
    """A file of JSON lines near a good one."""
    lines = [json.dumps(draw(mutated(good)), ensure_ascii=draw(st.booleans())) for _ in range(draw(st.integers(1, 3)))]
    text = "\n".join(lines).encode("utf-8", "surrogatepass")
    return draw(
        damaged(text, [b"{", b"[" * 5_000, b'"id": "x", "id": "y",', b"NaN", b"9" * 5_000, b"\xff", b"\\ud800"])
    )


@st.composite
def damaged(draw: st.DrawFn, content: bytes, pieces: list[bytes]) -> bytes:
    """Content as it is, cut short, or with a piece pushed in or put in the place of others."""
    at = draw(st.integers(0, len(content)))
    end = draw(st.integers(at, min(len(content), at + 20)))
    how = draw(st.sampled_from(["whole", "cut", "push", "put"]))
    piece = draw(st.one_of(st.sampled_from(pieces), st.binary(max_size=8)))
    return {
        "whole": content,
        "cut": content[:at],
        "push": content[:at] + piece + content[at:],
        "put": content[:at] + piece + content[end:],
    }[how]
