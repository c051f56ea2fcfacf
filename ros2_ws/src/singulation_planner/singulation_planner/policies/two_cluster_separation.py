"""Two Cluster Separation: the objects fall into two clusters, and one is pushed between them (paper, section V-C)."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.candidates import Candidates, object_by_object
from singulation_planner.directions import COUNT, around, away, unit
from singulation_planner.kernels.types import IntArray
from singulation_planner.policy import Task, policy
from singulation_planner.scene import Scene
from singulation_planner.selection import by_removal, cluster_centres, clusters_around_seeds

_FORWARD = COUNT // 2 + 1  # directions within a right angle of the wanted one


@dataclass(frozen=True, slots=True)
class Options:
    """Readings of the paper.

    Attributes:
        towards: ``other_cluster``: the object whose removal gains most, to the centre of the cluster that it is not
            in (text); ``own_cluster``: an object of the larger cluster through the centre of its own cluster, where
            that points away from the other one (authors' code).
    """

    towards: Literal["other_cluster", "own_cluster"] = "other_cluster"


@policy(Options)
def rank(task: Task, options: Options) -> Iterator[Candidates]:
    """One direction for each object, in the order of the reading; then the same with larger and larger deviations."""
    return object_by_object(_fans(task.scene, options))


def _fans(scene: Scene, options: Options) -> Iterator[tuple[int, FloatArray, FloatArray]]:
    labels = clusters_around_seeds(scene, 2)
    centres = cluster_centres(scene, labels)
    goals = centres[1 - labels if options.towards == "other_cluster" else labels]
    for index in _order(scene, labels, options):
        wanted = unit(goals[index] - scene.centroids[index], scene)
        directions = around(away(scene, index) if wanted is None else wanted)
        yield index, directions[:_FORWARD], directions[_FORWARD:]


def _order(scene: Scene, labels: IntArray, options: Options) -> list[int]:
    if options.towards == "other_cluster":
        return by_removal(scene)
    centres = cluster_centres(scene, labels)
    apart = (centres - centres[::-1])[labels]
    inwards = centres[labels] - scene.centroids
    lengths = np.hypot(inwards[:, 0], inwards[:, 1]) * np.hypot(apart[:, 0], apart[:, 1])
    agreement = (inwards * apart).sum(axis=1) / np.maximum(lengths, 1e-12 * scene.scale**2)
    sizes = np.bincount(labels)[labels]
    return np.lexsort((-np.round(agreement, 9), -sizes)).tolist()
