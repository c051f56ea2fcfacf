"""The directions in which ClusterPush would push objects, ranked; what is computed and why is said in its module."""

import numpy as np

from singulation_core.jit import compiled_maker, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.compass import ascending, away, fan
from singulation_planner.kernels.scoring import cluster, path_distance_sums
from singulation_planner.kernels.types import IntArray

NEVER, LARGEST, MORE_THAN_THREE, BOTH = 0, 1, 2, 3
AWAY_FROM_ALL, AWAY_FROM_CLUSTER, AWAY_FROM_CLUSTERS = 0, 1, 2
DISTANT_DISKS, NEAR_CLUSTERS = 0, 1
_COUNT = 16  # directions of a push of one object (paper, algorithm 1)


@compiled_maker
def _centres(relative: FloatArray, labels: IntArray) -> FloatArray:
    """(k, 2) means of all clusters but that of the push object, which is the first."""
    count = labels.max()
    centres = np.zeros((count, 2))
    sizes = np.zeros(count)
    for i in range(len(labels)):
        if labels[i] > 0:
            centres[labels[i] - 1] += relative[i]
            sizes[labels[i] - 1] += 1.0
    for k in range(count):
        centres[k] /= sizes[k]
    return centres


@compiled_maker
def _pushes_two(labels: IntArray, rule: int) -> bool:
    """Whether case 1 applies; the push object is in cluster 0."""
    sizes = np.bincount(labels)
    if sizes[0] < 2 or rule == NEVER:
        return False
    largest, crowded = len(sizes) > 1 and sizes[0] == sizes.max(), sizes[0] > 3
    if rule == BOTH:
        return largest and crowded
    return largest if rule == LARGEST else crowded


@compiled_maker
def _towards_partners(relative: FloatArray, labels: IntArray, index: int, scale: float, rule: int) -> FloatArray:
    """(k, 2) directions to the other members of cluster 0, best first."""
    others = np.zeros(2)
    if rule == AWAY_FROM_CLUSTERS and labels.max() > 0:
        others += _centres(relative, labels).sum(axis=0)
    else:
        for i in range(len(labels)):
            if rule != AWAY_FROM_CLUSTER or labels[i] == 0:
                others += relative[i]
    partners = np.flatnonzero((labels == 0) & (np.arange(len(labels)) != index))
    directions, scores = np.empty((len(partners), 2)), np.empty(len(partners))
    for k in range(len(partners)):
        i = partners[k]
        length = np.sqrt(relative[i, 0] ** 2 + relative[i, 1] ** 2)
        directions[k] = relative[i] / length
        scores[k] = directions[k, 0] * others[0] + directions[k, 1] * others[1]
        if rule != AWAY_FROM_CLUSTERS:
            scores[k] -= length  # without the partner itself
    return directions[ascending(scores, scale)]


@compiled_maker
def _alone(
    centroids: FloatArray,
    radii: FloatArray,
    relative: FloatArray,
    labels: IntArray,
    index: int,
    scale: float,
    rules: IntArray,
) -> FloatArray:
    """(16, 2) directions of a push of one object, best first."""
    directions = fan(away(centroids, index, scale), _COUNT)
    if rules[3] == DISTANT_DISKS:
        sums = -path_distance_sums(centroids, radii, index, directions, rules[4], 0.0)
    else:
        points = np.concatenate((np.zeros((1, 2)), _centres(relative, labels)))
        sums = path_distance_sums(points, np.zeros(len(points)), 0, directions, rules[4], 0.0)
    return directions[ascending(sums, scale)]


@compiled_part
def _append(
    fan_of_one: FloatArray, good: int, index: int, targets: IntArray, directions: FloatArray, counts: IntArray
) -> None:
    """The first ``good`` directions to the good ones, the rest to the others."""
    for k in range(len(fan_of_one)):
        part = 0 if k < good else 1
        at = counts[part]
        targets[part, at] = index
        directions[part, at, 0], directions[part, at, 1] = fan_of_one[k, 0], fan_of_one[k, 1]
        counts[part] += 1


@compiled_maker
def ranked(
    centroids: FloatArray, radii: FloatArray, scale: float, objects: IntArray, rules: IntArray, partners: int, good: int
) -> tuple[IntArray, FloatArray, IntArray, FloatArray]:
    """Directions of several objects.

    Args:
        centroids, radii, scale: as in ``Scene``.
        objects: (m,) push objects.
        rules: clustering, case one, its direction, case two, path.
        partners, good: how many directions of case 1 and of case 2 are good.

    Returns:
        (k,) objects and (k, 2) directions of the good pushes, object by object, and the same of all others.
    """
    most = _COUNT + len(radii)
    targets = np.empty((2, len(objects) * most), dtype=np.int64)
    directions = np.empty((2, len(objects) * most, 2))
    counts = np.zeros(2, dtype=np.int64)
    for index in objects:
        relative = centroids - centroids[index]
        labels = cluster(centroids, radii, index, rules[0])
        if _pushes_two(labels, rules[1]):
            both = _towards_partners(relative, labels, index, scale, rules[2])
            _append(both, partners, index, targets, directions, counts)
        alone = _alone(centroids, radii, relative, labels, index, scale, rules)
        _append(alone, good, index, targets, directions, counts)
    return (
        targets[0, : counts[0]].copy(),
        directions[0, : counts[0]].copy(),
        targets[1, : counts[1]].copy(),
        directions[1, : counts[1]].copy(),
    )
