"""Closed boundaries as compiled code sees them: (m, 2) points in order, counter-clockwise, the last joined to the
first.

Lengths are in metres. ``roughness`` is the depth up to which a rim counts as straight: lost points make it up to two
point spacings rough, noise along an oblique line of sight some more.
"""

import math
from typing import NamedTuple

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.jit import compiled_part, compiled_part_maker
from singulation_perception.object_points import IntArray


class Scale(NamedTuple):
    """Lengths that belong to a cloud and a face in it [m].

    Args:
        pitch: distance of neighbouring points.
        growth: by which blocks end outside the outer limit of the points on their rim.
        roughness: depth up to which a rim counts as straight.
    """

    pitch: float
    growth: float
    roughness: float


_RANK = 4  # points that must lie that deep: less is a hole at the rim


@compiled_part
def ring_area(ring: FloatArray) -> float:
    """Signed area [m^2], positive when counter-clockwise."""
    total = 0.0
    for i in range(len(ring)):
        j = i + 1 if i + 1 < len(ring) else 0
        total += (ring[i, 0] - ring[0, 0]) * (ring[j, 1] - ring[0, 1])
        total -= (ring[j, 0] - ring[0, 0]) * (ring[i, 1] - ring[0, 1])
    return 0.5 * total


@compiled_part_maker
def concave_area(ring: FloatArray, hull: IntArray, roughness: float) -> float:
    """Area between a ring and its hull, of the pockets deeper than the roughness of the rim [m^2]."""
    found = pockets(ring, hull, roughness)
    total = 0.0
    for k in range(len(found)):
        total += found[k, 2]
    return total


@compiled_part_maker
def pockets(ring: FloatArray, hull: IntArray, roughness: float) -> FloatArray:
    """(p, 4) of the pockets between ring and hull that are deeper than ``roughness`` [m]: first and last point, area
    [m^2] and depth [m].

    The last may lie beyond the end of the ring: count on from its start.
    """
    corners = _in_order(hull)
    found, deepest = np.empty((len(corners), 4)), np.empty(_RANK)
    count = 0
    for k in range(len(corners)):
        first = np.int64(corners[k])
        last = np.int64(corners[k + 1]) if k + 1 < len(corners) else np.int64(corners[0]) + len(ring)
        if last - first > _RANK and _stands_back(ring, first, last, roughness):
            area, depth = _pocket(ring, first, last, deepest)
            if depth > roughness:
                found[count, 0], found[count, 1], found[count, 2], found[count, 3] = first, last, area, depth
                count += 1
    return found[:count]


@compiled_part_maker
def _in_order(hull: IntArray) -> IntArray:
    """Numbers of the corners sorted: noise along the line of sight can make a ring, and with it its hull, skip back."""
    corners = hull.copy()
    for k in range(1, len(corners)):
        value, at = corners[k], k
        while at > 0 and corners[at - 1] > value:
            corners[at] = corners[at - 1]
            at -= 1
        corners[at] = value
    return corners


@compiled_part
def _stands_back(ring: FloatArray, first: int, last: int, roughness: float) -> bool:
    """Whether any point behind one edge of the hull is deeper than ``roughness`` [m]; behind most edges none is."""
    size = len(ring)
    end = last if last < size else last - size
    ax, ay = ring[first, 0], ring[first, 1]
    ex, ey = ring[end, 0] - ax, ring[end, 1] - ay
    deepest = 0.0
    for at in range(first + 1, last):
        i = at if at < size else at - size
        deepest = max(deepest, ex * (ring[i, 1] - ay) - ey * (ring[i, 0] - ax))
    return deepest > roughness * math.sqrt(ex * ex + ey * ey)


@compiled_part
def _pocket(ring: FloatArray, first: int, last: int, deepest: FloatArray) -> tuple[float, float]:
    """Area behind one edge of the hull and how deep its fourth deepest point lies; ``deepest`` is worked in."""
    size = len(ring)
    end = last if last < size else last - size
    ex, ey = ring[end, 0] - ring[first, 0], ring[end, 1] - ring[first, 1]
    length = math.sqrt(ex * ex + ey * ey)
    if length == 0.0:
        return 0.0, 0.0
    for place in range(_RANK):
        deepest[place] = 0.0
    area = 0.0
    before_x, before_y = 0.0, 0.0
    for at in range(first + 1, last + 1):
        i = at if at < size else at - size
        x, y = ring[i, 0] - ring[first, 0], ring[i, 1] - ring[first, 1]
        area += before_x * y - before_y * x
        before_x, before_y = x, y
        depth = (ex * y - ey * x) / length
        place = _RANK - 1
        if depth > deepest[place]:
            while place > 0 and deepest[place - 1] < depth:
                deepest[place] = deepest[place - 1]
                place -= 1
            deepest[place] = depth
    return 0.5 * abs(area), deepest[_RANK - 1]


@compiled_part
def least_width(ring: FloatArray, hull: IntArray) -> float:
    """Distance of the closest pair of parallel lines that hold the ring [m]."""
    least, count, opposite = np.inf, len(hull), -1
    for k in range(count):  # the corner opposite to an edge moves on as the edge does (Shamos 1978)
        a, b = hull[k], hull[k + 1] if k + 1 < count else hull[0]
        ex, ey = ring[b, 0] - ring[a, 0], ring[b, 1] - ring[a, 1]
        length = math.sqrt(ex * ex + ey * ey)
        if length > 0.0:
            if opposite < 0:
                opposite = _opposite(ring, hull, a, ex, ey)
            off = ex * (ring[hull[opposite], 1] - ring[a, 1]) - ey * (ring[hull[opposite], 0] - ring[a, 0])
            for _ in range(count):
                following = opposite + 1 if opposite + 1 < count else 0
                more = ex * (ring[hull[following], 1] - ring[a, 1]) - ey * (ring[hull[following], 0] - ring[a, 0])
                if more < off:
                    break
                opposite, off = following, more
            least = min(least, off / length)
    return least if least < np.inf else 0.0


@compiled_part
def _opposite(ring: FloatArray, hull: IntArray, start: int, x: float, y: float) -> int:
    """Which corner of a hull lies farthest to the left of a line from one of its points."""
    best, most = 0, -np.inf
    for k in range(len(hull)):
        off = x * (ring[hull[k], 1] - ring[start, 1]) - y * (ring[hull[k], 0] - ring[start, 0])
        if off > most:
            best, most = k, off
    return best
