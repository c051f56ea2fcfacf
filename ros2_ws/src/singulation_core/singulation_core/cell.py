"""Where things stand in the robot cell. Every node's default comes from here; on a real cell they are parameters."""

from dataclasses import dataclass

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_core.transforms import pose_matrix

_TILT = np.deg2rad(6.0)  # PhoXi mounts lean by 7.5 to 11.75 degrees; the lab's camera by about 8


@dataclass(frozen=True, slots=True)
class CellGeometry:
    """Poses are position x, y, z [m] and quaternion x, y, z, w.

    The table and its workspace are the lab's bin (corners x 0.23..0.55, y -0.22..0.20 at z = 0.04 in ``yumi_body``),
    with the frame ``table`` in its middle. The camera hangs 0.9 m above, looks down at the middle, and its image has
    the far side of the table on top.

    Args:
        table_position: origin of ``table`` in ``yumi_body``; z = 0 of ``table`` is the surface.
        table_quaternion: orientation of ``table`` in ``yumi_body``.
        workspace: where blocks may lie and pushes may go, x_min, x_max, y_min, y_max in ``table`` [m].
        camera_position: of ``phoxi_camera_sensor`` in ``table``.
        camera_quaternion: orientation of ``phoxi_camera_sensor`` (optical) in ``table``.
    """

    table_position: tuple[float, float, float] = (0.39, -0.01, 0.04)
    table_quaternion: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)
    workspace: tuple[float, float, float, float] = (-0.16, 0.16, -0.21, 0.21)
    camera_position: tuple[float, float, float] = (-0.9 * float(np.tan(_TILT)), 0.0, 0.9)
    camera_quaternion: tuple[float, float, float, float] = (
        float(-np.cos(_TILT / 2) / np.sqrt(2)),
        float(np.cos(_TILT / 2) / np.sqrt(2)),
        float(-np.sin(_TILT / 2) / np.sqrt(2)),
        float(np.sin(_TILT / 2) / np.sqrt(2)),
    )

    @property
    def body_from_table(self) -> FloatArray:
        """4x4 pose of ``table`` in ``yumi_body``."""
        return pose_matrix(self.table_position, self.table_quaternion)

    @property
    def table_from_camera(self) -> FloatArray:
        """4x4 pose of ``phoxi_camera_sensor`` (optical: x right, y down, z forward) in ``table``."""
        return pose_matrix(self.camera_position, self.camera_quaternion)

    @property
    def workspace_polygon(self) -> FloatArray:
        """(4, 2) corners of the workspace in ``table``, counter-clockwise [m]."""
        x_min, x_max, y_min, y_max = self.workspace
        return np.array(((x_min, y_min), (x_max, y_min), (x_max, y_max), (x_min, y_max)))
