"""ClusterPush: the central object, alone or with a neighbour, away from the rest (paper, section IV).

The paper's text, its algorithm 1 and its formulas disagree in places. Each open place is an option whose default is
the reading that separated best in rollouts over 2080 random scenes.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from singulation_planner.candidates import Candidates, through_centroid
from singulation_planner.kernels import cluster_fans as fans
from singulation_planner.kernels import scoring
from singulation_planner.kernels.types import IntArray
from singulation_planner.policy import Task, policy
from singulation_planner.selection import by_connectivity, by_removal

# Of clustering, case one, its direction, case two, path.
_CODES = (
    {"seed_disc": scoring.FIXED_DISC, "any_member": scoring.ANY_MEMBER, "growing_disc": scoring.GROWING_DISC},
    {"both": fans.BOTH, "largest": fans.LARGEST, "more_than_three": fans.MORE_THAN_THREE, "never": fans.NEVER},
    {
        "away_from_all": fans.AWAY_FROM_ALL,
        "away_from_cluster": fans.AWAY_FROM_CLUSTER,
        "away_from_clusters": fans.AWAY_FROM_CLUSTERS,
    },
    {"distant_disks": fans.DISTANT_DISKS, "near_clusters": fans.NEAR_CLUSTERS},
    {"ray": scoring.RAY, "line": scoring.LINE},
)
# How many are tried before the next object: the fifth best direction of one leads back into the clutter more often than
# the best of the next (in rollouts 1 % of brute force).
_PARTNERS, _GOOD = 2, 4
_PORTION = 4  # objects ranked at once; then twice as many, and so on


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
    scene, rules = task.scene, _rules(options)
    order = by_removal(scene) if options.push_object == "log_distance" else by_connectivity(scene)
    others, begin, count = [], 0, _PORTION
    while begin < len(order):
        objects = np.array(order[begin : begin + count])
        targets, directions, other_targets, other_directions = fans.ranked(
            scene.centroids, scene.radii, scene.scale, objects, rules, _PARTNERS, _GOOD
        )
        yield through_centroid(targets, directions)
        others.append(through_centroid(other_targets, other_directions))
        begin, count = begin + count, 2 * count
    yield from others


@lru_cache(maxsize=16)
def _rules(options: Options) -> IntArray:
    names = (options.clustering, options.case_one, options.case_one_direction, options.case_two, options.path)
    return np.array([codes[name] for codes, name in zip(_CODES, names, strict=True)])
