"""Parts of a face that the camera cannot see because something taller stands in the way."""

from functools import lru_cache
from typing import Any

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.cloud_sample import ANY_CLOUD
from singulation_perception.object_points import IntArray
from singulation_perception.rings import hull_indices, pockets

_SEEN_LOWER = 0.3  # share of a pocket that is seen to be lower, from which on it is empty
_TALLER = 0.03  # share of taller points around a pocket that can have hidden it
_AROUND = 6  # pixels


def without_hidden(
    ring: FloatArray, pixels: IntArray, roughness: float, cloud: NDArray[np.float32], plane: FloatArray, height: float
) -> tuple[FloatArray, float]:
    """Bridges the pockets of a ring that are hidden rather than empty.

    A pocket counts as hidden if less than 30 % of it is seen to be lower than the face and something taller is near.

    Args:
        ring: (m, 2) rim of a face [m].
        pixels: (m, 2) rows and columns of its points.
        roughness: of the rim [m].
        cloud: (H, W, 3), camera frame.
        plane: (4,) of the table in the camera frame.
        height: of the face [m].

    Returns:
        The ring without the hidden pockets, and the length of what was bridged [m].
    """
    hull = hull_indices(ring)
    keep = np.ones(len(ring), dtype=bool)
    bridged = 0.0
    for first, last in pockets(ring, hull, roughness):
        around = np.arange(first, last + 1) % len(ring)
        lower, taller, inside, near = _compiled()(
            cloud, plane.astype(np.float32), np.ascontiguousarray(pixels[around]),
            np.float32(height - roughness), np.float32(height + roughness), _AROUND,
        )  # fmt: skip
        if lower < _SEEN_LOWER * inside and taller > _TALLER * near:
            keep[around[1:-1]] = False
            bridged += float(np.hypot(*(ring[around[-1]] - ring[around[0]])))
    return ring[keep], bridged


@lru_cache(maxsize=1)
def _compiled() -> Any:
    return njit(
        types.UniTuple(types.int64, 4)(
            ANY_CLOUD, types.float32[::1], types.int32[:, ::1], types.float32, types.float32, types.int64
        ),
        cache=True,
    )(_look)


def _look(
    cloud: NDArray[np.float32],
    plane: NDArray[np.float32],
    pocket: IntArray,
    low: np.float32,
    high: np.float32,
    around: int,
) -> tuple[int, int, int, int]:
    """Points seen lower inside a pocket, taller in and around it, and pixels inside and around."""
    top, left, bottom, right = cloud.shape[0], cloud.shape[1], 0, 0
    for i in range(len(pocket)):
        top, bottom = min(top, pocket[i, 0]), max(bottom, pocket[i, 0] + 1)
        left, right = min(left, pocket[i, 1]), max(right, pocket[i, 1] + 1)
    top, bottom = max(0, top - around), min(cloud.shape[0], bottom + around)
    left, right = max(0, left - around), min(cloud.shape[1], right + around)
    inside_row = np.empty(right - left, dtype=np.int32)
    lower, taller, inside = 0, 0, 0
    for row in range(top, bottom):
        for column in range(right - left):
            inside_row[column] = 0
        for i in range(len(pocket)):  # the row is inside between crossings: parity, summed from the left
            r, q = pocket[i, 0], pocket[i - 1, 0]
            if (r > row) != (q > row):
                crossing = pocket[i, 1] + (row - r) * (pocket[i - 1, 1] - pocket[i, 1]) / (q - r)
                inside_row[int(np.ceil(crossing)) - left] ^= 1
        within = 0
        for column in range(left, right):
            within ^= inside_row[column - left]
            inside += within
            a, b, c = cloud[row, column, 0], cloud[row, column, 1], cloud[row, column, 2]
            level = a * plane[0] + b * plane[1] + c * plane[2] + plane[3]
            if np.isfinite(level) and not (a == 0.0 and b == 0.0 and c == 0.0):
                taller += level > high
                lower += within == 1 and level < low
    return lower, taller, inside, (bottom - top) * (right - left)
