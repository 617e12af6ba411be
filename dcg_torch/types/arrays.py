"""Names for the types of numpy arrays, by what is in them. Their shapes stand where they are handed over."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]
Points = NDArray[np.float64]
"""(points, 2) or (points, 3): a point a row, its coordinates in metres unless another unit is stated."""
