"""The floor of pictures for people: tiles of a metre in two light tones.

The renderer takes four fifths of a picture's time for it, and it is a plane. So it is painted: a pixel shows the tile
in which its line of sight meets z = 0. It is there as a body as well, for pictures of a part of a view.
"""

from __future__ import annotations

import functools
import math
from typing import Final

import numpy as np

from dcg_torch.simulator.bodies import Model, Part
from dcg_torch.simulator.bodies.meshes import Mesh, merged
from dcg_torch.simulator.view import Pixels, View
from dcg_torch.types.arrays import Ints

TILES: Final = ((0.89, 0.89, 0.87), (0.85, 0.85, 0.83))
"""Paint of the tile whose lower left corner is the origin, and of its neighbours."""


@functools.cache
def tiled(reach: int) -> Model:
    """Tiles with their upper side on z = 0, `reach` metres along each axis both ways."""
    tiles: tuple[list[Mesh], list[Mesh]] = ([], [])
    square = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    up, halves = np.tile([0.0, 0.0, 1.0], (4, 1)), np.array([[0, 1, 2], [0, 2, 3]])
    tile = Mesh(square, up, halves)
    for x in range(-reach, reach):
        for y in range(-reach, reach):
            tiles[(x + y) % 2].append(tile.moved(x, y))
    return Model((Part(merged(tiles[0])), Part(merged(tiles[1]), TILES[1])))


def paint_floor(view: View, image: Pixels, bodies: Ints, body: int, reach: int) -> None:
    """Paint `tiled(reach)` where a picture shows nothing, as the renderer would.

    Args:
        image, bodies: (h, w, 3) and (h, w), of `view.render` without a floor; both are changed.
        body: number that is put into `bodies` where the floor is.
    """
    width, height = view.size
    right, up = view.axes
    half = math.tan(view.fov / 2)
    # the renderer looks through the lower left corner of a pixel
    down = half * (1.0 - 2.0 * np.arange(1, height + 1) / height)[:, None]
    across = (half * (2.0 * np.arange(width) - width) / height).astype(np.float32)
    # rows are level, so that all that is seen in a row is equally deep
    with np.errstate(divide="ignore"):
        depth = -view.eye[2] / (view.forward[2] + down * up[2])
    rows = np.flatnonzero((depth >= view.near) & (depth <= view.far))
    if not len(rows):
        return
    within = np.s_[rows[0] : rows[-1] + 1]
    depth, down, image, bodies = depth[within], down[within], image[within], bodies[within]
    x, y = (
        (view.eye[k] + depth * (view.forward[k] + down * up[k])).astype(np.float32)
        + (depth * right[k]).astype(np.float32) * across
        for k in (0, 1)
    )
    bare = (bodies < 0) & (abs(x) < reach) & (abs(y) < reach)
    odd = (np.floor(x) + np.floor(y)).astype(np.int32) & 1
    tones = np.array([view.lit(paint, (0.0, 0.0, 1.0)) for paint in TILES], dtype=np.uint8)
    np.copyto(image, tones.take(odd, axis=0), where=bare[..., None])
    np.copyto(bodies, body, where=bare)
