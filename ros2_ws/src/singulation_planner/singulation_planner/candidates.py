"""What a policy proposes: which object to push, in which direction, along which line."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray


class Candidates(NamedTuple):
    """Pushes in the order in which they shall be tried.

    Attributes:
        objects: (m,) index of the push object in the scene.
        directions: (m, 2) unit vectors.
        offsets: (m,) distance of the push line to the left of the centroid [m].
        gains: (m,) expected (s' - s) / s, NaN where nothing was simulated; None if nowhere.
        values: (m,) by which pushes of different contact modes compare, larger is better; None if there is none.
        poses: (m, n, 3) expected x, y [m] and turn [rad] of the objects of the scene; None if nothing was simulated.
    """

    objects: IntArray
    directions: FloatArray
    offsets: FloatArray
    gains: FloatArray | None = None
    values: FloatArray | None = None
    poses: FloatArray | None = None


def through_centroid(objects: IntArray | int, directions: FloatArray) -> Candidates:
    """Candidates whose push lines pass through the centroids of their objects; one object may serve for all."""
    count = len(directions)
    if isinstance(objects, int):
        objects = np.full(count, objects, dtype=np.int64)
    return Candidates(objects, directions, np.zeros(count))


def object_by_object(fans: Iterable[tuple[int, FloatArray, FloatArray]]) -> Iterator[Candidates]:
    """The good directions of each object in turn, then, where nothing else is left, the others.

    Args:
        fans: index of the object, its good directions (k, 2) and its other ones (m, 2), best first.
    """
    others = []
    for index, good, rest in fans:
        yield through_centroid(index, good)
        others.append((index, rest))
    for index, rest in others:
        yield through_centroid(index, rest)
