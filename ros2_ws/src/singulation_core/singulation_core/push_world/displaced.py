"""An arrangement after its blocks moved."""

import numpy as np

from singulation_core.arrangement import Arrangement
from singulation_core.polygon import FloatArray

_STILL = 1e-9  # bounding radii, radians: rounding of the way into the inner frame and back


def displaced(before: Arrangement, poses: FloatArray, stamp: float | None = None) -> Arrangement:
    """The arrangement with its objects at ``poses`` (n, 3): x, y [m] of the centroid, turn since ``before`` [rad].

    A block that did not move is the same object as before.
    """
    shifts = poses[:, :2] - before.centroids
    moved = (np.abs(shifts).max(axis=1, initial=0.0) > _STILL * before.bounding_radii) | (np.abs(poses[:, 2]) > _STILL)
    objects = [
        item.moved(shift, turn) if changed else item
        for item, shift, turn, changed in zip(before.objects, shifts, poses[:, 2].tolist(), moved, strict=True)
    ]
    return Arrangement(objects, before.frame, before.stamp if stamp is None else stamp)
