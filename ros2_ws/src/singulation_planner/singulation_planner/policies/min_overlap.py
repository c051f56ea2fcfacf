"""Minimum Overlap: the central object along the path that keeps furthest from the others (paper, section V-C)."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from singulation_planner.candidates import Candidates, through_centroid
from singulation_planner.directions import ascending, away, fan
from singulation_planner.kernels import scoring
from singulation_planner.policy import Task, policy
from singulation_planner.selection import by_removal

_PATHS = {"ray": scoring.RAY, "segment": scoring.SEGMENT, "line": scoring.LINE}


@dataclass(frozen=True, slots=True)
class Options:
    """Readings of the paper.

    Attributes:
        path: "the push line segment": the ``ray`` from the object, the ``segment`` that it would travel, or the
            infinite ``line``, on which both senses tie and which did far worse.
    """

    path: Literal["ray", "segment", "line"] = "ray"


@policy(Options)
def rank(task: Task, options: Options) -> Iterator[Candidates]:
    """Objects by the gain of their removal; for each 16 directions by the sum of distances to the others' centroids."""
    scene, path = task.scene, _PATHS[options.path]
    points = np.zeros(len(scene))
    for index in by_removal(scene):
        directions = fan(away(scene, index))
        sums = scoring.path_distance_sums(scene.centroids, points, index, directions, path, task.placer.travel)
        yield through_centroid(index, directions[ascending(-sums, scene.scale)])
