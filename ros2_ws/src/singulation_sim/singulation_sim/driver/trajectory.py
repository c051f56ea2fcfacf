"""A joint trajectory as trajectory_msgs/JointTrajectory carries it, and the rules a controller accepts it by.

The rules are those of ros2_control's JointTrajectoryController (Jazzy, 4.x) with its default parameters: no partial
joint lists, no velocity at the end, no integration of velocities, no effort. Two checks go beyond it, because it lets
through what no robot should be given: numbers that are not finite, and a joint named twice.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from singulation_core import InvalidInputError
from singulation_core.polygon import FloatArray

_NO_VELOCITY = float(np.finfo(np.float32).eps)  # the controller's own limit for "stands still at the end"


@dataclass(frozen=True, eq=False)
class TrajectoryPoint:
    """State to be in at ``time`` [s] after the start; a field that is not given is empty, shape (0,).

    Args:
        time: from the start of the trajectory [s].
        positions: (joints,) [rad].
        velocities: (joints,) [rad/s] or empty.
        accelerations: (joints,) [rad/s^2] or empty.
        effort: has to be empty for a position controller.
    """

    time: float
    positions: FloatArray
    velocities: FloatArray
    accelerations: FloatArray
    effort: FloatArray

    def fields(self) -> Iterator[tuple[str, FloatArray]]:
        """Name and values of the four fields."""
        for name in ("positions", "velocities", "accelerations", "effort"):
            yield name, getattr(self, name)


@dataclass(frozen=True, eq=False)
class JointTrajectory:
    """Points for named joints; ``stamp`` [s] is when the trajectory starts, 0 for at once."""

    joint_names: Sequence[str]
    points: Sequence[TrajectoryPoint]
    stamp: float = 0.0


def point(
    time: float, positions: Sequence[float], velocities: Sequence[float] = (), accelerations: Sequence[float] = ()
) -> TrajectoryPoint:
    """A trajectory point from plain numbers."""
    arrays = [np.array(values, dtype=np.float64) for values in (positions, velocities, accelerations, ())]
    return TrajectoryPoint(time, *arrays)


def accepted(trajectory: JointTrajectory, joint_names: Sequence[str], now: float) -> JointTrajectory:
    """The trajectory in the controller's joint order, if the controller takes it.

    Args:
        trajectory: as it came.
        joint_names: the controller's joints, in its order.
        now: present time [s], same clock as the stamp.

    Raises:
        InvalidInputError: it is refused; the motion that goes on is not touched. The text names the joint or point.
    """
    order = _order(trajectory.joint_names, joint_names)
    if not trajectory.points:
        raise InvalidInputError("trajectory: it has no points, need at least one (an empty one does not stop an arm)")
    for index, item in enumerate(trajectory.points):
        _check_point(index, item, len(joint_names))
    _check_times(trajectory)
    _check_end(trajectory, now)
    return JointTrajectory(joint_names, [_reordered(item, order) for item in trajectory.points], trajectory.stamp)


def _order(given: Sequence[str], wanted: Sequence[str]) -> list[int]:
    """For each of the controller's joints its place in the message."""
    unknown = [name for name in given if name not in wanted]
    missing = [name for name in wanted if name not in given]
    if unknown or missing or len(given) != len(wanted):
        raise InvalidInputError(
            f"trajectory: {len(given)} joints {list(given)}; unknown {unknown}, missing {missing}; "
            f"need each of {list(wanted)} once"
        )
    return [list(given).index(name) for name in wanted]


def _check_point(index: int, item: TrajectoryPoint, joints: int) -> None:
    for name, values in item.fields():
        allowed = {0} if name == "effort" else {joints} if name == "positions" else {0, joints}
        if values.size not in allowed:
            raise InvalidInputError(
                f"trajectory: point {index} has {values.size} {name}, need {' or '.join(map(str, sorted(allowed)))}"
            )
        if not np.isfinite(values).all():
            joint = int(np.flatnonzero(~np.isfinite(values))[0])
            raise InvalidInputError(f"trajectory: point {index}, joint {joint}: {name} {values[joint]}, need a number")


def _check_times(trajectory: JointTrajectory) -> None:
    times = [item.time for item in trajectory.points]
    if not (0.0 <= times[0] < math.inf):
        raise InvalidInputError(f"trajectory: point 0 is at {times[0]} s, need a finite time >= 0")
    for index, (earlier, later) in enumerate(pairwise(times)):
        if not (earlier < later < math.inf):
            raise InvalidInputError(
                f"trajectory: points {index} and {index + 1} are at {earlier} and {later} s, need increasing times"
            )


def _check_end(trajectory: JointTrajectory, now: float) -> None:
    last = trajectory.points[-1]
    fastest = float(np.abs(last.velocities).max(initial=0.0))
    if not (fastest <= _NO_VELOCITY):
        raise InvalidInputError(f"trajectory: it ends with {fastest:.6f} rad/s, need rest at the end")
    end = trajectory.stamp + last.time
    if trajectory.stamp != 0.0 and not (end >= now):
        raise InvalidInputError(f"trajectory: it ends at {end:.3f} s, which is {now - end:.3f} s in the past")


def _reordered(item: TrajectoryPoint, order: list[int]) -> TrajectoryPoint:
    arranged = [values[order] if values.size else values for _, values in item.fields()]
    return TrajectoryPoint(item.time, *arranged)
