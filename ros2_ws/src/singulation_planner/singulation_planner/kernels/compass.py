"""Directions that turn with the scene, and orders that do not hang on rounding errors."""

import numpy as np

from singulation_core.jit import compiled_maker
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray

_DEGENERATE = 1e-6  # in units of the scale; a shorter vector has no direction
_RESOLUTION = 1e9  # scores closer than a billionth of the scale are equal


@compiled_maker
def away(centroids: FloatArray, index: int, scale: float) -> FloatArray:
    """(2,) unit vector from the mean of all centroids to that of object ``index``.

    An object in their very middle has no such direction; then away from the nearest other one, or along x.
    """
    n = len(centroids)
    x, y = centroids[index, 0], centroids[index, 1]
    vx, vy = x, y
    for j in range(n):
        vx -= centroids[j, 0] / n
        vy -= centroids[j, 1] / n
    if vx * vx + vy * vy <= (_DEGENERATE * scale) ** 2:
        nearest = np.inf
        for j in range(n):
            dx, dy = x - centroids[j, 0], y - centroids[j, 1]
            distance = np.floor(np.sqrt(dx * dx + dy * dy) / scale * _RESOLUTION + 0.5)
            if j != index and distance < nearest:
                nearest, vx, vy = distance, dx, dy
    length = np.sqrt(vx * vx + vy * vy)
    if length <= _DEGENERATE * scale:
        return np.array((1.0, 0.0))
    return np.array((vx / length, vy / length))


@compiled_maker
def fan(first: FloatArray, count: int) -> FloatArray:
    """(count, 2) evenly spread unit vectors, counter-clockwise from ``first``."""
    directions = np.empty((count, 2))
    for k in range(count):
        cosine, sine = np.cos(2.0 * np.pi * k / count), np.sin(2.0 * np.pi * k / count)
        directions[k, 0] = first[0] * cosine - first[1] * sine
        directions[k, 1] = first[0] * sine + first[1] * cosine
    return directions


@compiled_maker
def fans(centroids: FloatArray, count: int, scale: float) -> FloatArray:
    """(n count, 2) the fans of all objects, each with its first direction away from the others."""
    n = len(centroids)
    directions = np.empty((n * count, 2))
    for i in range(n):
        one = fan(away(centroids, i, scale), count)
        for k in range(count):
            directions[i * count + k, 0], directions[i * count + k, 1] = one[k, 0], one[k, 1]
    return directions


@compiled_maker
def ascending(scores: FloatArray, scale: float) -> IntArray:
    """Order of a few dozen scores, smallest first; those that differ by less than rounding errors keep their order."""
    n = len(scores)
    keys = np.floor(scores / scale * _RESOLUTION + 0.5)
    order = np.arange(n)
    for k in range(1, n):
        moving, m = order[k], k
        while m > 0 and keys[order[m - 1]] > keys[moving]:
            order[m] = order[m - 1]
            m -= 1
        order[m] = moving
    return order
