"""Where touching blocks may meet: lines that continue an edge of the outline into it.

All blocks are convex, so a reflex corner of a merged outline is a corner of one block on an edge of another, or where
two corners meet. The seam continues one of the two edges that end there, and ends at a second reflex corner, or, where
two corners are flush, at an ordinary corner or in the middle of an edge.
"""

import math

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.edge_fit import fitted_line
from singulation_perception.jit import compiled_maker, compiled_part, compiled_part_maker
from singulation_perception.object_points import IntArray

_REFLEX = -0.1  # sine of the turn
_TRIM = 2  # points at either end of an edge that are left out of its line
_SHORTEST_EDGE = 3.0  # pitches, of an edge that is continued
_SHORTEST_SEAM = 4.0  # pitches
_NECK = 12.0  # pitches: two reflex corners that near are joined whatever their edges say
_NEAR = 20  # points along the ring within which two corners are neighbours
_SAME = 8.0  # pitches between two cuts along one seam
_ALIGNED = 0.12  # sine up to which an edge at the far end counts as part of the seam

# What a cut costs, in metres of concave outline that it must explain.
_OPEN_END = 0.010  # it ends in the middle of an edge
_CORNER_END = 0.002  # it ends at a corner that is not reflex
_BEND = 0.02  # times the sine between the cut and the best edge at its far end
_NECK_CUT = 0.002  # joining two near reflex corners across
_PAIR_CUT = 0.004  # joining two others, whatever their edges say


@compiled_part_maker
def edges_between(ring: FloatArray, index: IntArray) -> tuple[FloatArray, FloatArray, IntArray]:
    """Edges between the corners of a ring.

    Args:
        ring: (m, 2) [m].
        index: (k,) point of each corner; edge i runs from corner i to the next.

    Returns:
        outward normal and offset of each edge (k, 3), its length (k,) [m], and whether it has enough points for a line
        of its own (k,).
    """
    count = len(index)
    lines, length, fitted = np.empty((count, 3)), np.empty(count), np.zeros(count, dtype=np.int32)
    room = np.empty((5, len(ring)))
    for k in range(count):
        a, b = index[k], index[k + 1 if k + 1 < count else 0]
        x, y = ring[b, 0] - ring[a, 0], ring[b, 1] - ring[a, 1]
        length[k] = math.sqrt(x * x + y * y)
        x, y = x / max(length[k], 1e-12), y / max(length[k], 1e-12)
        lines[k, 0], lines[k, 1], lines[k, 2] = y, -x, y * ring[a, 0] - x * ring[a, 1]
        steps = (b - a) % len(ring) + 1
        if steps >= 2 * _TRIM + 5:
            for i in range(steps - 2 * _TRIM):
                j = (a + _TRIM + i) % len(ring)
                room[0, i], room[1, i] = ring[j, 0], ring[j, 1]
            nx, ny, offset = fitted_line(room, np.int64(steps - 2 * _TRIM), y, -x)
            if nx * y - ny * x > 0.97:
                lines[k, 0], lines[k, 1], lines[k, 2] = nx, ny, offset
                fitted[k] = 1
    return lines, length, fitted


@compiled_part_maker
def candidates(ring: FloatArray, index: IntArray, lines: FloatArray, length: FloatArray, pitch: float) -> FloatArray:
    """Possible cuts, (c, 7): first and last point, length [m], penalty [m], the edges it continues, -1 for none, and
    whether it ends in the middle of an edge.
    """
    count = len(index)
    turn = np.empty(count)
    for k in range(count):
        turn[k] = lines[k - 1, 0] * lines[k, 1] - lines[k - 1, 1] * lines[k, 0]
    found = np.empty((count * count + 2 * count, 7))
    size, none = 0, np.int64(-1)
    for k in range(count):
        if turn[k] >= _REFLEX:
            continue
        for edge, sense in (((k - 1) % count, 1.0), (k, -1.0)):
            if length[edge] < _SHORTEST_EDGE * pitch:
                continue
            reach, hit = _cast(ring, np.int64(index[k]), lines, edge, sense, _SHORTEST_SEAM * pitch)
            if hit < 0:
                continue
            end, other, sine = _end(ring, index, lines, turn, k, edge, sense, reach, hit, pitch)
            penalty = _OPEN_END
            if end >= 0:
                hit = np.int64(index[end])
                reach = _distance(ring, np.int64(index[k]), hit)
                penalty = _BEND * min(sine, 0.3) if turn[end] < _REFLEX else _CORNER_END
            aligned = end >= 0 and turn[end] < _REFLEX and sine < _ALIGNED
            _write(found, np.int64(size), np.int64(index[k]), hit, reach, penalty, edge, other if aligned else none)
            found[size, 6] = end < 0
            size += 1
        for other in range(k + 1, count):
            across = _distance(ring, np.int64(index[k]), np.int64(index[other]))
            apart = _apart(np.int64(index[k]), np.int64(index[other]), len(ring))
            near = across < _NECK * pitch
            if turn[other] < _REFLEX and apart > _NEAR and (near or _faces_inwards(ring, index, lines, k, other)):
                first, last = np.int64(index[k]), np.int64(index[other])
                one, two = _along_edge(ring, index, lines, k, last), _along_edge(ring, index, lines, other, first)
                _write(found, np.int64(size), first, last, across, _NECK_CUT if near else _PAIR_CUT, one, two)
                found[size, 6] = 0.0
                size += 1
    return found[:size]


