"""The line of a seam: through the corners at its ends and along the edges that it continues."""

import math

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.jit import compiled_part, compiled_part_maker
from singulation_perception.object_points import IntArray
from singulation_perception.rings import Scale

_SHARP, _MOVED = 0.3, 4.0  # sine between two edges that fix their corner; pitches that it may lie beside the ring


@compiled_part_maker
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
    points[0, 0], points[0, 1] = _sharp_corner(ring, i, index, lines, fitted, scale)
    points[1, 0], points[1, 1] = _sharp_corner(ring, j, index, lines, fitted, scale)
    count = 2
    for edge in (int(cut[4]), int(cut[5])):
        if edge < 0 or not fitted[edge]:
            continue
        a, b = index[edge], index[edge + 1 if edge + 1 < len(index) else 0]
        ax, ay, bx, by = ring[a, 0], ring[a, 1], ring[b, 0] - ring[a, 0], ring[b, 1] - ring[a, 1]
        nx, ny, offset = lines[edge, 0], lines[edge, 1], lines[edge, 2] + scale.growth
        steps = max(2, min(len(ring), int(math.sqrt(bx * bx + by * by) / scale.pitch)))
        for step in range(steps):
            f = 0.1 + 0.8 * step / (steps - 1)
            x, y = ax + f * bx, ay + f * by
            off = offset - nx * x - ny * y
            points[count, 0], points[count, 1] = x + off * nx, y + off * ny
            count += 1
    cx, cy = 0.0, 0.0
    for k in range(count):
        cx, cy = cx + points[k, 0] / count, cy + points[k, 1] / count
    xx, xy, yy = 0.0, 0.0, 0.0
    for k in range(count):
        x, y = points[k, 0] - cx, points[k, 1] - cy
        xx, xy, yy = xx + x * x, xy + x * y, yy + y * y
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    ux, uy = math.cos(angle), math.sin(angle)
    if ux * (ring[j, 0] - ring[i, 0]) + uy * (ring[j, 1] - ring[i, 1]) < 0.0:
        ux, uy = -ux, -uy
    return cx, cy, ux, uy


@compiled_part
def _sharp_corner(
    ring: FloatArray, point: int, index: IntArray, lines: FloatArray, fitted: IntArray, scale: Scale
) -> tuple[float, float]:
    """Where the edges at a point of the ring meet, if it is a corner of two fitted edges; the point itself if not."""
    x, y = ring[point, 0], ring[point, 1]
    for k in range(len(index)):
        before = k - 1 if k > 0 else len(index) - 1
        if index[k] != point or not (fitted[before] and fitted[k]):
            continue
        ax, ay, bx, by = lines[before, 0], lines[before, 1], lines[k, 0], lines[k, 1]
        a, b, sine = lines[before, 2] + scale.growth, lines[k, 2] + scale.growth, ax * by - ay * bx
        if abs(sine) > _SHARP:
            cx, cy = (a * by - b * ay) / sine, (b * ax - a * bx) / sine
            if abs(cx - x) < _MOVED * scale.pitch and abs(cy - y) < _MOVED * scale.pitch:
                return cx, cy
    return x, y
