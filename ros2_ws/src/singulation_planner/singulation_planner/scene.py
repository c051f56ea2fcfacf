"""An arrangement as flat arrays in an order that does not depend on how its objects are numbered."""

from dataclasses import dataclass
from itertools import accumulate
from math import fsum
from typing import Self

import numpy as np

from singulation_core import Arrangement, ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from singulation_core.push_world.displaced import displaced
from singulation_planner.kernels.order import canonical_order
from singulation_planner.kernels.overlap import deepest_overlap
from singulation_planner.kernels.types import IntArray

# Perception moves an outline by a few per cent of its size; deeper overlaps are errors, not noise.
OVERLAP_TOLERANCE = 0.15  # in units of the smaller bounding radius


@dataclass(frozen=True, slots=True)
class Scene:
    """Objects sorted by size, then by distance from the middle: ties between scores are broken by this order.

    Neither changes when the scene is turned or moved. Two congruent objects equally far from the middle (or the only
    two there are) cannot be told apart in this way; of them the one with smaller x, or else smaller y, comes first.

    Attributes:
        arrangement: where it comes from.
        order: (n,) positions in the arrangement.
        centroids: (n, 2) [m].
        radii: (n,) bounding radii [m].
        vertices: (v, 2) outlines one after the other [m].
        firsts: (n + 1,) where each outline begins in ``vertices``.
        scale: mean bounding radius [m].
    """

    arrangement: Arrangement
    order: tuple[int, ...]
    centroids: FloatArray
    radii: FloatArray
    vertices: FloatArray
    firsts: IntArray
    scale: float

    @classmethod
    def of(cls, arrangement: Arrangement, overlap_tolerance: float = OVERLAP_TOLERANCE) -> Self:
        """Scene of at least two objects that do not overlap.

        Args:
            arrangement: the objects.
            overlap_tolerance: depth of an overlap that is taken for noise, in units of the smaller bounding radius.

        Raises:
            SingulationError: ``NOTHING_TO_DO`` for fewer than two objects, ``OVERLAPPING_OBJECTS``.
        """
        n = len(arrangement)
        if n < 2:
            raise SingulationError(
                ResultCode.NOTHING_TO_DO, f"arrangement: {n} object(s), singulation needs at least two"
            )
        centroids, radii, objects = arrangement.centroids, arrangement.bounding_radii, arrangement.objects
        index = canonical_order(centroids, radii, np.array([item.area for item in objects]))
        order = tuple(index.tolist())
        outlines = [objects[k].outline for k in order]
        firsts = np.array((0, *accumulate(map(len, outlines))), dtype=np.int64)
        radii = radii[index]
        scale = fsum(radii.tolist()) / n
        scene = cls(arrangement, order, centroids[index], radii, np.concatenate(outlines), firsts, scale)
        scene._refuse_overlaps(overlap_tolerance)
        return scene

    def __len__(self) -> int:
        return len(self.order)

    def in_order(self) -> Arrangement:
        """The arrangement with its objects in canonical order: simulations of it cannot depend on their numbering."""
        objects = self.arrangement.objects
        return Arrangement([objects[k] for k in self.order], self.arrangement.frame, self.arrangement.stamp)

    def displaced(self, poses: FloatArray) -> Arrangement:
        """The arrangement, numbered as it came, with the objects at ``poses`` (n, 3) in canonical order."""
        numbered = np.empty_like(poses)
        numbered[list(self.order)] = poses
        return displaced(self.arrangement, numbered)

    def after(self, poses: FloatArray) -> "Scene":
        """The scene with the objects at ``poses`` (n, 3) in canonical order.

        Raises:
            SingulationError: as ``of``.
        """
        return Scene.of(self.displaced(poses))

    def object_id(self, index: int) -> int:
        """Id of the object at this place of the canonical order."""
        return self.arrangement.objects[self.order[index]].id

    def _refuse_overlaps(self, tolerance: float) -> None:
        one, other, depth = deepest_overlap(self.centroids, self.radii, self.vertices, self.firsts, tolerance)
        if one >= 0:
            raise SingulationError(
                ResultCode.OVERLAPPING_OBJECTS,
                f"objects {self.object_id(one)} and {self.object_id(other)} overlap by {depth:.4g} m; at most "
                f"{tolerance:.0%} of the smaller bounding radius is taken for noise",
            )