@compiled_part
def _write(
    cuts: FloatArray, k: int, first: int, last: int, length: float, penalty: float, edge: int, other: int
) -> None:
    cuts[k, 0], cuts[k, 1], cuts[k, 2] = first, last, length
    cuts[k, 3], cuts[k, 4], cuts[k, 5] = penalty, edge, other


@compiled_part
def _faces_inwards(ring: FloatArray, index: IntArray, lines: FloatArray, one: int, two: int) -> bool:
    """Whether the way between two reflex corners begins inside the ring at either end."""
    x, y = ring[index[two], 0] - ring[index[one], 0], ring[index[two], 1] - ring[index[one], 1]
    for k in (one, two):
        if lines[k, 0] * x + lines[k, 1] * y >= 0.0 and lines[k - 1, 0] * x + lines[k - 1, 1] * y >= 0.0:
            return False
        x, y = -x, -y
    return True


@compiled_part
def _along_edge(ring: FloatArray, index: IntArray, lines: FloatArray, corner: int, point: int) -> int:
    """The edge at a corner that the way to a point of the ring continues; -1 if neither does."""
    x, y = ring[point, 0] - ring[index[corner], 0], ring[point, 1] - ring[index[corner], 1]
    before, after = (corner - 1) % len(index), corner
    one, two = abs(lines[before, 0] * x + lines[before, 1] * y), abs(lines[after, 0] * x + lines[after, 1] * y)
    if min(one, two) > _ALIGNED * math.sqrt(x * x + y * y):
        return -1
    return before if one < two else after


@compiled_part
def _distance(ring: FloatArray, a: int, b: int) -> float:
    x, y = ring[a, 0] - ring[b, 0], ring[a, 1] - ring[b, 1]
    return math.sqrt(x * x + y * y)


@compiled_part
def _apart(a: int, b: int, size: int) -> int:
    return min((a - b) % size, (b - a) % size)


@compiled_part
def _cast(ring: FloatArray, start: int, lines: FloatArray, edge: int, sense: float, least: float) -> tuple[float, int]:
    """How far the line runs from a point of the ring until it meets the ring again, and the point it meets."""
    nx, ny, offset = lines[edge, 0], lines[edge, 1], lines[edge, 2]
    ux, uy = -ny * sense, nx * sense
    best, hit = np.inf, -1
    last = len(ring) - 1
    before = nx * ring[last, 0] + ny * ring[last, 1] - offset
    before_t = (ring[last, 0] - ring[start, 0]) * ux + (ring[last, 1] - ring[start, 1]) * uy
    for i in range(len(ring)):
        side = nx * ring[i, 0] + ny * ring[i, 1] - offset
        t = (ring[i, 0] - ring[start, 0]) * ux + (ring[i, 1] - ring[start, 1]) * uy
        if (side > 0.0) != (before > 0.0):
            f = before / (before - side)
            crossing = before_t + f * (t - before_t)
            if least < crossing < best:
                best, hit = crossing, i if f >= 0.5 else (i - 1) % len(ring)
        before, before_t = side, t
    return best, hit


@compiled_part
def _end(
    ring: FloatArray,
    index: IntArray,
    lines: FloatArray,
    turn: FloatArray,
    start: int,
    edge: int,
    sense: float,
    reach: float,
    hit: int,
    pitch: float,
) -> tuple[int, int, float]:
    """Corner near the point that is met, its edge that fits the seam best, and the sine between the two; or -1."""
    ux, uy = -lines[edge, 1] * sense, lines[edge, 0] * sense
    tolerance = max(5.0 * pitch, 0.06 * reach)
    best, best_rank, best_edge, best_sine = -1, np.inf, -1, 0.0
    for k in range(len(index)):
        if k == start or _apart(np.int64(index[k]), np.int64(hit), len(ring)) * pitch >= 2.0 * tolerance:
            continue
        x, y = ring[index[k], 0] - ring[index[start], 0], ring[index[k], 1] - ring[index[start], 1]
        off = abs(x * lines[edge, 0] + y * lines[edge, 1])
        if off >= tolerance or x * ux + y * uy <= 3.0 * pitch:
            continue
        rank = off - (1.0 if turn[k] < _REFLEX else 0.0)  # reflex corners first
        if rank < best_rank:
            before = abs(lines[k - 1, 0] * ux + lines[k - 1, 1] * uy)
            after = abs(lines[k, 0] * ux + lines[k, 1] * uy)
            best, best_rank = k, rank
            best_edge, best_sine = ((k - 1) % len(index), before) if before < after else (k, after)
    return best, best_edge, best_sine


@compiled_maker
def one_seam(
    ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float, pitch: float
) -> bool:
    """Whether of two cuts, a-b and c-d, one lies along the other: the same seam, found from another corner."""
    reach = _SAME * pitch
    within = max(_to_segment(ax, ay, cx, cy, dx, dy), _to_segment(bx, by, cx, cy, dx, dy)) < reach
    return within or max(_to_segment(cx, cy, ax, ay, bx, by), _to_segment(dx, dy, ax, ay, bx, by)) < reach


@compiled_part
def _to_segment(x: float, y: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Distance of a place to the segment a-b [m]."""
    ex, ey = bx - ax, by - ay
    t = ((x - ax) * ex + (y - ay) * ey) / max(ex * ex + ey * ey, 1e-18)
    t = min(1.0, max(0.0, t))
    x, y = x - ax - t * ex, y - ay - t * ey
    return math.sqrt(x * x + y * y)
