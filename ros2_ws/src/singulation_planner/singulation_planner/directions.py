"""Directions that turn with the scene.

The paper tries 16 fixed directions "from 0 to 2 pi". Fixed to the axes of the table they would make the plan depend on
how the scene happens to lie; here the first of them points away from the other objects.
"""

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.kernels import compass
from singulation_planner.kernels.types import IntArray
from singulation_planner.scene import Scene

COUNT = 16  # paper, algorithm 1
# 0, 1, -1, 2, -2, ...: the neighbours of a direction, nearest first.
_NEAREST_FIRST = np.array([0, *(sign * k for k in range(1, COUNT // 2) for sign in (1, -1)), COUNT // 2]) % COUNT
_DEGENERATE = 1e-6  # in units of the scale; a shorter vector has no direction
_FEW = 64  # scores that an insertion sort orders faster than numpy


def unit(vector: FloatArray, scene: Scene) -> FloatArray | None:
    """The (2,) vector [m] with length one; None if it is too short to have a direction."""
    length = float(np.hypot(vector[0], vector[1]))
    return vector / length if length > _DEGENERATE * scene.scale else None


def away(scene: Scene, index: int) -> FloatArray:
    """(2,) unit vector from the mean of all centroids to that of an object.

    An object in the very middle has no such direction; then away from the nearest other one, or along x.
    """
    return np.asarray(compass.away(scene.centroids, index, scene.scale))


def fan(first: FloatArray) -> FloatArray:
    """(16, 2) evenly spread unit vectors, counter-clockwise from ``first``."""
    return np.asarray(compass.fan(first, COUNT))


def around(first: FloatArray) -> FloatArray:
    """(16, 2) the same, those nearest to ``first`` first."""
    return fan(first)[_NEAREST_FIRST]


def comparable(scores: FloatArray, scale: float) -> FloatArray:
    """Scores rounded to a billionth of ``scale``, so that equal ones are equal whatever their rounding errors."""
    return np.round(scores / scale, 9)


def ascending(scores: FloatArray, scale: float = 1.0) -> IntArray:
    """Order of the scores, smallest first; those that differ by less than rounding errors keep their order."""
    if len(scores) <= _FEW:
        return np.asarray(compass.ascending(scores, scale))
    return np.argsort(comparable(scores, scale), kind="stable")
