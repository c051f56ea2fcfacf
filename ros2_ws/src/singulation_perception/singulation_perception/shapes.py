"""Size and overlap of convex outlines, compiled: they are asked for in every cloud."""

import math
from typing import NamedTuple

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.edge_fit import edges_of
from singulation_perception.jit import compiled_maker, compiled_part
from singulation_perception.object_points import IntArray
from singulation_perception.rings import ring_area

_SHORTEST, _LEAST_AREA = 1e-6, 1e-7  # edge and area, in bounding radii and their squares, from which one is plain


class Shape(NamedTuple):
    """Place and size of an outline [m]; a named tuple, because compiled code makes it.

    Args:
        x: of the area centroid.
        y: of the area centroid.
        radius: of the bounding circle about the area centroid.
        length: longer side of the box around it, along one of its edges, whose longer side is shortest.
        area: [m^2]; not a number unless the outline is plainly one that every object may have: it turns left at every
            corner, once around in all, and has no tiny edge.
    """

    x: float
    y: float
    radius: float
    length: float
    area: float


@compiled_maker
def shape_of(outline: FloatArray) -> Shape:
    """Of an outline (k, 2), convex and counter-clockwise but for rounding [m]."""
    total, x, y = 0.0, 0.0, 0.0
    for k in range(1, len(outline) - 1):
        ax, ay = outline[k, 0] - outline[0, 0], outline[k, 1] - outline[0, 1]
        bx, by = outline[k + 1, 0] - outline[0, 0], outline[k + 1, 1] - outline[0, 1]
        weight = ax * by - ay * bx
        total, x, y = total + weight, x + weight * (ax + bx), y + weight * (ay + by)
    x, y = outline[0, 0] + x / (3.0 * total), outline[0, 1] + y / (3.0 * total)
    radius = 0.0
    for k in range(len(outline)):
        ax, ay = outline[k, 0] - x, outline[k, 1] - y
        radius = max(radius, math.sqrt(ax * ax + ay * ay))
    least = np.inf
    for k in range(len(outline)):
        ux, uy = outline[k, 0] - outline[k - 1, 0], outline[k, 1] - outline[k - 1, 1]
        size = math.sqrt(ux * ux + uy * uy)
        left, right, low, high = np.inf, -np.inf, np.inf, -np.inf
        for i in range(len(outline)):
            ax, ay = outline[i, 0] * ux + outline[i, 1] * uy, outline[i, 1] * ux - outline[i, 0] * uy
            left, right, low, high = min(left, ax), max(right, ax), min(low, ay), max(high, ay)
        least = min(least, max(right - left, high - low) / size)
    plain = _turns_left(outline, radius) and total > _LEAST_AREA * radius * radius
    return Shape(x, y, radius, least, 0.5 * total if plain else np.nan)


@compiled_part
def _turns_left(outline: FloatArray, radius: float) -> bool:
    """Whether an outline turns left at every corner, once around in all, and no edge is as good as none.

    Every turn is less than half a circle, so that the edges of one time around point down once and up once.
    """
    last = len(outline) - 1
    ax, ay = outline[last, 0] - outline[last - 1, 0], outline[last, 1] - outline[last - 1, 1]
    changes, least = 0, np.inf
    for k in range(len(outline)):
        bx, by = outline[k, 0] - outline[k - 1, 0], outline[k, 1] - outline[k - 1, 1]
        if not (ax * by - ay * bx > 0.0):
            return False
        changes += (ay < 0.0) != (by < 0.0)
        least = min(least, bx * bx + by * by)
        ax, ay = bx, by
    shortest = _SHORTEST * radius
    return changes == 2 and least > shortest * shortest


@compiled_maker
def shared_area(one: FloatArray, two: FloatArray) -> tuple[float, float, float]:
    """Area of the intersection of two convex counter-clockwise outlines (Sutherland and Hodgman 1974), and the area of
    each of them [m^2].
    """
    room = len(one) + len(two) + 2
    points, kept = np.empty((room, 2)), np.empty((room, 2))
    count = len(one)
    for i in range(count):
        points[i, 0], points[i, 1] = one[i, 0], one[i, 1]
    lines = edges_of(two)
    for k in range(len(lines)):
        size = 0
        for i in range(count):
            j = i + 1 if i + 1 < count else 0
            a = lines[k, 2] - lines[k, 0] * points[i, 0] - lines[k, 1] * points[i, 1]
            b = lines[k, 2] - lines[k, 0] * points[j, 0] - lines[k, 1] * points[j, 1]
            if a >= 0.0 and size < room:
                kept[size, 0], kept[size, 1] = points[i, 0], points[i, 1]
                size += 1
            if min(a, b) < 0.0 < max(a, b) and size < room:  # a product of tiny numbers has no sign
                f = a / (a - b)
                kept[size, 0] = points[i, 0] + f * (points[j, 0] - points[i, 0])
                kept[size, 1] = points[i, 1] + f * (points[j, 1] - points[i, 1])
                size += 1
        points, kept, count = kept, points, size
    shared = max(0.0, ring_area(points[:count])) if count > 2 else 0.0
    return shared, ring_area(one), ring_area(two)


@compiled_maker
def meeting_pairs(shapes: FloatArray, heights: FloatArray, step: float) -> IntArray:
    """(m, 2) lower and higher of all pairs of different height whose bounding circles meet.

    Args:
        shapes: (n, 5) of the blocks, as in ``Shape``.
        heights: (n,) of the blocks [m].
        step: height difference from which one block is higher than another [m].
    """
    pairs = np.empty((len(heights) * len(heights), 2), dtype=np.int32)
    count = 0
    for i in range(len(heights)):
        for j in range(len(heights)):
            x, y = shapes[i, 0] - shapes[j, 0], shapes[i, 1] - shapes[j, 1]
            reach = shapes[i, 2] + shapes[j, 2]
            if heights[j] > heights[i] + step and x * x + y * y < reach * reach:
                pairs[count, 0], pairs[count, 1] = i, j
                count += 1
    return pairs[:count]
