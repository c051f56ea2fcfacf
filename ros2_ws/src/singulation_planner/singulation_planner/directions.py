"""Directions that turn with the scene.

The paper tries 16 fixed directions "from 0 to 2 pi". Fixed to the axes of the table they would make the plan depend on
how the scene happens to lie; here the first of them points away from the other objects.
"""

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray
from singulation_planner.scene import Scene

COUNT = 16  # paper, algorithm 1
_ANGLES = 2.0 * np.pi * np.arange(COUNT) / COUNT
_COSINES, _SINES = np.cos(_ANGLES), np.sin(_ANGLES)
# 0, 1, -1, 2, -2, ...: the neighbours of a direction, nearest first.
_NEAREST_FIRST = np.array([0, *(sign * k for k in range(1, COUNT // 2) for sign in (1, -1)), COUNT // 2]) % COUNT
_DEGENERATE = 1e-6  # in units of the scale; a shorter vector has no direction


def unit(vector: FloatArray, scene: Scene) -> FloatArray | None:
    """The (2,) vector [m] with length one; None if it is too short to have a direction."""
    length = float(np.hypot(vector[0], vector[1]))
    return vector / length if length > _DEGENERATE * scene.scale else None


def away(scene: Scene, index: int) -> FloatArray:
    """(2,) unit vector from the mean of the other centroids to that of an object.

    An object in the middle of the others has no such direction; then away from the nearest, or along x.
    """
    own = scene.centroids[index]
    found = unit(own - scene.centroids.sum(axis=0) / len(scene), scene)
    if found is None:
        offsets = own - np.delete(scene.centroids, index, axis=0)
        found = unit(offsets[int(nearest_first(offsets, scene)[0])], scene)
    return np.array((1.0, 0.0)) if found is None else found


def nearest_first(offsets: FloatArray, scene: Scene) -> IntArray:
    """(m,) order of (m, 2) vectors by length; equal ones keep their order."""
    lengths = np.hypot(offsets[:, 0], offsets[:, 1])
    return np.argsort(comparable(lengths, scene.scale), kind="stable")


def fan(first: FloatArray) -> FloatArray:
    """(16, 2) evenly spread unit vectors, counter-clockwise from ``first``."""
    x, y = float(first[0]), float(first[1])
    return np.column_stack((x * _COSINES - y * _SINES, x * _SINES + y * _COSINES))


def around(first: FloatArray) -> FloatArray:
    """(16, 2) the same, those nearest to ``first`` first."""
    return fan(first)[_NEAREST_FIRST]


def comparable(scores: FloatArray, scale: float) -> FloatArray:
    """Scores rounded to a billionth of ``scale``, so that equal ones are equal whatever their rounding errors."""
    return np.round(scores / scale, 9)
