"""Joint paths in time: within velocity and acceleration limits, from rest to rest."""

import numpy as np

from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics import YumiArm
from yumi_push_executor.motion.parameters import MotionParameters
from yumi_push_executor.motion.trapezoid import Trapezoid
from yumi_push_executor.supervision.trajectory import Trajectory

KNOT_STEP = 0.05  # [s] between the points of a trajectory
_NOTHING = 1e-9  # [rad] and [m]
_SAMPLED = 1.01  # the fastest moment of the tips may lie between two samples


def peaks(trajectory: Trajectory) -> tuple[FloatArray, FloatArray]:
    """Largest joint speeds (7,) [rad/s] and accelerations (7,) [rad/s^2] of the cubics between the points."""
    if trajectory.velocities is None or len(trajectory.times) < 2:
        return np.zeros(7), np.zeros(7)
    h = np.diff(trajectory.times)[:, None]
    mean = np.diff(trajectory.positions, axis=0) / h
    before, after = trajectory.velocities[:-1], trajectory.velocities[1:]
    at_start, at_end = (6.0 * mean - 4.0 * before - 2.0 * after) / h, (2.0 * before + 4.0 * after - 6.0 * mean) / h
    middle = 1.5 * mean - 0.25 * (before + after)
    speed = np.maximum(np.abs(trajectory.velocities).max(axis=0), np.abs(middle).max(axis=0))
    return speed, np.maximum(np.abs(at_start), np.abs(at_end)).max(axis=0)


def slowdown(trajectory: Trajectory, arm: YumiArm, parameters: MotionParameters) -> float:
    """Factor >= 1 by which all times must grow to keep the joints within their limits."""
    speed, acceleration = peaks(trajectory)
    too_fast = float((speed / (parameters.velocity_share * arm.velocity)).max())
    too_hard = float((acceleration / np.array(parameters.joint_acceleration)).max())
    return max(1.0, too_fast, np.sqrt(too_hard))


def slowed(trajectory: Trajectory, factor: float) -> Trajectory:
    """The same path, every time multiplied by ``factor``."""
    if factor == 1.0 or trajectory.velocities is None:
        return trajectory
    return Trajectory(trajectory.times * factor, trajectory.positions, trajectory.velocities / factor)


def backwards(trajectory: Trajectory) -> Trajectory:
    """The same path from its end to its start."""
    velocities = None if trajectory.velocities is None else -trajectory.velocities[::-1]
    return Trajectory(trajectory.duration - trajectory.times[::-1], trajectory.positions[::-1], velocities)


def joined(parts: list[Trajectory]) -> Trajectory:
    """One after the other; each starts at rest where the one before ended at rest."""
    times, offset = [parts[0].times], parts[0].duration
    for part in parts[1:]:
        times.append(part.times[1:] + offset)
        offset += part.duration
    positions = [parts[0].positions] + [part.positions[1:] for part in parts[1:]]
    velocities = [_velocities(parts[0])] + [_velocities(part)[1:] for part in parts[1:]]
    return Trajectory(np.concatenate(times), np.concatenate(positions), np.concatenate(velocities))


def joint_move(arm: YumiArm, start: FloatArray, end: FloatArray, parameters: MotionParameters) -> Trajectory:
    """All joints together, straight in joint space, from rest to rest; the tips keep below the approach speed."""
    way = end - start
    size = np.abs(way)
    if not (size.max() > _NOTHING):
        return Trajectory(np.zeros(1), start[None], np.zeros((1, 7)))
    # Joints that stand, and tips that do when only the last joint turns, limit nothing.
    tip_way, size = max(_SAMPLED * arm.tip_way(start, end), _NOTHING), np.maximum(size, _NOTHING)
    speed = float((parameters.velocity_share * arm.velocity / size).min())
    acceleration = float((np.array(parameters.joint_acceleration) / size).min())
    profile = Trapezoid(
        1.0,
        min(speed, parameters.approach_speed / tip_way),
        min(acceleration, parameters.linear_acceleration / tip_way),
    )
    times = profile.knots(KNOT_STEP)
    gone, rate = profile.at(times)
    return Trajectory(times, start + gone[:, None] * way, rate[:, None] * way)


def _velocities(part: Trajectory) -> FloatArray:
    return np.zeros_like(part.positions) if part.velocities is None else part.velocities
