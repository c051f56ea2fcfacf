"""Orders and driver states as messages."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from builtin_interfaces.msg import Duration
from std_msgs.msg import Float64MultiArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from singulation_core import InvalidInputError
from yumi_push_executor.supervision import DriverMode, DriverStatus, Instant, Trajectory


def trajectory_to_msg(trajectory: Trajectory, joint_names: Sequence[str]) -> Any:
    """trajectory_msgs/JointTrajectory with the stamp 0, which a JointTrajectoryController reads as "start now"."""
    empty: list[list[float]] = [[]] * len(trajectory.times)
    velocities = empty if trajectory.velocities is None else trajectory.velocities.tolist()
    accelerations = empty if trajectory.accelerations is None else trajectory.accelerations.tolist()
    points = [
        JointTrajectoryPoint(
            positions=positions, velocities=speed, accelerations=acceleration, time_from_start=duration_of(time)
        )
        for time, positions, speed, acceleration in zip(
            trajectory.times, trajectory.positions.tolist(), velocities, accelerations, strict=True
        )
    ]
    return JointTrajectory(joint_names=list(joint_names), points=points)


def duration_of(seconds: float) -> Any:
    """builtin_interfaces/Duration of a time that is not negative [s]."""
    nanoseconds = round(float(seconds) * 1e9)
    return Duration(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)


def opening_to_msg(opening: float) -> Any:
    """std_msgs/Float64MultiArray with the one value a gripper controller takes: jaw opening [m].

    Raises:
        InvalidInputError: it is not finite.
    """
    if not np.isfinite(opening):
        raise InvalidInputError(f"gripper: opening {opening} m, need a finite one")
    return Float64MultiArray(data=[float(opening)])


def driver_status_from_msg(message: Any, seen: Instant) -> DriverStatus:
    """State of the driver from a singulation_msgs/DriverState.

    Raises:
        InvalidInputError: a mode that does not exist.
    """
    try:
        mode = DriverMode(message.mode)
    except ValueError:
        known = ", ".join(f"{item.value} {item.name}" for item in DriverMode)
        raise InvalidInputError(f"driver state: mode {message.mode}; one of: {known}") from None
    calibrated = {"left": bool(message.left_gripper_calibrated), "right": bool(message.right_gripper_calibrated)}
    return DriverStatus(mode, bool(message.motion_enabled), calibrated, str(message.message), seen)
