"""Which pairs of shapes can meet at all along a few neighbouring postures: most are far apart."""

from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from yumi_push_executor.clearance.scene import Scene
from yumi_push_executor.clearance.shapes import robot_shapes
from yumi_push_executor.kinematics import chain
from yumi_push_executor.kinematics.model import arm_model, robot

_FEW = 4  # postures for which it takes longer to judge the pairs than to check them


class NearPairs:
    """Bounding spheres of the moving arm's shapes and of what stands around it.

    Args:
        scene: with the moving arm.
        data, geometry_data: Pinocchio's working data of the robot and of the scene.
        q: configuration of the whole robot with the jaws as they will stand.
        margin: largest of any pair [m].
    """

    def __init__(self, scene: Scene, data: Any, geometry_data: Any, q: FloatArray, margin: float) -> None:
        model = arm_model(scene.arm)
        self._chain, self._count = model.chain, len(scene.pairs)
        centres, radii = _spheres(scene.geometry, data, geometry_data, q)
        joint_of = np.full(len(centres), -1)
        for shape in robot_shapes():
            if shape.arm == scene.arm:
                joint_of[shape.index] = min(shape.part, 7) - 1
        shapes = np.array([pair.shapes for pair in scene.pairs])
        moves = joint_of[shapes] >= 0
        self._judged = np.flatnonzero((moves[:, 0] != moves[:, 1]) & np.isfinite(radii[shapes]).all(axis=1))
        shapes, first = shapes[self._judged], moves[self._judged, 0]
        moving, standing = np.where(first, shapes.T, shapes.T[::-1])
        own, self._own = np.unique(moving, return_inverse=True)
        self._joints = joint_of[own]
        links = chain.places(self._chain, q[None, list(model.positions)]).links[0, self._joints]
        self._offsets = np.einsum("sij,si->sj", links[:, :, :3], centres[own] - links[:, :, 3])
        self._standing = centres[standing]
        self._reach = radii[moving] + radii[standing] + margin

    def along(self, postures: FloatArray) -> NDArray[np.bool_]:
        """Whether each pair of the scene can meet in any of (n, 7) postures; True where that is not known."""
        near = np.ones(self._count, dtype=bool)
        if len(postures) < _FEW:
            return near
        links = chain.places(self._chain, postures).links[:, self._joints]
        centres = np.einsum("nsij,sj->nsi", links[..., :3], self._offsets) + links[..., 3]
        apart = ((centres[:, self._own] - self._standing) ** 2).sum(axis=2).min(axis=0)
        near[self._judged] = ~(apart > self._reach**2)
        return near


def _spheres(geometry: Any, data: Any, placed: Any, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Centres (k, 3) in ``yumi_body`` and radii (k,) of spheres around all shapes; infinite for the table."""
    pin.updateGeometryPlacements(robot(), data, geometry, placed, q)
    centres, radii = [], []
    for item, pose in zip(geometry.geometryObjects, placed.oMg, strict=True):
        item.geometry.computeLocalAABB()
        centres.append(pose.act(np.asarray(item.geometry.aabb_center)))
        radii.append(item.geometry.aabb_radius)
    return np.array(centres), np.array(radii)
