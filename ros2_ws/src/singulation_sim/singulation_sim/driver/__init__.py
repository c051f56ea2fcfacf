"""The simulated YuMi driver: ros2_control's JointTrajectoryController, the robot behind it, its gripper, its faults."""

from singulation_sim.driver.driver import SimulatedDriver
from singulation_sim.driver.faults import FAULTS
from singulation_sim.driver.mode import DriverMode
from singulation_sim.driver.settings import ARMS, PERIOD, DriverSettings, DriverStatus
from singulation_sim.driver.states import JointStates
from singulation_sim.driver.trajectory import JointTrajectory, TrajectoryPoint

__all__ = [
    "ARMS",
    "FAULTS",
    "PERIOD",
    "DriverMode",
    "DriverSettings",
    "DriverStatus",
    "JointStates",
    "JointTrajectory",
    "SimulatedDriver",
    "TrajectoryPoint",
]
