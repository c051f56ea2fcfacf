"""The camera's view as a solid: what stands in it hides the table."""

from collections.abc import Mapping

import numpy as np
import pinocchio as pin

from singulation_core import CellGeometry
from singulation_core.polygon import FloatArray
from singulation_core.transforms import transform_points
from yumi_push_executor.clearance.shapes import convex, robot_geometry, robot_shapes
from yumi_push_executor.kinematics.model import arm_model, robot

# Opening angles of the PhoXi's projection, horizontal and vertical [rad] (Photoneo's wiki: 47.5 and 36 degrees).
FIELD_OF_VIEW = (float(np.deg2rad(47.5)), float(np.deg2rad(36.0)))


def parts_in_view(
    postures: Mapping[str, FloatArray],
    cell: CellGeometry | None = None,
    field_of_view: tuple[float, float] = FIELD_OF_VIEW,
    margin: float = 0.0,
) -> list[str]:
    """Names of the arms' shapes that the camera sees, or that come nearer to its view than ``margin`` [m].

    Args:
        postures: arm name -> (7,) angles [rad].
        cell: where camera and table are.
        field_of_view: full opening angles of the image, horizontal and vertical [rad].
        margin: [m].
    """
    cell = cell or CellGeometry()
    geometry = robot_geometry().copy()
    view = geometry.addGeometryObject(pin.GeometryObject("view", 0, pin.SE3.Identity(), _pyramid(cell, field_of_view)))
    q = np.zeros(robot().nq)
    for arm, angles in postures.items():
        q[list(arm_model(arm).positions)] = angles
    for shape in robot_shapes():
        if shape.arm in postures:
            geometry.addCollisionPair(pin.CollisionPair(shape.index, view))
    data = pin.GeometryData(geometry)
    pin.computeDistances(robot(), robot().createData(), geometry, data, q)
    distances = [result.min_distance for result in data.distanceResults]
    return [
        geometry.geometryObjects[pair.first].name
        for pair, distance in zip(geometry.collisionPairs, distances, strict=True)
        if not (distance > margin)
    ]


def _pyramid(cell: CellGeometry, field_of_view: tuple[float, float]) -> object:
    """From the camera to a little below the table, in ``yumi_body``."""
    depth = 1.1 * float(np.linalg.norm(cell.camera_position))
    x, y = depth * np.tan(0.5 * np.array(field_of_view))
    corners = np.array(((0.0, 0.0, 0.0), (-x, -y, depth), (x, -y, depth), (x, y, depth), (-x, y, depth)))
    faces = [(0, 2, 1), (0, 3, 2), (0, 4, 3), (0, 1, 4), (1, 2, 3), (1, 3, 4)]
    return convex(transform_points(cell.body_from_table @ cell.table_from_camera, corners), faces)
