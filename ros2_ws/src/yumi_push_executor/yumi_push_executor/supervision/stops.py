"""Trajectories that end a motion: along its path, or at where the arm is."""

import numpy as np

from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import JOINTS
from yumi_push_executor.supervision.limits import SupervisionLimits
from yumi_push_executor.supervision.state_watch import JointRange
from yumi_push_executor.supervision.trajectory import Trajectory

_STEPS = 5  # points of a stop; the controller's splines do the rest


def stop_duration(speed: FloatArray, limits: SupervisionLimits) -> float:
    """How long a stop from (7,) joint speeds takes [s].

    The speed falls as (1 - u)^2, so the deceleration fades out: an arm that lags behind its command comes to rest with
    it and does not swing after. Its largest value, at the beginning, is twice the mean.
    """
    return max(limits.stop_duration, 2.0 * float(np.abs(speed).max()) / limits.stop_deceleration)


def stop_along(trajectory: Trajectory, elapsed: float, limits: SupervisionLimits) -> Trajectory:
    """Bring the rate of a running trajectory from 1 to 0.

    The command stays on the planned path and never steps, so nothing is touched that the plan kept clear of.

    Args:
        trajectory: the one that runs.
        elapsed: time since its start [s].
        limits: of the supervision.
    """
    duration = stop_duration(trajectory.sample(elapsed)[1], limits)
    u = np.arange(1, _STEPS + 1) / _STEPS
    positions, velocities = trajectory.sample(elapsed + duration / 3.0 * (1.0 - (1.0 - u) ** 3))
    return Trajectory(duration * u, positions, velocities * ((1.0 - u) ** 2)[:, None])


def hold_at(
    position: FloatArray,
    velocity: FloatArray,
    commanded: FloatArray,
    limits: SupervisionLimits,
    allowed: JointRange,
) -> Trajectory:
    """Come to rest where the arm is, as soon as its speed allows.

    Args:
        position: (7,) measured [rad].
        velocity: (7,) measured [rad/s].
        commanded: (7,) where the controller was ordered to be by now [rad].
        limits: of the supervision.
        allowed: joint range; measurement noise at its border must not become an order beyond it.
    """
    least = stop_duration(velocity, limits)
    target = np.clip(position + velocity * least / 3.0, allowed.lower, allowed.upper)
    # A cubic from rest to rest is 1.5 times as fast in its middle as on average.
    duration = max(least, 1.5 * float(np.abs(commanded - target).max()) / limits.stop_speed)
    return Trajectory(np.array([duration]), target[None], np.zeros((1, JOINTS)))
