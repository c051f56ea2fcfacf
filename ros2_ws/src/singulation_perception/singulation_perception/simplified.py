"""Douglas and Peucker (1973) on a closed line, as compiled code sees it."""

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.jit import compiled_part, compiled_part_maker
from singulation_perception.object_points import IntArray

_NEARLY = 0.5  # square of the share of the tolerance by which a corner must stand out in the end


@compiled_part_maker
def simplified(ring: FloatArray, tolerance: float) -> IntArray:
    """Which points of a ring are left as corners, in its order, none farther than ``tolerance`` from what is left."""
    size = len(ring)
    kept = np.zeros(size, dtype=np.int32)
    stack = np.empty((size + 2, 2), dtype=np.int32)
    first = _farthest_from(ring, _farthest_from(ring, _farthest_from(ring, np.int64(0))))
    second = _farthest_from(ring, first)
    kept[first], kept[second] = 1, 1
    stack[0, 0], stack[0, 1] = first, second if second > first else second + size
    stack[1, 0], stack[1, 1] = second, first if first > second else first + size
    depth = 2
    while depth > 0:
        depth -= 1
        begin, end = np.int64(stack[depth, 0]), np.int64(stack[depth, 1])
        farthest = _farthest_between(ring, begin, end, tolerance)
        if farthest >= 0:
            kept[farthest % size] = 1
            stack[depth, 0], stack[depth, 1] = begin, farthest
            stack[depth + 1, 0], stack[depth + 1, 1] = farthest, end
            depth += 2
    return _standing_out(ring, kept, tolerance)


@compiled_part
def _farthest_from(ring: FloatArray, start: int) -> int:
    best, most = start, 0.0
    for i in range(len(ring)):
        x, y = ring[i, 0] - ring[start, 0], ring[i, 1] - ring[start, 1]
        if x * x + y * y > most:
            best, most = i, x * x + y * y
    return best


@compiled_part
def _farthest_between(ring: FloatArray, begin: int, end: int, tolerance: float) -> int:
    """Point between two others, counted on beyond the end of the ring, farthest from the line through them; -1 if
    none is out of tolerance.
    """
    size = len(ring)
    ax, ay = ring[begin % size, 0], ring[begin % size, 1]
    ex, ey = ring[end % size, 0] - ax, ring[end % size, 1] - ay
    squared = ex * ex + ey * ey
    best, most = -1, tolerance * tolerance * squared
    for at in range(begin + 1, end):
        i = at if at < size else at - size
        x, y = ring[i, 0] - ax, ring[i, 1] - ay
        off = x * ey - y * ex
        if off * off > most:
            best, most = at, off * off
    return best


@compiled_part_maker
def _standing_out(ring: FloatArray, kept: IntArray, tolerance: float) -> IntArray:
    """Numbers of the points kept, without those that hardly stand out between their neighbours."""
    corners = np.empty(len(ring), dtype=np.int32)
    count = 0
    for i in range(len(ring)):
        if kept[i]:
            corners[count] = i
            count += 1
    k = 0
    while k < count and count > 2:
        a, b, c = corners[k - 1 if k > 0 else count - 1], corners[k], corners[k + 1 if k + 1 < count else 0]
        x, y = ring[b, 0] - ring[a, 0], ring[b, 1] - ring[a, 1]
        ex, ey = ring[c, 0] - ring[a, 0], ring[c, 1] - ring[a, 1]
        off = x * ey - y * ex
        onwards = x * (ring[c, 0] - ring[b, 0]) + y * (ring[c, 1] - ring[b, 1]) >= 0.0
        if onwards and off * off <= _NEARLY * tolerance * tolerance * (ex * ex + ey * ey):
            count -= 1
            for j in range(k, count):
                corners[j] = corners[j + 1]
        else:
            k += 1
    return corners[:count]
