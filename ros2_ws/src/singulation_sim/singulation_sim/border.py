"""Messages of the driver's topics, to and from the library's own types."""

from typing import Any

import numpy as np
from sensor_msgs.msg import JointState
from singulation_msgs.msg import DriverState
from std_msgs.msg import Header

from singulation_core import InvalidInputError
from singulation_core.conversions import seconds_of
from singulation_sim.driver import DriverStatus, JointStates, JointTrajectory, TrajectoryPoint


def trajectory_from_msg(message: Any) -> JointTrajectory:
    """Trajectory of a trajectory_msgs/JointTrajectory; whether it makes sense is the controller's to say."""
    return JointTrajectory(
        tuple(message.joint_names), [_point(item) for item in message.points], seconds_of(message.header.stamp)
    )


def opening_from_msg(message: Any) -> float:
    """Jaw opening [m] of a std_msgs/Float64MultiArray.

    Raises:
        InvalidInputError: not exactly one number.
    """
    if len(message.data) != 1:
        raise InvalidInputError(f"gripper command: {len(message.data)} numbers, need one, the jaw opening [m]")
    return float(message.data[0])


def joint_states_to_msg(states: JointStates, stamp: Any) -> Any:
    """sensor_msgs/JointState."""
    return JointState(
        header=Header(stamp=stamp),
        name=list(states.names),
        position=states.positions.tolist(),
        velocity=states.velocities.tolist(),
    )


def status_to_msg(status: DriverStatus, stamp: Any) -> Any:
    """singulation_msgs/DriverState."""
    return DriverState(
        header=Header(stamp=stamp),
        mode=int(status.mode),
        motion_enabled=status.motion_enabled,
        left_gripper_calibrated=status.left_gripper_calibrated,
        right_gripper_calibrated=status.right_gripper_calibrated,
        message=status.message,
    )


def _point(message: Any) -> TrajectoryPoint:
    fields = [
        np.array(values, dtype=np.float64)
        for values in (message.positions, message.velocities, message.accelerations, message.effort)
    ]
    return TrajectoryPoint(seconds_of(message.time_from_start), *fields)
