"""Cluster Diffusion: one object away from the centre of the clutter towards free space (paper, section V-B)."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.candidates import Candidates, through_centroid
from singulation_planner.directions import COUNT, around, away, comparable, unit
from singulation_planner.kernels.sweep import free_travel
from singulation_planner.policy import Task, policy
from singulation_planner.scene import Scene
from singulation_planner.selection import cluster_centres, clusters_around_seeds

_FAR = 4.0  # mean bounding radii; space beyond does not make a direction freer


@dataclass(frozen=True, slots=True)
class Options:
    """Readings of the paper.

    Attributes:
        centre: of ``all`` objects, or of ``clusters`` of about three, each object moving away from its own (as the
            authors' code does).
        equally_free: which of several objects with free way goes first: the ``nearest`` to the centre, which
            separates more, or the ``farthest``.
    """

    centre: Literal["all", "clusters"] = "all"
    equally_free: Literal["nearest", "farthest"] = "nearest"


@policy(Options)
def rank(task: Task, options: Options) -> Iterator[Candidates]:
    """Objects by the free space in front of them; then the same with ever larger deviations from "outward"."""
    scene = task.scene
    outward, distances = _outward(scene, options)
    nearness = comparable(distances, scene.scale) * (1.0 if options.equally_free == "nearest" else -1.0)
    fans = np.array([around(direction) for direction in outward])
    for deviation in range(COUNT):
        directions = np.ascontiguousarray(fans[:, deviation])
        order = np.lexsort((nearness, -comparable(_free(scene, directions), scene.scale)))
        yield through_centroid(order, directions[order])


def _outward(scene: Scene, options: Options) -> tuple[FloatArray, FloatArray]:
    """(n, 2) unit vectors away from the centre and (n,) distances to it [m]."""
    if options.centre == "clusters":
        labels = clusters_around_seeds(scene, (len(scene) - 1) // 3 + 1)
        relative = scene.centroids - cluster_centres(scene, labels)[labels]
    else:
        relative = scene.centroids - scene.centroids.sum(axis=0) / len(scene)
    found = (unit(vector, scene) for vector in relative)
    directions = [away(scene, index) if vector is None else vector for index, vector in enumerate(found)]
    return np.array(directions), np.hypot(relative[:, 0], relative[:, 1])


def _free(scene: Scene, directions: FloatArray) -> FloatArray:
    shape, limit = (scene.centroids, scene.radii, scene.vertices, scene.firsts), _FAR * scene.scale
    return np.array([free_travel(*shape, k, -1, x, y, limit) for k, (x, y) in enumerate(directions.tolist())])
