"""The points of a cloud in Euclidean clustering: bounds, runs that share a cell, whether two are linked."""

import numpy as np
from numpy.typing import NDArray

from singulation_perception.jit import compiled_maker, compiled_part

IntArray = NDArray[np.int32]
Keys = NDArray[np.int64]
FloatArray = NDArray[np.float64]
Cloud = NDArray[np.float32]

PAD = 2  # cells farther apart than two hold no linked points
_CHUNK = 96  # numbers that are compared with as many bounds at once; a multiple of three
_BLOCK = 512  # points that are turned into numbers of cells at once


@compiled_maker
def bounds(cloud: Cloud) -> tuple[FloatArray, FloatArray, bool]:
    """Least and greatest coordinates, (3,) each, and whether all are finite; if not, the bounds mean nothing.

    Each number of a chunk has bounds of its own, which makes vector instructions of the comparisons.
    """
    numbers = cloud.reshape(-1)
    least, greatest = np.full(_CHUNK, np.inf, dtype=np.float32), np.full(_CHUNK, -np.inf, dtype=np.float32)
    nothing = np.zeros(_CHUNK, dtype=np.float32)  # zero times what is not finite is not a number
    for begin in range(0, len(numbers), _CHUNK):
        for k in range(min(_CHUNK, len(numbers) - begin)):
            value = numbers[np.uintp(begin) + np.uintp(k)]
            least[k] = value if value < least[k] else least[k]
            greatest[k] = value if value > greatest[k] else greatest[k]
            nothing[k] += np.float32(0.0) * value
    finite = nothing[0] == 0.0
    for k in range(1, _CHUNK):
        finite = finite and nothing[k] == 0.0
        least[k % 3], greatest[k % 3] = min(least[k % 3], least[k]), max(greatest[k % 3], greatest[k])
    return least[:3].astype(np.float64), greatest[:3].astype(np.float64), finite


@compiled_maker
def runs_of(cloud: Cloud, low: FloatArray, scale: float, width: int) -> tuple[IntArray, Keys, IntArray]:
    """Runs of points that follow each other in one cell.

    Args:
        cloud: (n, 3) finite points.
        low: (3,) least coordinates.
        scale: cells per metre.
        width: columns in a row.

    Returns:
        (r + 1,) first point of each run, the last one n; (r,) number of its column; (r,) its place in z.
    """
    begin = np.empty(len(cloud) + 1, dtype=np.int32)
    key, depth = np.empty(len(cloud) + 1, dtype=np.int64), np.empty(len(cloud) + 1, dtype=np.int32)
    columns, levels = np.empty(_BLOCK, dtype=np.int64), np.empty(_BLOCK, dtype=np.int32)
    numbers, x0, y0, z0 = cloud.reshape(-1), low[0], low[1], low[2]
    count, last_column, last_level = np.uintp(0), np.int64(-1), np.int32(-1)
    for first in range(0, len(cloud), _BLOCK):
        size = min(_BLOCK, len(cloud) - first)
        for k in range(size):
            at = np.uintp(3) * (np.uintp(first) + np.uintp(k))
            x, y = np.int32((numbers[at] - x0) * scale), np.int32((numbers[at + np.uintp(1)] - y0) * scale)
            columns[k] = (np.int64(y) + PAD) * np.int64(width) + np.int64(x) + PAD
            levels[k] = np.int32((numbers[at + np.uintp(2)] - z0) * scale) + np.int32(PAD)
        for k in range(size):
            column, level = columns[np.uintp(k)], levels[np.uintp(k)]
            begin[count], key[count], depth[count] = first + k, column, level  # no branch: the next may write over it
            count += np.uintp((column != last_column) | (level != last_level))
            last_column, last_level = column, level
    begin[count] = len(cloud)
    return begin[: count + np.uintp(1)], key[:count], depth[:count]


@compiled_part
def near(cloud: Cloud, i: int, j: int, squared: np.float32) -> bool:
    """Whether two points are linked."""
    dx, dy, dz = cloud[i, 0] - cloud[j, 0], cloud[i, 1] - cloud[j, 1], cloud[i, 2] - cloud[j, 2]
    return dx * dx + dy * dy + dz * dz < squared
