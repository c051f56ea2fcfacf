"""Piecewise polynomials through trajectory points: linear, cubic or quintic by what both ends of a piece specify."""

from bisect import bisect_right
from collections.abc import Sequence
from functools import cache

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_sim.driver.trajectory import TrajectoryPoint

_DEGREE = 5


class Spline:
    """Positions over time through knots.

    Between two knots the polynomial is of degree 1 if either lacks velocities, 3 if both have velocities and either
    lacks accelerations, 5 if both have all (as ros2_control's JointTrajectoryController interpolates). Before the
    first knot the first position holds, after the last knot the last.

    Args:
        knots: points whose ``time`` is absolute [s] and increases.
    """

    def __init__(self, knots: Sequence[TrajectoryPoint]) -> None:
        self._knots = tuple(knots)
        self._times = [item.time for item in knots]
        self._index = -1
        self._coefficients: FloatArray | None = None  # of the piece ``_index``

    @property
    def end_time(self) -> float:
        """Time of the last knot [s]."""
        return self._times[-1]

    def sample(self, time: float) -> FloatArray:
        """(joints,) positions [rad] at an absolute time [s]."""
        index = bisect_right(self._times, time) - 1
        if index < 0 or index == len(self._knots) - 1:
            return self._knots[index if index > 0 else 0].positions
        if index != self._index or self._coefficients is None:
            self._index, self._coefficients = index, _piece(*self._knots[index : index + 2])
        t = time - self._times[index]
        powers = np.array((1.0, t, t**2, t**3, t**4, t**5))
        return np.asarray(powers @ self._coefficients)


def _piece(first: TrajectoryPoint, second: TrajectoryPoint) -> FloatArray:
    """(6, joints) coefficients of the powers of the time since the first knot."""
    conditions = [(first.positions, second.positions)]
    if first.velocities.size and second.velocities.size:
        conditions.append((first.velocities, second.velocities))
        if first.accelerations.size and second.accelerations.size:
            conditions.append((first.accelerations, second.accelerations))
    result = np.zeros((_DEGREE + 1, first.positions.size))
    result[: 2 * len(conditions)] = _hermite(conditions, second.time - first.time)
    return result


def _hermite(conditions: list[tuple[FloatArray, FloatArray]], duration: float) -> FloatArray:
    """Coefficients of the polynomial whose derivatives 0, 1, ... have the given values at both ends."""
    values = np.array([pair[end] * duration**order for end in (0, 1) for order, pair in enumerate(conditions)])
    size = len(values)
    return np.asarray((_unit_hermite(size) @ values) / duration ** np.arange(size)[:, None])


@cache
def _unit_hermite(size: int) -> FloatArray:
    """(size, size) coefficients from values at both ends of a piece of duration 1."""
    rows = [[_derivative(power, order, u) for power in range(size)] for u in (0, 1) for order in range(size // 2)]
    return np.linalg.inv(np.array(rows))


def _derivative(power: int, order: int, u: int) -> float:
    """Derivative of the given order of u^power at u = 0 or 1."""
    if power < order:
        return 0.0
    factor = 1.0
    for step in range(order):
        factor *= power - step
    return factor if u == 1 or power == order else 0.0
