"""One arm's trajectory controller: which joint positions are commanded now."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_sim.driver.spline import Spline
from singulation_sim.driver.trajectory import JointTrajectory, TrajectoryPoint, accepted


class TrajectoryController:
    """Behaves as ros2_control's JointTrajectoryController with a topic as input (Jazzy, default parameters).

    A new trajectory replaces the running one entirely. It starts from the *measured* state of the cycle that takes it
    up (which is why a replacement in motion makes a small step, by the tracking error, in the commanded position).
    Stamp 0 means at once. A start in the future is approached from now on; points that lie in the past are skipped.
    After the last point its position is held.

    Args:
        joint_names: in the order of all arrays.
        positions: (joints,) held at the beginning [rad].
    """

    def __init__(self, joint_names: Sequence[str], positions: FloatArray) -> None:
        self.joint_names = tuple(joint_names)
        self._held = np.array(positions, dtype=np.float64)
        self._pending: JointTrajectory | None = None
        self._spline: Spline | None = None

    @property
    def is_moving(self) -> bool:
        """Whether a trajectory has been taken up, or is about to be, and its end has not been reached."""
        return self._pending is not None or self._spline is not None

    def command(self, trajectory: JointTrajectory, now: float) -> None:
        """Take a trajectory for the next cycle.

        Raises:
            InvalidInputError: refused; what is going on goes on.
        """
        self._pending = accepted(trajectory, self.joint_names, now)

    def hold(self, positions: FloatArray) -> None:
        """Forget every trajectory and hold (joints,) positions [rad]."""
        self._held = np.array(positions, dtype=np.float64)
        self._pending = None
        self._spline = None

    def reference(self, now: float, measured: TrajectoryPoint) -> FloatArray:
        """(joints,) commanded positions of the cycle at ``now`` [s]; ``measured`` is the state the arm reports."""
        if self._pending is not None:
            self._spline = _spline(self._pending, now, measured)
            self._pending = None
        if self._spline is not None:
            self._held = self._spline.sample(now)
            if now >= self._spline.end_time:
                self._spline = None
        return self._held


def _spline(trajectory: JointTrajectory, now: float, measured: TrajectoryPoint) -> Spline:
    start = trajectory.stamp if trajectory.stamp != 0.0 else now
    knots = [replace(item, time=start + item.time) for item in trajectory.points]
    if knots[0].time > now:
        knots.insert(0, replace(measured, time=now))
    return Spline(knots)
