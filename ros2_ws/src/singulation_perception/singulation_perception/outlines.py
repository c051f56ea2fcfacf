"""From the rim of a top face to a convex polygon on the table: hull, Douglas-Peucker, edges fitted to the rim."""

import cv2
import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.edge_fit import corners_of, refitted
from singulation_perception.jit import compiled, compiled_part, compiled_plain
from singulation_perception.object_points import IntArray
from singulation_perception.rings import Scale

_ROUNDS = 4
_SETTLED = 1e-6  # [m] corners that move less are where they belong
_MARGIN = 2.0  # pitches from a corner in which points may belong to the other edge


def outline_of(ring: FloatArray, hull: IntArray, tolerance: float, scale: Scale) -> FloatArray | None:
    """Convex polygon of a face.

    Args:
        ring: (m, 2) rim of the face, counter-clockwise [m].
        hull: numbers of its points that are corners of its hull, counter-clockwise.
        tolerance: of Douglas-Peucker; no finer detail is kept [m].
        scale: of the cloud.

    Returns:
        (k, 2), counter-clockwise; None if the points have no area.
    """
    if len(hull) < 3:
        return None
    polygon = simplified(ring[hull], tolerance)
    if len(polygon) < 3:
        return None
    corners, good = _fitted(ring, polygon, tolerance, scale)
    return corners if good else None


def simplified(ring: FloatArray, tolerance: float) -> FloatArray:
    """Douglas-Peucker on a closed line, in metres."""
    origin = ring[0]  # float32 keeps micrometres only near zero
    corners = cv2.approxPolyDP((ring - origin).astype(np.float32)[:, None, :], tolerance, True)
    return np.asarray(corners[:, 0, :].astype(np.float64) + origin)


@compiled
def _fitted(ring: FloatArray, polygon: FloatArray, tolerance: float, scale: Scale) -> tuple[FloatArray, bool]:
    """Refits edges, drops corners finer than the tolerance, and grows the result."""
    corners = polygon
    grown, good = polygon, True
    for round_ in range(_ROUNDS):
        reach = tolerance if round_ == 0 else min(tolerance, 1.2 * scale.roughness)
        lines = refitted(ring, corners, reach, _MARGIN * scale.pitch)
        lines = _without_details(lines, tolerance)
        moved, meeting = corners_of(lines, 0.0)
        if not meeting or not _in_order(moved, lines):
            break
        settled = round_ > 0 and _same(moved, corners)
        corners = moved
        grown, _ = corners_of(lines, scale.growth)
        if settled:
            break
    return grown, good and len(grown) >= 3


@compiled_plain
def _same(one: FloatArray, two: FloatArray) -> bool:
    if len(one) != len(two):
        return False
    for i in range(len(one)):
        if abs(one[i, 0] - two[i, 0]) > _SETTLED or abs(one[i, 1] - two[i, 1]) > _SETTLED:
            return False
    return True


@compiled_plain
def _in_order(corners: FloatArray, lines: FloatArray) -> bool:
    """Whether every edge runs along its line in the right sense, so that the corners form a convex polygon."""
    for i in range(len(corners)):
        j = i + 1 if i + 1 < len(corners) else 0
        x, y = corners[j, 0] - corners[i, 0], corners[j, 1] - corners[i, 1]
        if not (y * lines[i, 0] - x * lines[i, 1] > 0.0):
            return False
    return True


@compiled_part
def _without_details(lines: FloatArray, tolerance: float) -> FloatArray:
    """Drops edges that only cut a corner off by less than the tolerance, the finest first."""
    count = len(lines)
    while count > 3:
        finest, least = -1, tolerance
        for k in range(count):
            depth = _cut_off(lines, count, k)
            if depth < least:
                finest, least = k, depth
        if finest < 0:
            break
        count -= 1
        for k in range(finest, count):
            for j in range(3):
                lines[k, j] = lines[k + 1, j]
    return lines[:count]


@compiled_plain
def _cut_off(lines: FloatArray, count: int, k: int) -> float:
    """How far outside line k of ``count`` its neighbours would meet without it; infinite if they would not."""
    i, j = k - 1 if k > 0 else count - 1, k + 1 if k + 1 < count else 0
    ax, ay, a, bx, by, b = lines[i, 0], lines[i, 1], lines[i, 2], lines[j, 0], lines[j, 1], lines[j, 2]
    sine = ax * by - ay * bx
    if not (sine > 0.1 or (sine > -0.1 and ax * bx + ay * by > 0.0)):
        return np.inf
    if abs(sine) < 0.02:
        return abs(a - b)
    x, y = (a * by - b * ay) / sine, (b * ax - a * bx) / sine
    return abs(lines[k, 0] * x + lines[k, 1] * y - lines[k, 2])
