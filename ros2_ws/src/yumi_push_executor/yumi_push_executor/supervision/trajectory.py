"""Joint trajectories of one arm as a JointTrajectoryController takes and interpolates them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from singulation_core import InvalidInputError
from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import JOINTS

MAX_POINTS = 10_000


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Points in time of the seven joints; splines between them, rest after the last one.

    Args:
        times: (n,) seconds from the start, not negative, strictly increasing.
        positions: (n, 7) rad, kinematic order.
        velocities: (n, 7) rad/s, or None for straight lines between the points.
        accelerations: (n, 7) rad/s^2, or None for cubic instead of quintic splines; needs velocities.

    Raises:
        InvalidInputError: empty, too long, wrong sizes, not finite, times that do not increase; the text names the
            point and the joint.
    """

    times: FloatArray
    positions: FloatArray
    velocities: FloatArray | None = None
    accelerations: FloatArray | None = None

    def __post_init__(self) -> None:
        times = np.array(self.times, dtype=np.float64).reshape(-1)
        if not (1 <= len(times) <= MAX_POINTS):
            raise InvalidInputError(f"trajectory: {len(times)} points, need 1 to {MAX_POINTS}")
        _require_increasing(times)
        object.__setattr__(self, "times", times)
        for name in ("positions", "velocities", "accelerations"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, _joint_rows(value, len(times), name))
        if self.accelerations is not None and self.velocities is None:
            raise InvalidInputError("trajectory: accelerations without velocities")

    @property
    def duration(self) -> float:
        """Time of the last point [s]."""
        return float(self.times[-1])

    @property
    def start(self) -> FloatArray:
        """First point, (7,) rad."""
        return np.asarray(self.positions[0])

    @property
    def end(self) -> FloatArray:
        """Last point, (7,) rad."""
        return np.asarray(self.positions[-1])

    def sample(self, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Positions [rad] and velocities [rad/s], (m, 7) each, at (m,) seconds from the start.

        Before the first point it rests there, after the last one it rests there.
        """
        wanted = np.atleast_1d(np.asarray(times, dtype=np.float64))
        if len(self.times) == 1:
            return np.repeat(self.positions, len(wanted), axis=0), np.zeros((len(wanted), JOINTS))
        index = np.clip(np.searchsorted(self.times, wanted, side="right") - 1, 0, len(self.times) - 2)
        local = np.clip(wanted, self.times[0], self.times[-1]) - self.times[index]
        c = self._coefficients[index]
        t = local[:, None]
        positions = c[:, 0] + t * (c[:, 1] + t * (c[:, 2] + t * (c[:, 3] + t * (c[:, 4] + t * c[:, 5]))))
        velocities = c[:, 1] + t * (2 * c[:, 2] + t * (3 * c[:, 3] + t * (4 * c[:, 4] + t * 5 * c[:, 5])))
        resting = (wanted < self.times[0]) | (wanted >= self.times[-1])
        velocities[resting] = 0.0
        return positions, velocities

    @cached_property
    def _coefficients(self) -> FloatArray:
        """(n - 1, 6, 7), lowest power first."""
        h = np.diff(self.times)[:, None]
        p0, p1 = self.positions[:-1], self.positions[1:]
        c = np.zeros((len(h), 6, JOINTS))
        c[:, 0] = p0
        if self.velocities is None:
            c[:, 1] = (p1 - p0) / h
            return c
        v0, v1 = self.velocities[:-1], self.velocities[1:]
        c[:, 1] = v0
        if self.accelerations is None:
            c[:, 2] = (3 * (p1 - p0) / h - 2 * v0 - v1) / h
            c[:, 3] = (2 * (p0 - p1) / h + v0 + v1) / h**2
            return c
        a0, a1 = self.accelerations[:-1], self.accelerations[1:]
        c[:, 2] = a0 / 2
        c[:, 3] = (20 * (p1 - p0) - (8 * v1 + 12 * v0) * h - (3 * a0 - a1) * h**2) / (2 * h**3)
        c[:, 4] = (30 * (p0 - p1) + (14 * v1 + 16 * v0) * h + (3 * a0 - 2 * a1) * h**2) / (2 * h**4)
        c[:, 5] = (12 * (p1 - p0) - 6 * (v1 + v0) * h - (a0 - a1) * h**2) / (2 * h**5)
        return c


def _require_increasing(times: FloatArray) -> None:
    bad = np.flatnonzero(~np.isfinite(times))
    if len(bad):
        raise InvalidInputError(f"trajectory: time of point {bad[0]} is {times[bad[0]]}, need a finite one")
    if not (times[0] >= 0.0):
        raise InvalidInputError(f"trajectory: point 0 is at {times[0]} s, need 0 or later")
    steps = np.flatnonzero(~(np.diff(times) > 0.0))
    if len(steps):
        first = int(steps[0])
        raise InvalidInputError(
            f"trajectory: point {first + 1} at {times[first + 1]} s does not follow point {first} at {times[first]} s"
        )


def _joint_rows(value: ArrayLike, count: int, name: str) -> FloatArray:
    rows = np.array(value, dtype=np.float64)
    if rows.shape != (count, JOINTS):
        raise InvalidInputError(f"trajectory: {name} of shape {rows.shape}, need {(count, JOINTS)}")
    bad = np.argwhere(~np.isfinite(rows))
    if len(bad):
        point, joint = (int(part) for part in bad[0])
        raise InvalidInputError(f"trajectory: {name} of point {point}, joint {joint + 1} is {rows[point, joint]}")
    rows.setflags(write=False)
    return rows
