"""Trapezoidal speed profile from rest to rest."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from singulation_core import InvalidInputError
from singulation_core.polygon import FloatArray


@dataclass(frozen=True)
class Trapezoid:
    """Accelerate, cruise, brake; without cruising where the way is too short.

    Args:
        distance: to go, in any unit.
        speed: never exceeded, in that unit per second.
        acceleration: of both ramps.

    Raises:
        InvalidInputError: one of them is not finite and positive.
    """

    distance: float
    speed: float
    acceleration: float

    def __post_init__(self) -> None:
        for name in ("distance", "speed", "acceleration"):
            value = getattr(self, name)
            if not (0.0 < value < math.inf):
                raise InvalidInputError(f"trapezoid: {name} {value}, need a finite positive number")

    @property
    def cruise(self) -> float:
        """Highest speed that is reached."""
        return min(self.speed, math.sqrt(self.distance * self.acceleration))

    @property
    def ramp(self) -> float:
        """Duration of each ramp [s]."""
        return self.cruise / self.acceleration

    @property
    def duration(self) -> float:
        """From rest to rest [s]."""
        return self.distance / self.cruise + self.ramp

    def at(self, times: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Distance gone and speed, (n,) each, at (n,) times within the duration [s]."""
        rest = self.duration - times
        speed = np.minimum(np.minimum(times, rest) * self.acceleration, self.cruise)
        early = 0.5 * self.acceleration * times**2
        late = self.distance - 0.5 * self.acceleration * rest**2
        middle = self.cruise * (times - 0.5 * self.ramp)
        gone = np.where(times < self.ramp, early, np.where(rest < self.ramp, late, middle))
        return np.clip(gone, 0.0, self.distance), np.maximum(speed, 0.0)

    def knots(self, step: float) -> FloatArray:
        """(n,) times from 0 to the duration, at most ``step`` seconds apart, with both ends of the ramps among them.

        Between two of them the acceleration is constant, so that a cubic through them is exact.
        """
        ends = [0.0, self.ramp, self.duration - self.ramp, self.duration]
        if ends[2] - ends[1] <= 1e-9 * self.duration:  # no cruising
            del ends[2]
        parts = [
            np.linspace(start, end, math.ceil((end - start) / step), endpoint=False) for start, end in pairwise(ends)
        ]
        return np.concatenate((*parts, (self.duration,)))
