"""Boundary Shear: one of the two closest objects along the boundary between them, towards free space (paper, V-B)."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from singulation_core.polygon import FloatArray, inward_half_planes
from singulation_planner.candidates import Candidates, through_centroid
from singulation_planner.directions import comparable
from singulation_planner.kernels.sweep import free_travel
from singulation_planner.policy import Task, policy
from singulation_planner.scene import Scene

_FAR = 4.0  # mean bounding radii; space beyond does not make a direction freer


@dataclass(frozen=True, slots=True)
class Options:
    """Readings of the paper.

    Attributes:
        closeness: of two objects: distance of their ``centroids``, or gap between their bounding ``circles``.
        boundary: the direction ``perpendicular`` to the line of centroids, or that of the ``face`` which separates
            the two; the first did slightly better.
    """

    closeness: Literal["centroids", "circles"] = "centroids"
    boundary: Literal["perpendicular", "face"] = "perpendicular"


@policy(Options)
def rank(task: Task, options: Options) -> Iterator[Candidates]:
    """Pairs, closest first; of each the four pushes (either object, both ways), that with most free space first."""
    for one, other in _closest_pairs(task.scene, options):
        yield _shears(task.scene, one, other, options)


def _closest_pairs(scene: Scene, options: Options) -> list[tuple[int, int]]:
    """The 3 n closest pairs: not more can be neighbours in the plane."""
    first, second = np.triu_indices(len(scene), 1)
    difference = scene.centroids[first] - scene.centroids[second]
    distances = np.hypot(difference[:, 0], difference[:, 1])
    if options.closeness == "circles":
        distances = distances - scene.radii[first] - scene.radii[second]
    order = np.argsort(comparable(distances, scene.scale), kind="stable")[: 3 * len(scene)]
    return list(zip(first[order].tolist(), second[order].tolist(), strict=True))


def _shears(scene: Scene, one: int, other: int, options: Options) -> Candidates:
    along = _face(scene, one, other) if options.boundary == "face" else scene.centroids[other] - scene.centroids[one]
    if options.boundary == "perpendicular":
        along = np.array((-along[1], along[0])) / np.hypot(along[0], along[1])
    objects = np.array((one, one, other, other))
    directions = np.array((along, -along, along, -along))
    partners = (other, other, one, one)
    shape = scene.centroids, scene.radii, scene.vertices, scene.firsts
    free = [
        free_travel(*shape, int(index), partner, x, y, _FAR * scene.scale)
        for index, partner, (x, y) in zip(objects, partners, directions.tolist(), strict=True)
    ]
    outwards = ((scene.centroids[objects] - scene.centroids.sum(axis=0) / len(scene)) * directions).sum(axis=1)
    order = np.lexsort((-comparable(outwards, scene.scale), -comparable(np.array(free), scene.scale)))
    return through_centroid(objects[order], directions[order])


def _face(scene: Scene, one: int, other: int) -> FloatArray:
    """Unit direction of the edge of either outline that separates the two best."""
    best, found = -np.inf, np.zeros(2)
    outlines = [scene.vertices[scene.firsts[k] : scene.firsts[k + 1]] for k in (one, other)]
    for own, opposite in (outlines, outlines[::-1]):
        normals, limits = inward_half_planes(own)
        gaps = comparable((limits[:, None] - normals @ opposite.T).min(axis=1), scene.scale)
        edge = int(np.argmax(gaps))
        if gaps[edge] > best:
            best, found = float(gaps[edge]), np.array((-normals[edge, 1], normals[edge, 0]))
    return found
