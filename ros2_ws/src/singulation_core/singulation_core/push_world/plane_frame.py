"""The frame and unit inside which a world computes."""

from dataclasses import dataclass

import numpy as np

from singulation_core.polygon import FloatArray


@dataclass(frozen=True, eq=False)
class PlaneFrame:
    """Inner coordinates = the outer ones shifted by ``origin``, turned by ``-heading``, divided by ``unit``.

    A world that starts in the frame of its push gives the same result wherever the scene lies and however it is turned.
    """

    origin: FloatArray  # (2,) [m]
    heading: float  # [rad]
    unit: float  # [m]

    @property
    def axes(self) -> FloatArray:
        """(2, 2) matrix whose columns are the inner axes in outer coordinates."""
        cosine, sine = np.cos(self.heading), np.sin(self.heading)
        return np.array(((cosine, -sine), (sine, cosine)))

    def inner(self, points: FloatArray) -> FloatArray:
        """(..., 2) [m] to inner units."""
        return np.asarray((points - self.origin) @ self.axes / self.unit)

    def outer(self, points: FloatArray) -> FloatArray:
        """(..., 2) inner units to [m]."""
        return np.asarray(points @ self.axes.T * self.unit + self.origin)
