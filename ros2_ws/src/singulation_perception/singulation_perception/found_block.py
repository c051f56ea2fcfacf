"""A block as found, before doubts about its neighbours are settled."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray, area_centroid, bounding_radius, inward_half_planes
from singulation_perception.jit import compiled, compiled_plain
from singulation_perception.object_points import IntArray


@dataclass(frozen=True, eq=False)
class FoundBlock:
    """One block.

    Args:
        outline: (k, 2) convex, counter-clockwise [m].
        height: of its top face [m].
        count: points of its top face.
        confidence: 0..1.
        surface: number of the surface it belongs to.
        face: number of the image of its top face.
    """

    outline: FloatArray
    height: float
    count: int
    confidence: float
    surface: int
    face: int

    @cached_property
    def centre(self) -> FloatArray:
        """(2,) area centroid [m]."""
        return area_centroid(self.outline)

    @cached_property
    def radius(self) -> float:
        """Of the bounding circle about the area centroid [m]."""
        return bounding_radius(self.outline, self.centre)

    @cached_property
    def length(self) -> float:
        """Longer side of the box around it, along one of its edges, whose longer side is shortest [m]."""
        return float(longer_side(self.outline))

    def redrawn(self, outline: FloatArray, factor: float) -> "FoundBlock":
        """The same block with another outline and less confidence."""
        return replace(self, outline=outline, confidence=self.confidence * factor)

    def doubted(self, factor: float) -> "FoundBlock":
        """The same block with less confidence."""
        return replace(self, confidence=self.confidence * factor)


@compiled
def longer_side(outline: FloatArray) -> float:
    """Longer side of a box around an outline, along that of its edges for which it is shortest [m]."""
    least = np.inf
    for k in range(len(outline)):
        ux, uy = outline[k, 0] - outline[k - 1, 0], outline[k, 1] - outline[k - 1, 1]
        size = math.sqrt(ux * ux + uy * uy)
        left, right, low, high = np.inf, -np.inf, np.inf, -np.inf
        for i in range(len(outline)):
            x, y = outline[i, 0] * ux + outline[i, 1] * uy, outline[i, 1] * ux - outline[i, 0] * uy
            left, right, low, high = min(left, x), max(right, x), min(low, y), max(high, y)
        least = min(least, max(right - left, high - low) / size)
    return least


def shares(point: IntArray, xyz: NDArray[np.float32], outlines: list[FloatArray]) -> tuple[IntArray, FloatArray]:
    """Points and mean height of each part of a face; a point belongs to the outline that it is deepest inside.

    Args:
        point: (rows, columns) numbers of the face's points, -1 for none.
        xyz: (n, 3) all points [m].
        outlines: of the parts [m].
    """
    planes = [np.column_stack(inward_half_planes(outline)) for outline in outlines]
    first = np.concatenate(([0], np.cumsum([len(one) for one in planes])))
    counts, heights = _shares(point, xyz, np.vstack(planes), first)
    return counts, heights / np.maximum(counts, 1)


@compiled_plain
def deepest(planes: FloatArray, first: NDArray[np.int64], begin: int, end: int, x: float, y: float) -> int:
    """Which of the outlines ``begin`` to ``end`` a place is deepest inside, or nearest to if it is in none."""
    best, depth = begin, -np.inf
    for one in range(begin, end):
        inside = np.inf
        for k in range(first[one], first[one + 1]):
            inside = min(inside, planes[k, 0] * x + planes[k, 1] * y - planes[k, 2])
            if inside <= depth:
                break
        if inside > depth:
            best, depth = one, inside
    return best


@compiled
def _shares(
    point: IntArray, xyz: NDArray[np.float32], planes: FloatArray, first: NDArray[np.int64]
) -> tuple[IntArray, FloatArray]:
    counts = np.zeros(len(first) - 1, dtype=np.int32)
    heights = np.zeros(len(first) - 1)
    for row in range(point.shape[0]):
        for column in range(point.shape[1]):
            i = point[row, column]
            if i >= 0:
                one = deepest(planes, first, np.int64(0), len(counts), np.float64(xyz[i, 0]), np.float64(xyz[i, 1]))
                counts[one] += 1
                heights[one] += xyz[i, 2]
    return counts, heights
