"""How far apart the objects of an arrangement are."""

import math

import numpy as np

from singulation_core.arrangement import Arrangement
from singulation_core.errors import InvalidInputError
from singulation_core.polygon import FloatArray, separation

# Coincident centroids would give ln 0; a perception error must not look like an infinite gain.
_SMALLEST_DISTANCE = 0.05  # in bounding radii


def singulation_distance(arrangement: Arrangement, unit: float | None = None) -> float:
    """s(A): mean over all pairs of ln(centroid distance / unit) (paper, definition 1).

    Args:
        arrangement: n objects.
        unit: length that counts as 1 [m]; the mean bounding radius of the arrangement if None. When
            arrangements are compared, give the same unit for both.

    Returns:
        s, without unit; NaN for fewer than two objects, which have no pair.

    Raises:
        InvalidInputError: the unit is not a positive length.
    """
    if len(arrangement) < 2:
        return math.nan
    if unit is None:
        unit = float(arrangement.bounding_radii.mean())
    if not (0.0 < unit < math.inf):
        raise InvalidInputError(f"singulation distance: unit {unit} m, need a finite positive length")
    floor = _SMALLEST_DISTANCE * float(arrangement.bounding_radii.mean())
    distances = np.maximum(pair_distances(arrangement.centroids), floor)
    return float(np.log(distances / unit).mean())


def pair_distances(points: FloatArray) -> FloatArray:
    """Distances of all n (n - 1) / 2 pairs of (n, 2) points [m]."""
    first, second = np.triu_indices(len(points), 1)
    difference = points[first] - points[second]
    return np.asarray(np.hypot(difference[:, 0], difference[:, 1]))


def smallest_gap(arrangement: Arrangement) -> float:
    """Smallest gap between the outlines of any two objects [m].

    Args:
        arrangement: any number of objects.

    Returns:
        Negative where outlines overlap (penetration depth); infinite for fewer than two objects.
    """
    objects = arrangement.objects
    centres, radii = arrangement.centroids, arrangement.bounding_radii
    first, second = np.triu_indices(len(objects), 1)
    difference = centres[first] - centres[second]
    bounds = np.hypot(difference[:, 0], difference[:, 1]) - radii[first] - radii[second]
    gap = math.inf
    for pair in np.argsort(bounds):
        if bounds[pair] >= gap:  # no closer pair can follow: circles bound the gap from below
            break
        gap = min(gap, separation(objects[first[pair]].outline, objects[second[pair]].outline))
    return gap
