"""Values and files near good ones, drawn fast: structure first, then bytes. `hostile` has what they are made of."""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Sequence
from typing import Any

import yaml
from hostile import SCALARS

_NUMBERS: list[Any] = [0, 1, -1, 7, 0.5, 1e308, -1e308, 5e-324, float("inf"), float("nan"), 2**63, 10**400, True]
_TEXTS = ["", " ", "\x1b[31m", "a" * 5_000, "../../x", "null", "2", "\u2028", "\ud800", "hypothetical cube", "É", "\0"]
_BYTES = [b"\xff", b"\xef\xbb\xbf", b"\x00", b"\r", b"\x1b[2J"]
_YAML = [*(s.encode("utf-8") for s in SCALARS), *_BYTES]
_JSON = [b"{", b"[" * 5_000, b'"id": "x", "id": "y",', b"NaN", b"9" * 5_000, b"\\ud800", b"null", b"\n", *_BYTES]
_CSV = [b'"', b",", b"\n", b"9" * 5_000, b"nan", b"," * 5_000, b'"""', *_BYTES]
_XML = [b"<", b">", b"&", b"&#0;", b"<!DOCTYPE x>", b"<a " * 500, b"]]>", b'"', *_BYTES]
_Dumper: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)


def value(rng: random.Random, depth: int = 3) -> Any:
    """Anything that JSON and YAML can hold."""
    kind = rng.randrange(6 if depth else 4)
    if kind == 0:
        return rng.choice([None, True, False])
    if kind == 1:
        return rng.choice(_NUMBERS) if rng.random() < 0.6 else rng.uniform(-1e4, 1e4)
    if kind in (2, 3):
        return text(rng)
    inner = [value(rng, depth - 1) for _ in range(rng.randrange(4))]
    return inner if kind == 4 else {text(rng): one for one in inner}


def text(rng: random.Random) -> str:
    """A strange text, or a few random characters."""
    if rng.random() < 0.5:
        return rng.choice(_TEXTS)
    return "".join(chr(rng.choice((rng.randrange(32, 127), rng.randrange(0xD7FF)))) for _ in range(rng.randrange(8)))


def mutated(rng: random.Random, good: Any) -> Any:
    """A good value in which one to three places were replaced, removed, renamed, doubled, wrapped or exchanged."""
    made = copy.deepcopy(good)
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        holder, key = _place(rng, made)
        if holder is None:
            return value(rng)
        what = rng.choice(("replace", "replace", "remove", "rename", "double", "wrap", "exchange"))
        if what == "replace":
            holder[key] = value(rng)
        elif what == "remove":
            del holder[key]
        elif what == "wrap":
            holder[key] = [holder[key]]
        elif what == "exchange":
            other, at = _place(rng, made)
            holder[key] = copy.deepcopy(other[at])
        elif isinstance(holder, list):
            holder.insert(key, copy.deepcopy(holder[key]))
        else:
            holder[rng.choice((text(rng), f"{key}s", str(key).upper()))] = holder[key]
            if what == "rename":
                holder.pop(key)
    return made


def _place(rng: random.Random, made: Any) -> tuple[Any, Any]:
    """A random place in a value: what holds it, and its key there."""
    holder, key = None, None
    while isinstance(made, (dict, list)) and made:
        holder = made
        key = rng.choice(sorted(made, key=str)) if isinstance(made, dict) else rng.randrange(len(made))
        made = holder[key]
        if rng.random() < 0.4:
            break
    return holder, key


def damaged(rng: random.Random, content: bytes, pieces: Sequence[bytes] = _BYTES) -> bytes:
    """Content as it is (most of the time), cut short, or with a piece pushed in, put over others, or doubled."""
    if rng.random() < 0.7:
        return content
    at = rng.randrange(len(content) + 1)
    end = min(len(content), at + rng.randrange(20))
    piece = rng.choice(pieces) if rng.random() < 0.6 else rng.randbytes(rng.randrange(8))
    how = rng.randrange(4)
    if how == 0:
        return content[:at]
    if how == 1:
        return content[:at] + piece + content[at:]
    return content[:at] + (piece if how == 2 else content[at:end] * 2) + content[end:]


def yaml_file(rng: random.Random, good: Any) -> bytes:
    """A YAML file near a good one."""
    made = yaml.dump(
        _printable(mutated(rng, good)),
        Dumper=_Dumper,
        sort_keys=False,
        allow_unicode=True,
        default_flow_style=rng.random() < 0.3 or None,
    )
    return damaged(rng, made.encode("utf-8", "surrogatepass"), _YAML)


def _printable(made: Any) -> Any:
    """Without surrogates, which libyaml does not write."""
    if isinstance(made, str):
        return made.encode("utf-8", "replace").decode("utf-8")
    if isinstance(made, dict):
        return {_printable(key): _printable(inner) for key, inner in made.items()}
    return [_printable(inner) for inner in made] if isinstance(made, list) else made


def json_file(rng: random.Random, good: Any) -> bytes:
    """A JSON file near a good one."""
    return damaged(rng, json_bytes(rng, mutated(rng, good)), _JSON)


def json_lines(rng: random.Random, *good: Any) -> bytes:
    """A file of JSON lines near good ones, which come in this order; the last is mutated several times."""
    lines = [json_bytes(rng, one if rng.random() < 0.4 else mutated(rng, one)) for one in good]
    lines += [json_bytes(rng, mutated(rng, good[-1])) for _ in range(rng.randrange(3))]
    return damaged(rng, b"\n".join(lines) + b"\n", _JSON)


def json_bytes(rng: random.Random, made: Any) -> bytes:
    """As JSON, with letters beyond ASCII written out or not."""
    return json.dumps(made, ensure_ascii=rng.random() < 0.5).encode("utf-8", "surrogatepass")


def csv_file(rng: random.Random, good: bytes) -> bytes:
    """A table in which lines were doubled, exchanged or damaged, several times."""
    for _ in range(rng.randint(1, 3)):
        good = damaged(rng, good, _CSV)
        lines = good.split(b"\n")
        lines.insert(rng.randrange(len(lines) + 1), rng.choice(lines))
        good = b"\n".join(lines)
    return good


def xml_file(rng: random.Random, good: bytes) -> bytes:
    """An XML file with attributes changed, and damaged."""
    parts = good.split(b'"')
    for _ in range(rng.randint(1, 3)):
        if len(parts) > 2:
            parts[2 * rng.randrange(len(parts) // 2) + 1] = str(value(rng, 0)).encode("utf-8", "replace")
    return damaged(rng, b'"'.join(parts), _XML)
