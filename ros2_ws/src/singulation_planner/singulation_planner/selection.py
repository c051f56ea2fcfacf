"""Which object to push first, and how objects fall into clusters around seeds."""

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.directions import ascending, comparable
from singulation_planner.kernels.scoring import distance_sums
from singulation_planner.kernels.types import IntArray
from singulation_planner.scene import Scene


def by_connectivity(scene: Scene) -> list[int]:
    """Objects by the sum of their distances to all others, smallest first (paper, section IV, step 1)."""
    return ascending(distance_sums(scene.centroids, False), scene.scale).tolist()


def by_removal(scene: Scene) -> list[int]:
    """Objects by how far apart the others would be without them, most first (paper, section V-C).

    How far apart is measured as in definition 1: the pairs that are left have the largest mean log distance when the
    pairs that go have the smallest sum.
    """
    return ascending(distance_sums(scene.centroids / scene.scale, True)).tolist()


def clusters_around_seeds(scene: Scene, count: int) -> IntArray:
    """(n,) cluster numbers 0..count-1: every object goes to its nearest seed.

    The first seed is the object furthest from the mean of all centroids, each further one that with the largest sum
    of distances to the seeds so far.
    """
    relative = scene.centroids - scene.centroids.sum(axis=0) / len(scene)
    seed = int(ascending(-np.hypot(relative[:, 0], relative[:, 1]), scene.scale)[0])
    to_seeds: list[FloatArray] = []
    total = np.zeros(len(scene))
    while True:
        relative = scene.centroids - scene.centroids[seed]
        to_seeds.append(comparable(np.hypot(relative[:, 0], relative[:, 1]), scene.scale))
        if len(to_seeds) == count:
            return np.argmin(to_seeds, axis=0)
        total = total + to_seeds[-1]
        total[seed] = -np.inf
        seed = int(np.argmax(total))


def cluster_centres(scene: Scene, labels: IntArray) -> FloatArray:
    """(k, 2) mean centroid of each cluster [m]."""
    return np.array([scene.centroids[labels == k].mean(axis=0) for k in range(int(labels.max()) + 1)])
