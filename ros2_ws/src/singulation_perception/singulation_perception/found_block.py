"""A block as found, before doubts about its neighbours are settled."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from singulation_core import PlanarObject
from singulation_core.polygon import FloatArray, MeasuredOutline, inward_half_planes
from singulation_perception.jit import compiled_maker, compiled_part
from singulation_perception.object_points import IntArray
from singulation_perception.shapes import Shape, shape_of


@dataclass(frozen=True, eq=False)
class FoundBlock:
    """One block.

    Args:
        outline: (k, 2) convex, counter-clockwise [m].
        shape: of the outline.
        height: of its top face [m].
        count: points of its top face.
        confidence: 0..1.
        surface: number of the surface it belongs to.
        face: number of the image of its top face.
    """

    outline: FloatArray
    shape: Shape
    height: float
    count: int
    confidence: float
    surface: int
    face: int

    def redrawn(self, outline: FloatArray, factor: float) -> "FoundBlock":
        """The same block with another outline and less confidence."""
        return replace(self, outline=outline, shape=shape_of(outline), confidence=self.confidence * factor)

    def doubted(self, factor: float) -> "FoundBlock":
        """The same block with less confidence."""
        return replace(self, confidence=self.confidence * factor)

    def planar_object(self, number: int) -> PlanarObject:
        """The block as it is published; its outline is looked at more closely if it is not plainly convex."""
        shape = self.shape
        if not (0.0 < shape.area < np.inf):
            return PlanarObject(number, self.outline, self.height, self.count, self.confidence)
        outline, centroid = self.outline.copy(), np.array((shape.x, shape.y))
        outline.flags.writeable = centroid.flags.writeable = False
        measured = MeasuredOutline(outline, shape.area, centroid, shape.radius)
        return PlanarObject.measured(number, measured, self.height, self.count, self.confidence)


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


@compiled_part
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


@compiled_maker
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
