"""Overlap of all pairs of convex outlines."""

import numpy as np

from singulation_core.jit import compiled, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray


@compiled_part
def _widest_gap(vertices: FloatArray, first: int, last: int, other_first: int, other_last: int) -> float:
    """Largest gap between two outlines along the outward edge normals of the first [m]; negative: overlap."""
    widest = -np.inf
    for k in range(first, last):
        after = k + 1 if k + 1 < last else first
        x, y = vertices[k, 0], vertices[k, 1]
        nx, ny = vertices[after, 1] - y, x - vertices[after, 0]
        length = np.sqrt(nx * nx + ny * ny)
        nearest = np.inf
        for m in range(other_first, other_last):
            nearest = min(nearest, (vertices[m, 0] - x) * nx + (vertices[m, 1] - y) * ny)
        widest = max(widest, nearest / length)
    return widest


@compiled
def deepest_overlap(
    centroids: FloatArray, radii: FloatArray, vertices: FloatArray, firsts: IntArray, tolerance: float
) -> tuple[int, int, float]:
    """The pair that overlaps most, measured in units of the smaller bounding radius.

    Args:
        centroids, radii, vertices, firsts: as in ``Scene``.
        tolerance: depth that is not reported, in units of the smaller bounding radius.

    Returns:
        Indices of both (-1 if no pair overlaps by more than ``tolerance``) and the depth [m].
    """
    worst, one, other, depth = tolerance, -1, -1, 0.0
    for i in range(len(radii)):
        for j in range(i + 1, len(radii)):
            dx, dy = centroids[j, 0] - centroids[i, 0], centroids[j, 1] - centroids[i, 1]
            reach = radii[i] + radii[j]
            if dx * dx + dy * dy >= reach * reach:
                continue
            gap = _widest_gap(vertices, firsts[i], firsts[i + 1], firsts[j], firsts[j + 1])
            if gap < 0.0:
                gap = max(gap, _widest_gap(vertices, firsts[j], firsts[j + 1], firsts[i], firsts[i + 1]))
            smaller = min(radii[i], radii[j])
            share = -gap / smaller
            if dx * dx + dy * dy < 1e-12 * smaller * smaller:
                share = np.inf  # no direction leads from one centroid to the other
            if share > worst:
                worst, one, other, depth = share, i, j, -gap
    return one, other, depth
