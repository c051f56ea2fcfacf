"""Cutting a ring in two along a seam, and what a cut is worth."""

import numpy as np
from numba import njit

from singulation_core.polygon import FloatArray
from singulation_perception.object_points import IntArray
from singulation_perception.rings import Scale, concave_area, hull_indices, least_width, ring_area

_STRAY = 6.0  # pitches from the ends of a cut within which points of the other piece are left over
_FEWEST = 8  # points of a piece
_SMALLEST = 40.0  # square pitches, of a piece
_PER_AREA = 1.0 / 0.003  # [1/m] concave outline of 3 mm depth costs its length


@njit(cache=True)
def seam_line(
    ring: FloatArray,
    cut: FloatArray,
    index: IntArray,
    lines: FloatArray,
    fitted: IntArray,
    scale: Scale,
) -> tuple[float, float, float, float]:
    """Point and unit direction of the line through both ends of a cut and the edges that it continues.

    Edges are moved outwards by the growth first: there the block ends, and there its neighbour begins.
    """
    i, j = int(cut[0]), int(cut[1])
    points = np.empty((2 * len(ring) + 2, 2))
    points[0, 0], points[0, 1], points[1, 0], points[1, 1] = ring[i, 0], ring[i, 1], ring[j, 0], ring[j, 1]
    count = 2
    for edge in (int(cut[4]), int(cut[5])):
        if edge < 0 or not fitted[edge]:
            continue
        a, b = ring[index[edge]], ring[index[edge + 1 if edge + 1 < len(index) else 0]]
        line = lines[edge]
        steps = max(2, min(len(ring), int(np.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) / scale.pitch)))
        for step in range(steps):
            f = 0.1 + 0.8 * step / (steps - 1)
            x, y = a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1])
            off = line[2] + scale.growth - line[0] * x - line[1] * y
            points[count, 0], points[count, 1] = x + off * line[0], y + off * line[1]
            count += 1
    cx, cy = 0.0, 0.0
    for k in range(count):
        cx, cy = cx + points[k, 0] / count, cy + points[k, 1] / count
    xx, xy, yy = 0.0, 0.0, 0.0
    for k in range(count):
        x, y = points[k, 0] - cx, points[k, 1] - cy
        xx, xy, yy = xx + x * x, xy + x * y, yy + y * y
    angle = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    ux, uy = np.cos(angle), np.sin(angle)
    if ux * (ring[j, 0] - ring[i, 0]) + uy * (ring[j, 1] - ring[i, 1]) < 0.0:
        ux, uy = -ux, -uy
    return cx, cy, ux, uy


@njit(cache=True)
def piece(
    ring: FloatArray,
    first: int,
    last: int,
    line: tuple[float, float, float, float],
    sense: float,
    scale: Scale,
) -> FloatArray:
    """The part of a ring from point ``first`` to point ``last``, closed along the seam.

    Points across the seam near its ends are left out. The points on the seam lie by the growth inside the piece, like the
    points of a rim lie inside the edge, so that outlines grow back to the seam.

    Args:
        line: point and direction of the seam.
        sense: 1 if the seam runs from ``last`` to ``first``, else -1.
    """
    cx, cy, ux, uy = line[0], line[1], line[2] * sense, line[3] * sense
    size = len(ring)
    steps = (last - first) % size + 1
    a, b = ring[last], ring[first]
    start = (a[0] - cx) * ux + (a[1] - cy) * uy
    stop = (b[0] - cx) * ux + (b[1] - cy) * uy
    seam = max(2, min(4 * size, int(abs(stop - start) / scale.pitch)))
    out = np.empty((steps + seam, 2))
    count = 0
    for k in range(steps):
        p = ring[(first + k) % size]
        left = (p[1] - cy) * ux - (p[0] - cx) * uy
        near = min((p[0] - a[0]) ** 2 + (p[1] - a[1]) ** 2, (p[0] - b[0]) ** 2 + (p[1] - b[1]) ** 2)
        if left >= 0.0 or near > (_STRAY * scale.pitch) ** 2:
            out[count, 0], out[count, 1] = p[0], p[1]
            count += 1
    for k in range(1, seam):
        t = start + (stop - start) * k / seam
        out[count, 0], out[count, 1] = cx + t * ux - scale.growth * uy, cy + t * uy + scale.growth * ux
        count += 1
    return out[:count]


@njit(cache=True)
def both_pieces(
    ring: FloatArray, i: int, j: int, line: tuple[float, float, float, float], scale: Scale
) -> tuple[FloatArray, FloatArray]:
    """The two parts of a ring on either side of a cut from point i to point j."""
    return piece(ring, j, i, line, 1.0, scale), piece(ring, i, j, line, -1.0, scale)


@njit(cache=True)
def concave_cost(ring: FloatArray, roughness: float) -> float:
    """What a ring costs that is left as it is [m]: 0 if it is convex but for its roughness."""
    return concave_area(ring, hull_indices(ring), roughness) * _PER_AREA


@njit(cache=True)
def judged(
    ring: FloatArray,
    cuts: FloatArray,
    index: IntArray,
    lines: FloatArray,
    fitted: IntArray,
    scale: Scale,
    base: float,
    per_length: float,
    thin: float,
    thin_width: float,
) -> FloatArray:
    """(c, 2): the cost of each cut alone, and with what remains concave; infinite for cuts that leave no two pieces."""
    costs = np.empty((len(cuts), 2))
    for k in range(len(cuts)):
        costs[k, 0], costs[k, 1] = np.inf, np.inf
        i, j = int(cuts[k, 0]), int(cuts[k, 1])
        if i == j:
            continue
        line = seam_line(ring, cuts[k], index, lines, fitted, scale)
        width, left = np.inf, 0.0
        for part in both_pieces(ring, i, j, line, scale):
            if len(part) < _FEWEST or ring_area(part) < _SMALLEST * scale.pitch**2:
                width = -1.0
                break
            hull = hull_indices(part)
            width = min(width, least_width(part, hull))
            left += concave_area(part, hull, scale.roughness) * _PER_AREA
        if width >= 0.0:
            costs[k, 0] = base + per_length * cuts[k, 2] + cuts[k, 3] + thin * max(0.0, 1.0 - width / thin_width)
            costs[k, 1] = costs[k, 0] + left
    return costs
