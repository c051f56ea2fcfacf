"""The robot's collision shapes as faces in space, for any joint angles; placed by Pinocchio."""

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import coal
import numpy as np
import pinocchio as pin

from singulation_core.polygon import FloatArray
from yumi_push_executor.clearance.shapes import robot_geometry, robot_shapes
from yumi_push_executor.kinematics.model import arm_model, robot

Faces = list[FloatArray]  # (k, 3) each [m]

_AROUND = 14  # faces around a capsule


def configuration(postures: Mapping[str, FloatArray], openings: Mapping[str, float]) -> FloatArray:
    """Configuration vector of the whole robot: both arms [rad] and jaws [m]."""
    q = np.zeros(robot().nq)
    for arm, angles in postures.items():
        q[list(arm_model(arm).positions)] = angles
        q[list(arm_model(arm).fingers)] = 0.5 * openings.get(arm, 0.0)
    return q


def robot_faces(q: FloatArray) -> dict[tuple[str, int], Faces]:
    """Faces of every shape by arm and part (see ``clearance.shapes.Shape``), in ``yumi_body``."""
    model, geometry = robot(), robot_geometry()
    data, placed = model.createData(), pin.GeometryData(geometry)
    pin.updateGeometryPlacements(model, data, geometry, placed, q)
    result: dict[tuple[str, int], Faces] = {}
    for shape in robot_shapes():
        pose = placed.oMg[shape.index]
        faces = _faces(geometry.geometryObjects[shape.index].geometry)
        moved = [face @ pose.rotation.T + pose.translation for face in faces]
        result.setdefault((shape.arm, shape.part), []).extend(moved)
    return result


def prism_faces(outline: FloatArray, bottom: float, top: float, pose: FloatArray) -> Faces:
    """Faces of a prism over a (k, 2) outline, moved by a 4x4 pose."""
    low = np.column_stack((outline, np.full(len(outline), bottom)))
    high = np.column_stack((outline, np.full(len(outline), top)))
    sides = [np.array((low[i], low[i - 1], high[i - 1], high[i])) for i in range(len(outline))]
    return [face @ pose[:3, :3].T + pose[:3, 3] for face in [*sides, high]]


def _faces(shape: Any) -> Faces:
    return _box(shape.halfSide) if isinstance(shape, coal.Box) else _capsule(shape.radius, shape.halfLength)


def _box(half: FloatArray) -> Faces:
    faces = []
    for axis in range(3):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        for side in (-1.0, 1.0):
            face = np.zeros((4, 3))
            face[:, axis] = side * half[axis]
            face[:, first] = half[first] * np.array((-1.0, 1.0, 1.0, -1.0))
            face[:, second] = half[second] * np.array((-1.0, -1.0, 1.0, 1.0)) * side
            faces.append(face)
    return faces


def _capsule(radius: float, half: float) -> Faces:
    """Rings from pole to pole, joined by quadrilaterals."""
    heights = np.deg2rad(np.array((-90.0, -60.0, -30.0, 0.0, 0.0, 30.0, 60.0, 90.0)))
    shift = half * np.array((-1.0,) * 4 + (1.0,) * 4)
    around = np.linspace(0.0, 2.0 * np.pi, _AROUND + 1)
    circle = np.array((np.cos(around), np.sin(around)))
    rings = [
        np.column_stack((*(radius * np.cos(h) * circle), np.full(_AROUND + 1, radius * np.sin(h) + z)))
        for h, z in zip(heights, shift, strict=True)
    ]
    return [
        np.array((low[i], low[i + 1], high[i + 1], high[i])) for low, high in pairwise(rings) for i in range(_AROUND)
    ]
