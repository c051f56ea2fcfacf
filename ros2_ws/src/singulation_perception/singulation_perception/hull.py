"""Convex hull of a ring, as compiled code sees it."""

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.jit import compiled_part, compiled_part_maker
from singulation_perception.object_points import IntArray


@compiled_part_maker
def hull_indices(ring: FloatArray) -> IntArray:
    """Which points of a ring are corners of its convex hull, counter-clockwise (Quickhull; Barber et al. 1996).

    Points waiting behind an edge of the hull so far are those strictly outside it; the farthest is a corner too and
    parts the others in two groups. Edges are taken in order around the hull.
    """
    size = len(ring)
    point, spare = np.empty(size, dtype=np.int32), np.empty(size, dtype=np.int32)
    stack = np.empty((size + 2, 4), dtype=np.int32)  # both ends of an edge, first and last of its points
    hull = np.empty(size, dtype=np.int32)
    least, most = 0, 0
    for i in range(size):
        point[i] = i
        if _before(ring, np.int64(i), np.int64(least)):
            least = i
        if _before(ring, np.int64(most), np.int64(i)):
            most = i
    count, depth = 0, np.int64(0)
    if size > 0 and least != most:
        a, b, begin = np.int64(least), np.int64(most), np.int64(0)  # one kind of number: compiled once
        middle, end = _parted(ring, point, spare, a, b, a, begin, np.int64(size))
        _push(stack, depth, b, a, middle, end)
        _push(stack, depth + 1, a, b, begin, middle)
        depth += 2
    elif size > 0:
        hull[0], count = least, 1
    while depth > 0:
        depth -= 1
        a, b = np.int64(stack[depth, 0]), np.int64(stack[depth, 1])
        begin, end = np.int64(stack[depth, 2]), np.int64(stack[depth, 3])
        if begin == end:
            hull[count] = a
            count += 1
            continue
        c = np.int64(_farthest(ring, point, a, b, begin, end))
        middle, end = _parted(ring, point, spare, a, c, b, begin, end)
        _push(stack, depth, c, b, middle, end)
        _push(stack, depth + 1, a, c, begin, middle)
        depth += 2
    return hull[:count]


@compiled_part
def _push(stack: IntArray, place: int, a: int, b: int, begin: int, end: int) -> None:
    stack[place, 0], stack[place, 1], stack[place, 2], stack[place, 3] = a, b, begin, end


@compiled_part
def _farthest(ring: FloatArray, point: IntArray, a: int, b: int, begin: int, end: int) -> int:
    ax, ay = ring[a, 0], ring[a, 1]
    ex, ey = ring[b, 0] - ax, ring[b, 1] - ay
    best, most = point[begin], -np.inf
    for k in range(begin, end):
        i = point[k]
        off = ey * (ring[i, 0] - ax) - ex * (ring[i, 1] - ay)
        if off > most:
            best, most = i, off
    return best


@compiled_part
def _parted(
    ring: FloatArray, point: IntArray, spare: IntArray, a: int, c: int, b: int, begin: int, end: int
) -> tuple[int, int]:
    """Puts the points outside a-c first, those outside c-b behind them, drops the rest; ends of both groups."""
    ax, ay, cx, cy = ring[a, 0], ring[a, 1], ring[c, 0], ring[c, 1]
    ux, uy, vx, vy = cx - ax, cy - ay, ring[b, 0] - cx, ring[b, 1] - cy
    first, second = begin, 0
    for k in range(begin, end):
        i = point[k]
        x, y = ring[i, 0], ring[i, 1]
        if uy * (x - ax) - ux * (y - ay) > 0.0:
            point[first] = i
            first += 1
        elif vy * (x - cx) - vx * (y - cy) > 0.0:
            spare[second] = i
            second += 1
    for k in range(second):
        point[first + k] = spare[k]
    return first, first + second


@compiled_part
def _before(ring: FloatArray, a: int, b: int) -> bool:
    return ring[a, 0] < ring[b, 0] or (ring[a, 0] == ring[b, 0] and ring[a, 1] < ring[b, 1])
