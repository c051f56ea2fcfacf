"""Collision shapes of the robot, from the URDF, and which of them can meet."""

from dataclasses import dataclass
from enum import Enum
from functools import cache
from importlib.resources import as_file
from typing import Any

import coal
import numpy as np
import pinocchio as pin

from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import ARMS, robot, urdf_resource

GRIPPER, FINGER = 8, 9  # parts beyond the seven links of an arm


class Kind(Enum):
    """Who meets whom; each kind has its own margin."""

    BODY = "own body"
    OTHER_ARM = "other arm"
    TABLE = "table"
    FINGER_TABLE = "finger and table"
    BLOCK = "block"
    FINGER_BLOCK = "finger and block"
    MOVED_BLOCKS = "blocks after the push"


@dataclass(frozen=True)
class Shape:
    """One collision shape: where it stands in the geometry model, whose it is, and which part.

    Args:
        index: in the geometry model.
        arm: ``left``, ``right``, or "" for the body.
        part: 0 body, 1..7 links from the shoulder, then gripper and finger.
    """

    index: int
    arm: str
    part: int


@cache
def robot_geometry() -> Any:
    """Pinocchio geometry model of the whole robot without pairs; cylinders become the capsules they stand for."""
    with as_file(urdf_resource()) as path:
        geometry = pin.buildGeomFromUrdf(robot(), str(path), pin.GeometryType.COLLISION)
    for item in geometry.geometryObjects:
        if isinstance(item.geometry, coal.Cylinder):
            item.geometry = coal.Capsule(item.geometry.radius, 2.0 * item.geometry.halfLength)
    return geometry


@cache
def robot_shapes() -> tuple[Shape, ...]:
    """All shapes of the robot."""
    return tuple(_shape(index, item.name) for index, item in enumerate(robot_geometry().geometryObjects))


def _shape(index: int, name: str) -> Shape:
    arm = next((one for one in ARMS if name.startswith(one)), "")
    if not arm:
        return Shape(index, "", 0)
    part = name.removeprefix(arm + "_")
    if part.startswith("link_"):
        return Shape(index, arm, int(part[5]))
    return Shape(index, arm, FINGER if part.startswith("finger") else GRIPPER)


@cache
def robot_pairs(arm: str) -> tuple[tuple[int, int, Kind], ...]:
    """Pairs that matter while ``arm`` moves and the other stands still.

    Neighbours on the chain always touch in this model and cannot collide within the joint limits; they are left out.
    """
    shapes = robot_shapes()
    own = [shape for shape in shapes if shape.arm == arm]
    other = [shape for shape in shapes if shape.arm not in ("", arm)]
    body = [shape for shape in shapes if not shape.arm]
    pairs = [(a.index, b.index, Kind.BODY) for a in own for b in body if a.part >= 3]
    pairs += [(a.index, b.index, Kind.BODY) for a in own for b in own if b.part - a.part >= 3 and a.part <= 4]
    pairs += [(a.index, b.index, Kind.OTHER_ARM) for a in own for b in other if a.part >= 2]
    return tuple(pairs)


def prism(outline: FloatArray, bottom: float, top: float, pose: FloatArray) -> Any:
    """Convex coal shape over a (k, 2) counter-clockwise outline between two heights [m], moved by a 4x4 pose."""
    k = len(outline)
    low = np.column_stack((outline, np.full(k, bottom)))
    high = np.column_stack((outline, np.full(k, top)))
    points = np.vstack((low, high)) @ pose[:3, :3].T + pose[:3, 3]
    faces = [(0, i + 1, i) for i in range(1, k - 1)] + [(k, k + i, k + i + 1) for i in range(1, k - 1)]
    for i in range(k):
        j = (i + 1) % k
        faces += [(i, j, k + j), (i, k + j, k + i)]
    return convex(points, faces)


def convex(points: FloatArray, faces: list[tuple[int, int, int]]) -> Any:
    """Coal's convex polyhedron from (m, 3) vertices and triangles that turn outward."""
    vertices, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for point in points:
        vertices.append(point)
    for face in faces:
        triangles.append(coal.Triangle(*face))
    return coal.Convex(vertices, triangles)
