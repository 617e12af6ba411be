"""What stood in the paper's laboratory (Section IV-D) beside a cone and a cube; no type of the simulated worlds."""

from __future__ import annotations

import math
from typing import Final

from dcg_torch.simulator.bodies.looks import RGB, Model, Part, register
from dcg_torch.simulator.bodies.meshes import Mesh, box, extruded

_X, _Y, _Z = 0.32, 0.29, 0.30  # metres
_BOARD, _RAIL, _SLATS = 0.011, 0.041, 4  # thickness and width of a board in metres; slats a side
_FRAME: Final[RGB] = (0.80, 0.63, 0.42)  # pale wood
_GAP: Final[RGB] = (0.16, 0.11, 0.07)  # the dark between two slats


@register("crate")
def crate() -> Model:
    """A wooden crate: slats in the stated colour, and on each side a pale frame with a brace."""
    parts = [Part(box(_X - 4 * _BOARD, _Y - 4 * _BOARD, _Z - 2 * _BOARD), _GAP)]
    inside = 2 * _BOARD
    for turn, distance, width in ((0, _X, _Y), (180, _X, _Y), (90, _Y, _X - 2 * inside), (270, _Y, _X - 2 * inside)):
        slats, frame = _side(width)
        for paint, meshes in ((None, slats), (_FRAME, frame)):
            parts += [Part(m.moved(distance / 2 - inside).turned(math.radians(turn)), paint) for m in meshes]
    lid = box(_X - 2 * inside, (_Y - 2 * inside) / _SLATS - 0.012, _BOARD)
    parts += [Part(lid.moved(y=_middle(k, _Y - 2 * inside), z=_Z - _BOARD)) for k in range(_SLATS)]
    return Model(tuple(parts))


def _side(width: float) -> tuple[list[Mesh], list[Mesh]]:
    """Slats and frame of a side that looks along +x, its inner face on x = 0."""
    slat = box(_BOARD, width, _Z / _SLATS - 0.014)
    slats = [slat.moved(_BOARD / 2, z=k * _Z / _SLATS + 0.007) for k in range(_SLATS)]
    right, top = width / 2 - _RAIL, _Z - _RAIL
    post = box(_BOARD, _RAIL, _Z).moved(1.5 * _BOARD)
    rail = box(_BOARD, 2 * right, _RAIL).moved(1.5 * _BOARD)
    # the brace runs from corner to corner of what the frame leaves open
    brace = [(-right, _RAIL), (_RAIL - right, _RAIL), (right, top), (right - _RAIL, top)]
    ends = [post.moved(y=side * (right + _RAIL / 2)) for side in (-1.0, 1.0)]
    return slats, [*ends, rail, rail.moved(z=top), extruded(brace, _BOARD).lying().moved(_BOARD)]


def _middle(k: int, width: float) -> float:
    """Of the k-th of the slats that share `width`."""
    return ((k + 0.5) / _SLATS - 0.5) * width
