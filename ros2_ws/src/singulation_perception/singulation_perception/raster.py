"""The numbers of an organized cloud as compiled code reads them: in place, whatever the layout of the message."""

from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

_FLOAT = 4  # bytes


class Raster(NamedTuple):
    """A cloud in image order; a named tuple, because compiled code takes it.

    Point (row, column) begins at number ``row * row_step + column * point_step``.

    Args:
        numbers: (n,) float32, read-only, so that one compiled form serves every cloud.
        height: rows.
        width: columns.
        row_step: numbers from a row to the next.
        point_step: numbers from a point to the next.
    """

    numbers: NDArray[np.float32]
    height: int
    width: int
    row_step: int
    point_step: int


def raster_of(points: NDArray[np.float32]) -> Raster:
    """View of (H, W, 3) aligned float32 points; a copy only if their strides are none that a message can have."""
    height, width = points.shape[:2]
    row, point, number = points.strides
    if height == 1:
        row = max(row, width * point)
    if number != _FLOAT or min(row, point) <= 0 or row % _FLOAT or point % _FLOAT:
        points = np.ascontiguousarray(points)
        row, point, _ = points.strides
    size = ((height - 1) * row + (width - 1) * point) // _FLOAT + 3
    numbers = as_strided(points, (size,), (_FLOAT,), writeable=False)
    return Raster(numbers, height, width, row // _FLOAT, point // _FLOAT)
