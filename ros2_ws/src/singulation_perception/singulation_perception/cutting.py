"""Cutting a ring in two along a seam, and what a cut is worth."""

import math

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.hull import hull_indices
from singulation_perception.jit import compiled_maker, compiled_part, compiled_part_maker
from singulation_perception.object_points import IntArray
from singulation_perception.rings import Scale, concave_area, least_width, ring_area

_STRAY = 6.0  # pitches from the ends of a cut within which points of the other piece are left over
_BESIDE_END = 12.0  # pitches from the end of a cut within which the rim shows where the corner of a piece is
_FEWEST = 8  # points of a piece
_SMALLEST = 40.0  # square pitches, of a piece
PER_AREA = 1.0 / 0.003  # [1/m] concave outline of 3 mm depth costs its length
_CUT, _LENGTH = 0.003, 0.35  # [m] cost of every cut, and per metre of it
_THIN, _THIN_WIDTH = 0.02, 0.025  # [m] cost of a piece without width, and the width that costs nothing


@compiled_part_maker
def piece(
    ring: FloatArray,
    first: int,
    last: int,
    line: tuple[float, float, float, float],
    sense: float,
    scale: Scale,
) -> FloatArray:
    """The part of a ring from point ``first`` to point ``last``, closed along the seam.

    Points across the seam near its ends are left out. The points on the seam lie by the growth inside the piece, like
    the points of a rim lie inside the edge, so that outlines grow back to the seam.

    Args:
        line: point and direction of the seam.
        sense: 1 if the seam runs from ``last`` to ``first``, else -1.
    """
    cx, cy, ux, uy = line[0], line[1], line[2] * sense, line[3] * sense
    size = len(ring)
    steps = (last - first) % size + 1
    ax, ay, bx, by = ring[last, 0], ring[last, 1], ring[first, 0], ring[first, 1]
    start = (ax - cx) * ux + (ay - cy) * uy
    stop = (bx - cx) * ux + (by - cy) * uy
    way = 1.0 if stop > start else -1.0
    start += way * _overshoot(ring, last, np.int64(-1), steps, (cx, cy, ux, uy), way, scale)
    stop -= way * _overshoot(ring, first, np.int64(1), steps, (cx, cy, ux, uy), -way, scale)
    stray = _STRAY * scale.pitch
    seam = max(2, min(4 * size, int(abs(stop - start) / scale.pitch)))
    out = np.empty((steps + seam, 2))
    count = 0
    for k in range(steps):
        i = (first + k) % size
        x, y = ring[i, 0], ring[i, 1]
        near = min((x - ax) * (x - ax) + (y - ay) * (y - ay), (x - bx) * (x - bx) + (y - by) * (y - by))
        if (y - cy) * ux - (x - cx) * uy >= scale.roughness or near > stray * stray:
            out[count, 0], out[count, 1] = x, y
            count += 1
    for k in range(1, seam):
        t = start + (stop - start) * k / seam
        out[count, 0], out[count, 1] = cx + t * ux - scale.growth * uy, cy + t * uy + scale.growth * ux
        count += 1
    return out[:count]


