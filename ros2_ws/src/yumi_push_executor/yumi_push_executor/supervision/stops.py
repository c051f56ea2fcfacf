"""Trajectories that end a motion: along its path, or at where the arm is."""

import numpy as np

from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import JOINTS
from yumi_push_executor.supervision.state_watch import JointRange
from yumi_push_executor.supervision.trajectory import Trajectory

_STEPS = 5  # points of a stop; the controller's splines do the rest


def stop_along(trajectory: Trajectory, elapsed: float, duration: float) -> Trajectory:
    """Bring the rate of a running trajectory from 1 to 0 with constant deceleration.

    The command stays on the planned path and never steps, so nothing is touched that the plan kept clear of.

    Args:
        trajectory: the one that runs.
        elapsed: time since its start [s].
        duration: until standstill [s].
    """
    times = duration * np.arange(1, _STEPS + 1) / _STEPS
    rate = 1.0 - times / duration
    positions, velocities = trajectory.sample(elapsed + times - times**2 / (2.0 * duration))
    return Trajectory(times, positions, velocities * rate[:, None])


def hold_at(
    position: FloatArray,
    velocity: FloatArray,
    commanded: FloatArray,
    *,
    least: float,
    speed: float,
    allowed: JointRange,
) -> Trajectory:
    """Come to rest where the arm is, at the point that a constant deceleration reaches.

    Args:
        position: (7,) measured [rad].
        velocity: (7,) measured [rad/s].
        commanded: (7,) where the controller was ordered to be by now [rad].
        least: shortest duration [s].
        speed: fastest joint speed of the way back from the command to the measured position [rad/s].
        allowed: joint range; measurement noise at its border must not become an order beyond it.
    """
    target = np.clip(position + velocity * least / 2.0, allowed.lower, allowed.upper)
    # A cubic from rest to rest is 1.5 times as fast in its middle as on average.
    duration = max(least, 1.5 * float(np.abs(commanded - target).max()) / speed)
    return Trajectory(np.array([duration]), target[None], np.zeros((1, JOINTS)))
