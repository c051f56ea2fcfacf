"""The part of the table that pushers and objects must stay in."""

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_core.polygon import FloatArray, inward_half_planes, validated_outline
from singulation_planner.scene import Scene

Walls = tuple[FloatArray, FloatArray]  # inward unit normals (k, 2) and offsets (k,) [m]; none: unbounded
_UNBOUNDED = (np.empty((0, 2)), np.empty(0))


def workspace_walls(workspace: ArrayLike | None, scene: Scene) -> Walls:
    """Inward unit normals (k, 2) and offsets (k,) [m] of the workspace.

    Raises:
        InvalidInputError: the polygon is not convex and counter-clockwise.
        SingulationError: ``OUTSIDE_WORKSPACE`` if the centroid of an object lies outside.
    """
    if workspace is None:
        return _UNBOUNDED
    try:
        corners = np.asarray(workspace, dtype=np.float64)
    except (TypeError, ValueError):
        raise InvalidInputError(f"workspace: {workspace!r}, need (k >= 3, 2) numbers") from None
    normals, offsets = _half_planes(corners.tobytes(), corners.shape)
    depths = (scene.centroids @ normals.T - offsets).min(axis=1)
    if not (depths.min() >= 0.0):
        worst = int(depths.argmin())
        x, y = scene.centroids[worst]
        raise SingulationError(
            ResultCode.OUTSIDE_WORKSPACE,
            f"object {scene.object_id(worst)} at ({x:.4g}, {y:.4g}) m is {-depths[worst]:.4g} m outside the workspace",
        )
    return normals, offsets


@lru_cache(maxsize=16)
def _half_planes(corners: bytes, shape: tuple[int, ...]) -> Walls:
    """The workspace rarely changes; checking it takes as long as planning."""
    outline = validated_outline(np.frombuffer(corners).reshape(shape), "workspace")
    normals, offsets = inward_half_planes(outline)
    return np.ascontiguousarray(normals), np.ascontiguousarray(offsets)
