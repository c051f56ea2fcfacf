"""Properties and reported state of the simulated robot."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from singulation_sim.driver.mode import DriverMode

ARMS = ("left", "right")
PERIOD = 0.004  # s; EGM's cycle


def joint_names(prefix: str) -> tuple[str, ...]:
    """Joint names as abb_robot_driver makes them, e.g. of the prefix ``yumi_robl``."""
    return tuple(f"{prefix}_joint_{number}" for number in range(1, 8))


@dataclass(frozen=True, slots=True)
class DriverSettings:
    """Properties of the simulated robot.

    Args:
        joints: names of each arm's joints from the shoulder to the flange.
        finger_joints: name of each hand's finger joint.
        lag: time constant with which the joints follow [s].
        position_noise: standard deviation of measured joint positions [rad].
        velocity_noise: standard deviation of measured joint velocities [rad/s].
        braking: joint deceleration of a stop [rad/s^2].
        back_off: way back after a collision, in joint space [rad]; 0.01 is about 4 mm at the tool.
        collision_handler_time: after the way back, until motion is taken again [s]; negative: not before a reset.
        egm_timeout: how long the robot moves on without data [s].
        grippers_calibrated: at the start and after a reset.
    """

    joints: Mapping[str, tuple[str, ...]] = field(
        default_factory=lambda: {"left": joint_names("yumi_robl"), "right": joint_names("yumi_robr")}
    )
    finger_joints: Mapping[str, str] = field(
        default_factory=lambda: {"left": "gripper_l_joint", "right": "gripper_r_joint"}
    )
    lag: float = 0.02
    position_noise: float = 2e-5
    velocity_noise: float = 5e-4
    braking: float = 20.0
    back_off: float = 0.01
    collision_handler_time: float = 0.5
    egm_timeout: float = 1.0
    grippers_calibrated: bool = True


@dataclass(frozen=True, slots=True)
class DriverStatus:
    """Content of ``singulation_msgs/msg/DriverState`` without its header."""

    mode: DriverMode
    motion_enabled: bool
    left_gripper_calibrated: bool
    right_gripper_calibrated: bool
    message: str
