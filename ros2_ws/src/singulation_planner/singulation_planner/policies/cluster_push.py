"""ClusterPush: the central object, alone or with a neighbour, away from the rest (paper, section IV).

The paper's text, its algorithm 1 and its formulas disagree in places. Each open place is an option whose default is
the reading that separated best in rollouts over 2080 random scenes.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.candidates import Candidates, object_by_object
from singulation_planner.directions import ascending, away, fan
from singulation_planner.kernels import scoring
from singulation_planner.kernels.types import IntArray
from singulation_planner.policy import Task, policy
from singulation_planner.scene import Scene
from singulation_planner.selection import by_connectivity, by_removal

_CLUSTERING = {
    "seed_disc": scoring.FIXED_DISC,
    "any_member": scoring.ANY_MEMBER,
    "growing_disc": scoring.GROWING_DISC,
}
# How many are tried before the next object: the fifth best direction of one leads back into the clutter more often than
# the best of the next (in rollouts 1 % of brute force).
_PARTNERS, _GOOD = 2, 4
_PATHS = {"ray": scoring.RAY, "line": scoring.LINE}


@dataclass(frozen=True, slots=True)
class Options:
    """Readings of the paper.

    Attributes:
        push_object: the connectivity score sums distances to the other objects (``distance``, the paper's formula)
            or their logarithms (``log_distance``). It shall find the object "that if removed would most increase"
            how far apart the others are, and that is measured in logarithms (definition 1); it also is better, in
            dense clutter by 2 % of brute force.
        clustering: what a cluster reaches. ``seed_disc``: everything that its seed's bounding circle meets;
            ``any_member``: also what its members' circles meet; ``growing_disc``: a disc around the seed that grows
            with each member. In touching clutter the last two put everything into one cluster, and case 1 never
            occurs.
        case_one: when two objects are pushed at once. ``largest``: the cluster of the push object is the largest
            and not the only one (algorithm 1); ``more_than_three``: it has more than three objects (text);
            ``both``: the two criteria together, which is best; ``never``.
        case_one_direction: the partner in the cluster whose direction leaves the others behind most.
            ``away_from_all``: smallest signed sum of projections of all other centroids (the text says of the
            cluster's, ``away_from_cluster``; all of them are better); ``away_from_clusters``: the direction that
            agrees best with the one away from the centroids of the other clusters (algorithm 1, lines 4 to 7).
        case_two: the direction of a push of one object. ``distant_disks``: the largest sum of distances of the
            other objects' disks to the path (text); ``near_clusters``: the smallest sum of distances of the other
            clusters' centroids (algorithm 1, line 16), which pushes towards them; with one cluster it has nothing
            to sum.
        path: of case 2: the ``ray`` from the push object, or the infinite ``line``, on which both signs tie.
    """

    push_object: Literal["log_distance", "distance"] = "log_distance"
    clustering: Literal["seed_disc", "any_member", "growing_disc"] = "seed_disc"
    case_one: Literal["both", "largest", "more_than_three", "never"] = "both"
    case_one_direction: Literal["away_from_all", "away_from_cluster", "away_from_clusters"] = "away_from_all"
    case_two: Literal["distant_disks", "near_clusters"] = "distant_disks"
    path: Literal["ray", "line"] = "ray"


@policy(Options)
def rank(task: Task, options: Options) -> Iterator[Candidates]:
    """Objects by connectivity score; for each the best partners of case 1, then the best directions of case 2."""
    return object_by_object(_fans(task.scene, options))


def _fans(scene: Scene, options: Options) -> Iterator[tuple[int, FloatArray, FloatArray]]:
    order = by_removal if options.push_object == "log_distance" else by_connectivity
    for index in order(scene):
        labels = scoring.cluster(scene.centroids, scene.radii, index, _CLUSTERING[options.clustering])
        single = _single_directions(scene, index, labels, options)
        if _pushes_two(labels, options):
            both = _towards_partners(scene, index, labels, options)
            good = np.concatenate((both[:_PARTNERS], single[:_GOOD]))
            yield index, good, np.concatenate((both[_PARTNERS:], single[_GOOD:]))
        else:
            yield index, single[:_GOOD], single[_GOOD:]


def _pushes_two(labels: IntArray, options: Options) -> bool:
    """Whether case 1 applies; the push object is in cluster 0."""
    sizes = np.bincount(labels)
    if sizes[0] < 2 or options.case_one == "never":
        return False
    largest = len(sizes) > 1 and sizes[0] == sizes.max()
    crowded = bool(sizes[0] > 3)
    return {"both": largest and crowded, "largest": largest, "more_than_three": crowded}[options.case_one]


def _towards_partners(scene: Scene, index: int, labels: IntArray, options: Options) -> FloatArray:
    """(k, 2) directions to the other members of cluster 0, best first."""
    relative = scene.centroids - scene.centroids[index]
    partners = np.flatnonzero(labels == 0)
    partners = partners[partners != index]
    lengths = np.hypot(relative[partners, 0], relative[partners, 1])
    directions = relative[partners] / lengths[:, None]
    if options.case_one_direction == "away_from_clusters":
        centres = [relative[labels == k].mean(axis=0) for k in range(1, int(labels.max()) + 1)]
        scores = directions @ np.sum(centres, axis=0) if centres else directions @ relative.sum(axis=0)
    else:
        others = relative if options.case_one_direction == "away_from_all" else relative[labels == 0]
        scores = directions @ others.sum(axis=0) - lengths  # without the partner itself
    return directions[ascending(scores, scene.scale)]


def _single_directions(scene: Scene, index: int, labels: IntArray, options: Options) -> FloatArray:
    """(16, 2) directions, best first."""
    directions = fan(away(scene, index))
    path = _PATHS[options.path]
    if options.case_two == "distant_disks":
        sums = -scoring.path_distance_sums(scene.centroids, scene.radii, index, directions, path, 0.0)
    else:
        centres = [scene.centroids[labels == k].mean(axis=0) for k in range(1, int(labels.max()) + 1)]
        points = np.array([scene.centroids[index], *centres])
        sums = scoring.path_distance_sums(points, np.zeros(len(points)), 0, directions, path, 0.0)
    return directions[ascending(sums, scene.scale)]
