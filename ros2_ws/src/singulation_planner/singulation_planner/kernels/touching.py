"""Where two blocks touch, or would touch first, as they lie: what the score knows of outlines."""

import numpy as np

from singulation_core.gyration import squared_gyration
from singulation_core.jit import compiled_maker, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray

_LEVEL = 0.05  # vertices that lie back by no more than this belong to the side that touches, in units of the scale


@compiled_part
def _side(
    vertices: FloatArray, first: int, last: int, nx: float, ny: float, level: float
) -> tuple[float, float, float]:
    """The side of an outline that faces (nx, ny): from and to along the normal turned left, and its height."""
    height = -np.inf
    for k in range(first, last):
        height = max(height, vertices[k, 0] * nx + vertices[k, 1] * ny)
    low, high = np.inf, -np.inf
    for k in range(first, last):
        if vertices[k, 0] * nx + vertices[k, 1] * ny >= height - level:
            along = vertices[k, 1] * nx - vertices[k, 0] * ny
            low, high = min(low, along), max(high, along)
    return low, high, height


@compiled_maker
def touching(
    centroids: FloatArray, vertices: FloatArray, firsts: IntArray, edges: IntArray, scale: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Contacts of all pairs.

    Args:
        centroids, vertices, firsts, scale: as in ``Scene``.
        edges: (n, n) from ``all_gaps``.

    Returns:
        (n, n, 3) normal from block i to block j, and how far the centroids are apart along it when they touch [m];
        (n, n, 2) from the centroid of j to where i touches it [m]; (n,) moments of inertia over mass [m^2].
    """
    n = len(centroids)
    planes, arms, gyrations = np.zeros((n, n, 3)), np.zeros((n, n, 2)), np.empty(n)
    for i in range(n):
        gyrations[i] = squared_gyration(vertices, firsts[i], firsts[i + 1], centroids[i, 0], centroids[i, 1])
        for j in range(i):
            k = edges[i, j]
            own = firsts[i] <= k < firsts[i + 1]
            owner = i if own else j
            after = k + 1 if k + 1 < firsts[owner + 1] else firsts[owner]
            ex, ey = vertices[after, 0] - vertices[k, 0], vertices[after, 1] - vertices[k, 1]
            size = np.sqrt(ex * ex + ey * ey) if own else -np.sqrt(ex * ex + ey * ey)
            nx, ny = ey / size, -ex / size
            low, high, height = _side(vertices, firsts[i], firsts[i + 1], nx, ny, _LEVEL * scale)
            left, right, depth = _side(vertices, firsts[j], firsts[j + 1], -nx, -ny, _LEVEL * scale)
            along = 0.5 * (max(low, -right) + min(high, -left))
            apart = (centroids[j, 0] - centroids[i, 0]) * nx + (centroids[j, 1] - centroids[i, 1]) * ny
            planes[i, j, 0], planes[i, j, 1], planes[i, j, 2] = nx, ny, apart - max(0.0, -depth - height)
            planes[j, i, 0], planes[j, i, 1], planes[j, i, 2] = -nx, -ny, planes[i, j, 2]
            arms[i, j, 0] = -nx * depth - ny * along - centroids[j, 0]
            arms[i, j, 1] = -ny * depth + nx * along - centroids[j, 1]
            arms[j, i, 0] = nx * height - ny * along - centroids[i, 0]
            arms[j, i, 1] = ny * height + nx * along - centroids[i, 1]
    return planes, arms, gyrations
