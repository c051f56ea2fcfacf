"""How far an object can go before it meets another, and how much stands in its way."""

import numpy as np

from singulation_core.jit import compiled_maker, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray

# The moving outline is shrunk by this share, so that a neighbour it only slides along is not in its way.
_SHRINK = 0.02


@compiled_part
def _vertex_to_edges(
    u: float,
    w: float,
    vertices: FloatArray,
    first: int,
    last: int,
    x: float,
    y: float,
    dx: float,
    dy: float,
    sign: float,
) -> float:
    """Distance of a point moving along +u (sign 1) or -u (sign -1) to the edges of an outline that face it [m]."""
    nearest = np.inf
    for k in range(first, last):
        after = k + 1 if k + 1 < last else first
        rx, ry = vertices[k, 0] - x, vertices[k, 1] - y
        u1, w1 = rx * dx + ry * dy, ry * dx - rx * dy
        rx, ry = vertices[after, 0] - x, vertices[after, 1] - y
        u2, w2 = rx * dx + ry * dy, ry * dx - rx * dy
        if sign * (w2 - w1) < 0.0 and min(w1, w2) <= w <= max(w1, w2):
            nearest = min(nearest, sign * (u1 + (u2 - u1) * (w - w1) / (w2 - w1) - u))
    return nearest


@compiled_maker
def free_travel(
    centroids: FloatArray,
    radii: FloatArray,
    vertices: FloatArray,
    firsts: IntArray,
    index: int,
    partner: int,
    dx: float,
    dy: float,
    limit: float,
) -> float:
    """How far object ``index`` can move along (dx, dy) until it meets another than ``partner``, at most ``limit`` [m].

    Args:
        centroids, radii, vertices, firsts: as in ``Scene``.
        partner: object that does not count, -1 for none.
    """
    free = limit
    x, y = centroids[index, 0], centroids[index, 1]
    slack = 2.0 * _SHRINK * radii[index]
    shrunk = x * _SHRINK, y * _SHRINK
    own = np.empty((firsts[index + 1] - firsts[index], 2))
    for k in range(len(own)):
        own[k, 0] = vertices[firsts[index] + k, 0] * (1.0 - _SHRINK) + shrunk[0]
        own[k, 1] = vertices[firsts[index] + k, 1] * (1.0 - _SHRINK) + shrunk[1]
    for j in range(len(radii)):
        rx, ry = centroids[j, 0] - x, centroids[j, 1] - y
        reach = radii[index] + radii[j]
        along, across = rx * dx + ry * dy, ry * dx - rx * dy
        if j in (index, partner) or abs(across) >= reach or not (-reach < along < free + reach):
            continue
        for k in range(len(own)):
            u, w = (own[k, 0] - x) * dx + (own[k, 1] - y) * dy, (own[k, 1] - y) * dx - (own[k, 0] - x) * dy
            gap = _vertex_to_edges(u, w, vertices, firsts[j], firsts[j + 1], x, y, dx, dy, 1.0)
            if gap >= -slack:
                free = min(free, max(0.0, gap))
        for k in range(firsts[j], firsts[j + 1]):
            u = (vertices[k, 0] - x) * dx + (vertices[k, 1] - y) * dy
            w = (vertices[k, 1] - y) * dx - (vertices[k, 0] - x) * dy
            gap = _vertex_to_edges(u, w, own, 0, len(own), x, y, dx, dy, -1.0)
            if gap >= -slack:
                free = min(free, max(0.0, gap))
    return free


@compiled_maker
def obstructed_widths(
    centroids: FloatArray, vertices: FloatArray, firsts: IntArray, index: int, directions: FloatArray, reach: float
) -> FloatArray:
    """(k,) for each direction the width of the object's path that others, up to ``reach`` ahead, stand in [m]."""
    result = np.zeros(len(directions))
    x, y = centroids[index, 0], centroids[index, 1]
    for d in range(len(directions)):
        dx, dy = directions[d, 0], directions[d, 1]
        low, high = np.inf, -np.inf
        for k in range(firsts[index], firsts[index + 1]):
            w = (vertices[k, 1] - y) * dx - (vertices[k, 0] - x) * dy
            low, high = min(low, w), max(high, w)
        for j in range(len(centroids)):
            along = (centroids[j, 0] - x) * dx + (centroids[j, 1] - y) * dy
            if j == index or not (0.0 < along < reach):
                continue
            left, right = np.inf, -np.inf
            for k in range(firsts[j], firsts[j + 1]):
                w = (vertices[k, 1] - y) * dx - (vertices[k, 0] - x) * dy
                left, right = min(left, w), max(right, w)
            result[d] += max(0.0, min(high, right) - max(low, left))
    return result
