"""How landmarks are looked at: by the robot, by who faces them, by the speaker."""

from __future__ import annotations

import numpy as np

from dcg_torch.scene.layout import Layout
from dcg_torch.scene.order import TIE
from dcg_torch.types.arrays import Bools, Floats, Ints


def views(where: Layout, first: Ints, sided: Bools) -> tuple[Floats, Bools]:
    """How c landmarks are looked at, in up to three frames: the robot's, its own as it faces them, the speaker's.

    Args:
        sided: (c, n) which things stand on a side of which landmark.

    Returns:
        (frames, c) angles, and (frames, c, n) which things stand on a side.
    """
    mark = where.position[first, :2]
    seen = None if where.outlook is None else where.outlook[first]
    if seen is not None and np.isfinite(seen).all():
        return np.array([seen, seen]), np.array([sided, sided])
    away = np.hypot(*mark.T)[:, None] > TIE  # the robot doesn't see itself from anywhere
    found, kept = [np.zeros(len(first)), np.arctan2(mark[:, 1], mark[:, 0])], [sided, sided & away]
    if where.speaker is not None:
        view = mark - where.speaker
        near = np.hypot(*view.T) <= TIE  # the speaker looks at the middle of the objects
        view[near] = where.middle - where.speaker
        found, kept = [*found, np.arctan2(view[:, 1], view[:, 0])], [*kept, sided]
    angles: Floats = np.array(found) if seen is None else np.where(np.isfinite(seen), seen, np.array(found))
    return angles, np.array(kept)
