"""Parameters of ``cell_frames``."""

from dataclasses import dataclass

from singulation_core import CellGeometry
from singulation_core.transforms import pose_matrix
from singulation_node.parameters import parameter

_CELL = CellGeometry()


@dataclass(frozen=True)
class CellFramesSettings:
    """Where table and camera stand, as the other nodes know it."""

    table_position: tuple[float, ...] = parameter(
        _CELL.table_position, "origin of the table frame in yumi_body, x, y, z [m]", read_only=True
    )
    table_quaternion: tuple[float, ...] = parameter(
        _CELL.table_quaternion, "orientation of the table frame in yumi_body, x, y, z, w", read_only=True
    )
    camera_position: tuple[float, ...] = parameter(
        _CELL.camera_position, "camera in the table frame, x, y, z [m]", read_only=True
    )
    camera_quaternion: tuple[float, ...] = parameter(
        _CELL.camera_quaternion, "orientation of the camera in the table frame, x, y, z, w", read_only=True
    )
    body_frame: str = parameter("yumi_body", "frame of the robot's base", read_only=True)
    table_frame: str = parameter("table", "frame of the table", read_only=True)
    camera_frame: str = parameter("phoxi_camera_sensor", "frame of the clouds", read_only=True)

    def __post_init__(self) -> None:
        for position, quaternion in (
            (self.table_position, self.table_quaternion),
            (self.camera_position, self.camera_quaternion),
        ):
            pose_matrix(position, quaternion)
