"""What the camera sees of the robot: the visual shapes of its URDF at given joint angles."""

from collections.abc import Mapping, Sequence
from importlib.resources import as_file
from typing import Any

import numpy as np
import pinocchio as pin

from singulation_core.polygon import FloatArray
from singulation_sim.camera.solid import Solid, box_solid, cylinder_solid, sphere_solid
from yumi_push_executor.kinematics.model import arm_model, robot, urdf_resource


class RobotShape:
    """Solids of body, arms and fingers, in ``yumi_body``."""

    def __init__(self) -> None:
        self._model = robot()
        with as_file(urdf_resource()) as path:
            self._shapes = pin.buildGeomFromUrdf(self._model, str(path), pin.GeometryType.VISUAL)
        self._solids = [_solid(item.geometry) for item in self._shapes.geometryObjects]
        self._data, self._placements = self._model.createData(), pin.GeometryData(self._shapes)

    def solids(self, joints: Mapping[str, FloatArray], openings: Mapping[str, float]) -> Sequence[Solid]:
        """All solids.

        Args:
            joints: (7,) angles of each arm, shoulder to flange [rad].
            openings: of each hand [m].
        """
        q = pin.neutral(self._model)
        for name, angles in joints.items():
            model = arm_model(name)
            q[list(model.positions)] = angles
            q[list(model.fingers)] = openings[name] / 2.0
        pin.updateGeometryPlacements(self._model, self._data, self._shapes, self._placements, q)
        poses = [placement.homogeneous for placement in self._placements.oMg]
        return [solid.moved(pose) for solid, pose in zip(self._solids, poses, strict=True)]


def _solid(geometry: Any) -> Solid:
    """Solid of one of the primitive shapes a URDF knows."""
    kind = type(geometry).__name__
    if kind == "Box":
        return box_solid(np.asarray(geometry.halfSide).tolist())
    if kind == "Cylinder":
        return cylinder_solid(geometry.radius, geometry.halfLength)
    if kind == "Sphere":
        return sphere_solid(geometry.radius)
    raise TypeError(f"robot shape: no solid for a {kind}; known are Box, Cylinder and Sphere")
