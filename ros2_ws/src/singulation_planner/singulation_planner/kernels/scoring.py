"""Sums over objects that the policies rank by: O(n) for one direction, O(n^2) for all objects."""

import numpy as np

from singulation_core.jit import compiled_maker, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray

FIXED_DISC, ANY_MEMBER, GROWING_DISC = 0, 1, 2
RAY, SEGMENT, LINE = 0, 1, 2


@compiled_part
def _distance(points: FloatArray, i: int, j: int) -> float:
    """Distance of two points [m]; five times faster than hypot, whose care for huge numbers is not needed here."""
    dx, dy = points[i, 0] - points[j, 0], points[i, 1] - points[j, 1]
    return np.sqrt(dx * dx + dy * dy)


@compiled_maker
def distance_sums(centroids: FloatArray, logarithmic: bool) -> FloatArray:
    """(n,) sums of the distances, or of their logarithms, from each centroid to all others."""
    n = len(centroids)
    sums = np.zeros(n)
    for i in range(n):
        for j in range(i + 1, n):
            distance = _distance(centroids, i, j)
            term = np.log(distance) if logarithmic else distance
            sums[i] += term
            sums[j] += term
    return sums


@compiled_part
def _grow(centroids: FloatArray, radii: FloatArray, seed: int, number: int, rule: int, labels: IntArray) -> None:
    """Put every unlabelled object that the cluster of ``seed`` reaches into it, and repeat until none is left."""
    n = len(radii)
    labels[seed] = number
    reach, grown = radii[seed], True
    low, high = (0, n) if rule == ANY_MEMBER else (seed, seed + 1)
    while grown:
        grown = False
        for i in range(n):
            if labels[i] >= 0:
                continue
            near = False
            for k in range(low, high):
                if labels[k] != number:
                    continue
                distance = _distance(centroids, k, i)
                near = near or distance < (radii[k] if rule == ANY_MEMBER else reach) + radii[i]
            if near:
                labels[i] = number
                grown = rule != FIXED_DISC
                if rule == GROWING_DISC:
                    gap = _distance(centroids, seed, i)
                    reach = max(reach, gap + radii[i])


@compiled_maker
def cluster(centroids: FloatArray, radii: FloatArray, seed: int, rule: int) -> IntArray:
    """(n,) cluster numbers from 0, the cluster around ``seed``, in the order in which they are formed.

    Each further seed is the object whose distances to the seeds so far have the largest sum.
    """
    n = len(radii)
    labels = np.full(n, -1)
    remoteness = np.zeros(n)
    number = -1
    while True:
        number += 1
        _grow(centroids, radii, seed, number, rule, labels)
        farthest = -1
        for i in range(n):
            remoteness[i] += _distance(centroids, i, seed)
            if labels[i] < 0 and (farthest < 0 or remoteness[i] > remoteness[farthest] * (1.0 + 1e-9)):
                farthest = i
        if farthest < 0:
            return labels
        seed = farthest


@compiled_maker
def path_distance_sums(
    points: FloatArray, radii: FloatArray, origin: int, directions: FloatArray, path: int, length: float
) -> FloatArray:
    """(k,) for each direction the sum of the distances of all other discs to the path of object ``origin``.

    Args:
        points, radii: (n, 2), (n,) discs; radii of 0 give distances of the points.
        origin: index of the pushed object.
        directions: (k, 2) unit vectors.
        path: ray, segment or line through the object.
        length: of the segment [m].
    """
    sums = np.zeros(len(directions))
    for k in range(len(directions)):
        for j in range(len(radii)):
            if j == origin:
                continue
            rx, ry = points[j, 0] - points[origin, 0], points[j, 1] - points[origin, 1]
            along = rx * directions[k, 0] + ry * directions[k, 1]
            across = ry * directions[k, 0] - rx * directions[k, 1]
            beyond = 0.0
            if path != LINE and along < 0.0:
                beyond = -along
            elif path == SEGMENT and along > length:
                beyond = along - length
            sums[k] += max(0.0, np.sqrt(across * across + beyond * beyond) - radii[j])
    return sums