@compiled_part
def _overshoot(
    ring: FloatArray, end: int, step: int, steps: int, line: tuple[float, float, float, float], way: float, scale: Scale
) -> float:
    """How far outside the corner of its piece a cut begins [m]: the rim of the piece, continued to the cut, tells.

    Args:
        end: point of the ring at the beginning of the cut.
        step: 1 or -1, from there along the rim of the piece.
        steps: points of that rim.
        line: point and direction of the seam, with the piece to its left.
        way: sign, along the direction, of what lies inside.
    """
    cx, cy, ux, uy = line
    size = len(ring)
    most = _BESIDE_END * scale.pitch
    n, a, t, aa, at = 0, 0.0, 0.0, 0.0, 0.0
    for k in range(min(steps // 2, int(2.0 * _BESIDE_END))):
        i = (end + step * k) % size
        x, y = ring[i, 0] - cx, ring[i, 1] - cy
        across, along = y * ux - x * uy, x * ux + y * uy
        if scale.roughness < across < most:
            n, a, t, aa, at = n + 1, a + across, t + along, aa + across * across, at + across * along
    spread = n * aa - a * a
    if n < 4 or not (spread > 0.0):
        return 0.0
    slope = (n * at - a * t) / spread
    corner = (t - slope * a) / n + slope * scale.growth
    begin = (ring[end, 0] - cx) * ux + (ring[end, 1] - cy) * uy
    beyond = way * (corner - begin) - scale.pitch * math.sqrt(1.0 + slope * slope)  # points of a rim lie inside
    return beyond if scale.pitch < beyond < _STRAY * scale.pitch else 0.0


@compiled_maker
def both_pieces(
    ring: FloatArray, i: int, j: int, line: tuple[float, float, float, float], scale: Scale
) -> tuple[FloatArray, FloatArray]:
    """The two parts of a ring on either side of a cut from point i to point j."""
    return piece(ring, j, i, line, 1.0, scale), piece(ring, i, j, line, -1.0, scale)


@compiled_maker
def concave_cost(ring: FloatArray, roughness: float) -> float:
    """What a ring costs that is left as it is [m]: 0 if it is convex but for its roughness."""
    return concave_area(ring, hull_indices(ring), roughness) * PER_AREA


@compiled_part_maker
def estimated(ring: FloatArray, cuts: FloatArray, index: IntArray, scale: Scale) -> FloatArray:
    """(c, 3): what the seam, what thin pieces, and what both and the remaining concave parts cost.

    Judged from the corners of the ring only.
    The last is infinite for cuts that leave no two pieces.
    """
    costs = np.empty((len(cuts), 3))
    for k in range(len(cuts)):
        costs[k, 0], costs[k, 1], costs[k, 2] = 0.0, 0.0, np.inf
        i, j = np.int64(cuts[k, 0]), np.int64(cuts[k, 1])
        width, left = np.inf, 0.0
        for first, last in ((i, j), (j, i)):
            part = _corner_piece(ring, index, first, last)
            if len(part) < 3 or ring_area(part) < _SMALLEST * scale.pitch * scale.pitch:
                width = -1.0
                break
            hull = hull_indices(part)
            width = min(width, least_width(part, hull))
            left += _corner_pockets(part, hull, scale.roughness) * PER_AREA
        if width >= 0.0:
            costs[k, 0] = _CUT + _LENGTH * cuts[k, 2] + cuts[k, 3]
            costs[k, 1] = _THIN * max(0.0, 1.0 - width / _THIN_WIDTH)
            costs[k, 2] = costs[k, 0] + costs[k, 1] + left
    return costs


@compiled_part_maker
def _corner_piece(ring: FloatArray, index: IntArray, first: int, last: int) -> FloatArray:
    """Corners of a ring from one point to another, both included."""
    size = len(ring)
    span = (last - first) % size
    start, nearest = 0, size
    for k in range(len(index)):
        ahead = (index[k] - first) % size
        if 0 < ahead < nearest:
            start, nearest = k, ahead
    part = np.empty((len(index) + 2, 2))
    part[0, 0], part[0, 1] = ring[first, 0], ring[first, 1]
    count = 1
    for k in range(len(index)):
        point = np.int64(index[(start + k) % len(index)])
        if (point - first) % size >= span or point == first:
            break
        part[count, 0], part[count, 1] = ring[point, 0], ring[point, 1]
        count += 1
    part[count, 0], part[count, 1] = ring[last, 0], ring[last, 1]
    return part[: count + 1]


@compiled_part
def _corner_pockets(part: FloatArray, hull: IntArray, roughness: float) -> float:
    """As ``concave_area``, for a polygon of few corners."""
    total = 0.0
    for k in range(len(hull)):
        first, last = hull[k], hull[k + 1 if k + 1 < len(hull) else 0]
        x, y = part[last, 0] - part[first, 0], part[last, 1] - part[first, 1]
        length = math.sqrt(x * x + y * y)
        area, depth, bx, by = 0.0, 0.0, 0.0, 0.0
        for step in range(1, (last - first) % len(part) + 1):
            i = (first + step) % len(part)
            px, py = part[i, 0] - part[first, 0], part[i, 1] - part[first, 1]
            area += 0.5 * (bx * py - px * by)
            bx, by = px, py
            depth = max(depth, (x * py - y * px) / max(length, 1e-12))
        if depth > roughness:
            total += abs(area)
    return total


@compiled_maker
def left_concave(first: FloatArray, second: FloatArray, scale: Scale) -> float:
    """What remains concave in two pieces [m]; infinite if one of them is too small to be a block."""
    left = 0.0
    for part in (first, second):
        if len(part) < _FEWEST or ring_area(part) < _SMALLEST * scale.pitch * scale.pitch:
            return np.inf
        left += concave_cost(part, scale.roughness)
    return left


@compiled_maker
def chord(ring: FloatArray, nx: float, ny: float, offset: float) -> tuple[int, int]:
    """Points of the ring at the ends of the longest piece of the line n . p = offset inside it; -1, -1 if outside.

    The first of the two lies where the direction (-ny, nx) comes from.
    """
    crossings = np.empty(len(ring))
    places = np.empty(len(ring), dtype=np.int64)
    count = 0
    for i in range(len(ring)):
        a = nx * ring[i - 1, 0] + ny * ring[i - 1, 1] - offset
        b = nx * ring[i, 0] + ny * ring[i, 1] - offset
        if (a > 0.0) != (b > 0.0):
            t = nx * ring[i, 1] - ny * ring[i, 0]
            at = count
            while at > 0 and crossings[at - 1] > t:
                crossings[at], places[at] = crossings[at - 1], places[at - 1]
                at -= 1
            crossings[at], places[at] = t, i
            count += 1
    best, first, last = 0.0, -1, -1
    for k in range(0, count - 1, 2):
        if crossings[k + 1] - crossings[k] > best:
            best, first, last = crossings[k + 1] - crossings[k], places[k], places[k + 1]
    return first, last


@compiled_maker
def along(ring: FloatArray, i: int, j: int, nx: float, ny: float, offset: float) -> tuple[float, float, float, float]:
    """Point and unit direction, from point i to point j, of the line n . p = offset."""
    sense = 1.0 if (ring[j, 1] - ring[i, 1]) * nx - (ring[j, 0] - ring[i, 0]) * ny > 0.0 else -1.0
    return nx * offset, ny * offset, -ny * sense, nx * sense
