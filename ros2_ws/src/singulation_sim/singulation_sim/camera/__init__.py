"""A PhoXi-like camera: organized point clouds, ray-cast from blocks, table and robot."""

from singulation_sim.camera.defects import SensorDefects
from singulation_sim.camera.model import PHOXI_FULL, PHOXI_SMALL, CameraModel
from singulation_sim.camera.phoxi import PhoxiCamera, warm_up
from singulation_sim.camera.robot_shape import RobotShape
from singulation_sim.camera.solid import Solid, block_solid, box_solid

__all__ = [
    "PHOXI_FULL",
    "PHOXI_SMALL",
    "CameraModel",
    "PhoxiCamera",
    "RobotShape",
    "SensorDefects",
    "Solid",
    "block_solid",
    "box_solid",
    "warm_up",
]
