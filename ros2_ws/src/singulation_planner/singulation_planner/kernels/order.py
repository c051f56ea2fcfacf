"""An order of objects that does not depend on how they are numbered."""

import numpy as np

from singulation_core.jit import compiled_maker, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray

_RESOLUTION = 1e6  # sizes and distances closer than a millionth of the largest bounding radius are equal


@compiled_part
def _before(keys: FloatArray, one: int, other: int) -> bool:
    for k in range(keys.shape[1]):
        if keys[one, k] != keys[other, k]:
            return keys[one, k] < keys[other, k]
    return False


@compiled_part
def _mean(points: FloatArray, axis: int, room: FloatArray) -> float:
    """Mean of a column: of its sorted numbers, whose sum is the same in whatever order they came."""
    total = 0.0
    for k in range(len(points)):
        m = k
        while m > 0 and room[m - 1] > points[k, axis]:
            room[m] = room[m - 1]
            m -= 1
        room[m] = points[k, axis]
    for k in range(len(points)):
        total += room[k]
    return total / len(points)


@compiled_maker
def canonical_order(centroids: FloatArray, radii: FloatArray, areas: FloatArray) -> IntArray:
    """(n,) objects by bounding radius, area, distance from the mean of all centroids, x and y, smallest first.

    Args:
        centroids, radii, areas: (n, 2) [m], (n,) [m], (n,) [m^2], in any order.
    """
    n, largest, room = len(radii), 0.0, np.empty(len(radii))
    for i in range(n):
        largest = max(largest, radii[i])
    mean_x, mean_y = _mean(centroids, 0, room), _mean(centroids, 1, room)
    keys = np.empty((n, 5))
    for i in range(n):
        x, y = centroids[i, 0], centroids[i, 1]
        distance = np.sqrt((x - mean_x) ** 2 + (y - mean_y) ** 2)
        keys[i, 0] = np.floor(radii[i] / largest * _RESOLUTION + 0.5)
        keys[i, 1] = np.floor(areas[i] / largest**2 * _RESOLUTION + 0.5)
        keys[i, 2] = np.floor(distance / largest * _RESOLUTION + 0.5)
        keys[i, 3], keys[i, 4] = x, y
    order = np.arange(n)
    for k in range(1, n):
        moving, m = order[k], k
        while m > 0 and _before(keys, moving, order[m - 1]):
            order[m] = order[m - 1]
            m -= 1
        order[m] = moving
    return order
