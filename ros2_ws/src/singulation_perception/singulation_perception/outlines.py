"""From the rims of top faces to convex polygons on the table: hull, Douglas-Peucker, edges fitted to the rim."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.confidence import supported_share
from singulation_perception.edge_fit import corners_of, edges_of, refitted
from singulation_perception.hull import hull_indices
from singulation_perception.jit import compiled_maker, compiled_part, compiled_part_maker
from singulation_perception.object_points import IntArray
from singulation_perception.rings import Scale, concave_area
from singulation_perception.shapes import Shape, shape_of
from singulation_perception.simplified import simplified

_ROUNDS = 4
_SETTLED = 1e-6  # [m] corners that move less are where they belong
_MARGIN = 2.0  # pitches from a corner in which points may belong to the other edge


@dataclass(frozen=True, eq=False)
class Outlines:
    """Convex polygons of n rings.

    Args:
        corners: (m, 2) of all of them, counter-clockwise [m].
        first: (n + 1,) first corner of each; fewer than three where a ring has no area.
        supported: (n,) share of the length of each outline with points of its ring near it.
        concave: (n,) area between each ring and its hull, roughness and spurs apart [m^2].
        box: (n, 4) least and greatest x, least and greatest y of each outline [m].
        shapes: (n, 5) of each outline, as in ``Shape``.
    """

    corners: FloatArray
    first: IntArray
    supported: FloatArray
    concave: FloatArray
    box: FloatArray
    shapes: FloatArray

    def drawn(self) -> list[tuple[FloatArray, Shape] | None]:
        """(k, 2) outline of each ring [m] and its shape; None for a ring without an area."""
        first, shapes = self.first.tolist(), self.shapes.tolist()
        return [
            (self.corners[begin:end], Shape(*shape)) if end - begin >= 3 else None
            for begin, end, shape in zip(first, first[1:], shapes, strict=False)
        ]


def outlines_of(rings: list[FloatArray], hulls: list[IntArray], measures: FloatArray) -> Outlines:
    """Fits a convex polygon to each ring; one call for all, because calls cost more than the fits.

    Args:
        rings: (m, 2) rims of faces or of parts of them, counter-clockwise [m].
        hulls: of each the numbers of the corners of its hull if they are known and the ring is convex but for its
            roughness, else none.
        measures: (n, 4) of each: tolerance of Douglas-Peucker, no finer detail is kept, and the three lengths of its
            ``Scale`` [m].
    """
    points = np.concatenate(rings) if rings else np.empty((0, 2))
    corners = np.concatenate(hulls) if hulls else np.empty(0, dtype=np.int32)
    return Outlines(*_outlines(points, _begins(rings), corners, _begins(hulls), measures))


def _begins(parts: Sequence[FloatArray | IntArray]) -> IntArray:
    begin = np.zeros(len(parts) + 1, dtype=np.int32)
    np.cumsum([len(part) for part in parts], out=begin[1:])
    return begin


@compiled_maker
def _outlines(
    points: FloatArray, begin: IntArray, hulls: IntArray, hull_begin: IntArray, measures: FloatArray
) -> tuple[FloatArray, IntArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    corners, first = np.empty((len(points), 2)), np.zeros(len(begin), dtype=np.int32)
    supported, concave, box = np.zeros(len(measures)), np.zeros(len(measures)), np.zeros((len(measures), 4))
    shapes = np.zeros((len(measures), 5))
    count = 0
    for k in range(len(measures)):
        ring = points[begin[k] : begin[k + 1]]
        scale = Scale(measures[k, 1], measures[k, 2], measures[k, 3])
        hull = hulls[hull_begin[k] : hull_begin[k + 1]]
        convex = len(hull) > 0
        if not convex:
            hull = hull_indices(ring)
        if len(hull) >= 3:
            outline = _fitted(ring, hull, measures[k, 0], scale)
            box[k, 0], box[k, 1], box[k, 2], box[k, 3] = np.inf, -np.inf, np.inf, -np.inf
            for i in range(len(outline)):
                x, y = outline[i, 0], outline[i, 1]
                corners[count, 0], corners[count, 1] = x, y
                box[k, 0], box[k, 1] = min(box[k, 0], x), max(box[k, 1], x)
                box[k, 2], box[k, 3] = min(box[k, 2], y), max(box[k, 3], y)
                count += 1
            shape = shape_of(outline)
            shapes[k, 0], shapes[k, 1], shapes[k, 2] = shape.x, shape.y, shape.radius
            shapes[k, 3], shapes[k, 4] = shape.length, shape.area
            concave[k] = 0.0 if convex else concave_area(ring, hull, scale.roughness)
            if concave[k] > 0.0:
                inner = _without_spurs(ring, outline, scale.pitch)
                concave[k] = concave_area(inner, hull_indices(inner), scale.roughness)
            supported[k] = supported_share(outline, ring, scale.roughness + scale.growth, scale.pitch)
        first[k + 1] = count
    return corners[:count], first, supported, concave, box, shapes


@compiled_part_maker
def _fitted(ring: FloatArray, hull: IntArray, tolerance: float, scale: Scale) -> FloatArray:
    """Refits edges, drops corners finer than the tolerance, and grows the result; the hull as it is if nothing fits."""
    corners = _taken(ring, hull)
    corners = _taken(corners, simplified(corners, tolerance))
    grown = corners
    if len(corners) < 3:
        return grown
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
    return grown


@compiled_part_maker
def _without_spurs(ring: FloatArray, outline: FloatArray, reach: float) -> FloatArray:
    """The points of a ring that lie at most ``reach`` outside its outline.

    A cut that begins beyond the corner of its piece leaves a spur there, and the hull spans a pocket beside it.
    """
    inner, count = np.empty_like(ring), 0
    lines = edges_of(outline)
    for i in range(len(ring)):
        outside = -np.inf
        for k in range(len(lines)):
            outside = max(outside, lines[k, 0] * ring[i, 0] + lines[k, 1] * ring[i, 1] - lines[k, 2])
        if outside <= reach:
            inner[count, 0], inner[count, 1] = ring[i, 0], ring[i, 1]
            count += 1
    return inner[:count]


@compiled_part_maker
def _taken(points: FloatArray, numbers: IntArray) -> FloatArray:
    taken = np.empty((len(numbers), 2))
    for k in range(len(numbers)):
        taken[k, 0], taken[k, 1] = points[numbers[k], 0], points[numbers[k], 1]
    return taken


@compiled_part
def _same(one: FloatArray, two: FloatArray) -> bool:
    if len(one) != len(two):
        return False
    for i in range(len(one)):
        if abs(one[i, 0] - two[i, 0]) > _SETTLED or abs(one[i, 1] - two[i, 1]) > _SETTLED:
            return False
    return True


@compiled_part
def _in_order(corners: FloatArray, lines: FloatArray) -> bool:
    """Whether every edge runs along its line in the right sense, so that the corners form a convex polygon."""
    for i in range(len(corners)):
        j = i + 1 if i + 1 < len(corners) else 0
        x, y = corners[j, 0] - corners[i, 0], corners[j, 1] - corners[i, 1]
        if not (y * lines[i, 0] - x * lines[i, 1] > 0.0):
            return False
    return True


@compiled_part_maker
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


@compiled_part
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
