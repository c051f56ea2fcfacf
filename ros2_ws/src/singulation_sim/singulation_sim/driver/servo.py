"""What the robot does with the commanded positions: it follows with a lag, brakes, and backs off after a collision."""

import math
from collections import deque
from collections.abc import Callable

import numpy as np

from singulation_core.polygon import FloatArray

_HISTORY = 250  # cycles of the path that are remembered: one second
_STANDSTILL = 1e-4  # rad/s; below this an arm counts as standing


class ArmServo:
    """Joint positions that follow a reference with a first-order lag, never faster than the joints can.

    Args:
        positions: (joints,) where the arm stands [rad].
        max_velocities: (joints,) [rad/s].
        lag: time constant of the following [s], 0 for none.
        braking: deceleration of a stop [rad/s^2].
    """

    def __init__(self, positions: FloatArray, max_velocities: FloatArray, lag: float, braking: float) -> None:
        self.positions = np.array(positions, dtype=np.float64)
        self.velocities = np.zeros_like(self.positions)
        self._max_velocities = np.asarray(max_velocities, dtype=np.float64)
        self._lag = lag
        self._braking = braking
        self._path: deque[FloatArray] = deque([self.positions], maxlen=_HISTORY)

    @property
    def stands(self) -> bool:
        """Whether no joint moves."""
        return bool(np.abs(self.velocities).max() < _STANDSTILL)

    def follow(self, reference: FloatArray, period: float, speed_limit: float = math.inf) -> None:
        """One cycle of ``period`` [s] towards (joints,) positions [rad], no joint above ``speed_limit`` [rad/s]."""
        share = 1.0 if self._lag <= 0.0 else -math.expm1(-period / self._lag)
        wanted = (reference - self.positions) * (share / period)
        limits = np.minimum(self._max_velocities, speed_limit)
        self._move(np.clip(wanted, -limits, limits), period)

    def coast(self, period: float) -> None:
        """One cycle at the velocity of the last one."""
        self._move(self.velocities, period)

    def halt(self) -> None:
        """Stand at once, as against a mechanical limit."""
        self.velocities = np.zeros_like(self.positions)

    def brake(self, period: float) -> None:
        """One cycle of braking: all joints together, so that the tool stays on its path."""
        fastest = float(np.abs(self.velocities).max())
        keep = max(0.0, 1.0 - self._braking * period / fastest) if fastest > _STANDSTILL else 0.0
        self._move(self.velocities * keep, period)

    def way_back(self, length: float) -> Callable[[float], bool]:
        """A function to be called each cycle that backs off along the path just travelled.

        Args:
            length: of the way in joint space [rad], as far as it is remembered.

        Returns:
            Function of the period [s] that makes one cycle and says whether the way is finished.
        """
        way = _last_part(list(self._path), length)

        def cycle(period: float) -> bool:
            if not way:
                self.halt()
                return True
            self._move((way.pop() - self.positions) / period, period)
            return False

        return cycle

    def _move(self, velocities: FloatArray, period: float) -> None:
        self.velocities = velocities
        self.positions = self.positions + velocities * period
        # Standing still is no part of a path, else an arm that stood for a second would have none to go back on.
        if np.abs(velocities).max() > _STANDSTILL:
            self._path.append(self.positions)


def _last_part(path: list[FloatArray], length: float) -> list[FloatArray]:
    """The end of a path, at most ``length`` long, in the order it was travelled, without its last point."""
    travelled, first = 0.0, len(path) - 1
    while first > 0 and travelled < length:
        travelled += float(np.linalg.norm(path[first] - path[first - 1]))
        first -= 1
    return path[first:-1]
