"""Convex solids as intersections of half-spaces: what rays are cast against."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np

from singulation_core import PlanarObject
from singulation_core.polygon import FloatArray, inward_half_planes

_SIDES = 12  # of the prism that stands for a cylinder


@dataclass(frozen=True, eq=False)
class Solid:
    """The points x with ``normals @ x <= offsets``.

    Args:
        normals: (m, 3) unit outward normals.
        offsets: (m,) [m].
        corners: (v, 3) points whose convex hull contains the solid [m].
    """

    normals: FloatArray
    offsets: FloatArray
    corners: FloatArray

    def moved(self, pose: FloatArray) -> "Solid":
        """The solid in frame a, given in frame b, for the 4x4 pose of b in a."""
        rotation, translation = pose[:3, :3], pose[:3, 3]
        normals = self.normals @ rotation.T
        return Solid(normals, self.offsets + normals @ translation, self.corners @ rotation.T + translation)


def block_solid(item: PlanarObject) -> Solid:
    """Prism from the table (z = 0) to the height of a block."""
    inward, offsets = inward_half_planes(item.outline)
    sides = np.column_stack((-inward, np.zeros(len(inward))))
    normals = np.vstack((sides, (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)))
    corners = [(x, y, z) for z in (0.0, item.height) for x, y in item.outline.tolist()]
    return Solid(normals, np.array((*-offsets, item.height, 0.0)), np.array(corners))


def box_solid(half_sizes: Sequence[float], centre: Sequence[float] = (0.0, 0.0, 0.0)) -> Solid:
    """Axis-parallel box."""
    half, middle = np.asarray(half_sizes, dtype=np.float64), np.asarray(centre, dtype=np.float64)
    normals = np.vstack((np.eye(3), -np.eye(3)))
    return Solid(normals, np.tile(half, 2) + normals @ middle, _box_corners(half) + middle)


def cylinder_solid(radius: float, half_length: float) -> Solid:
    """Prism around a cylinder along z."""
    angles = np.arange(_SIDES) * (2.0 * np.pi / _SIDES)
    sides = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(_SIDES)))
    normals = np.vstack((sides, (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)))
    offsets = np.array([radius] * _SIDES + [half_length] * 2)
    return Solid(normals, offsets, _box_corners(np.array((1.1 * radius, 1.1 * radius, half_length))))


def sphere_solid(radius: float) -> Solid:
    """Polyhedron of 26 faces around a sphere."""
    normals = _compass()
    return Solid(normals, np.full(len(normals), radius), _box_corners(np.full(3, radius)))


@cache
def _compass() -> FloatArray:
    """(26, 3) directions to the faces, edges and corners of a cube."""
    directions = np.array([one for one in product((-1.0, 0.0, 1.0), repeat=3) if any(one)])
    return np.asarray(directions / np.linalg.norm(directions, axis=1)[:, None])


def _box_corners(half: FloatArray) -> FloatArray:
    return np.array(list(product((-1.0, 1.0), repeat=3))) * half
