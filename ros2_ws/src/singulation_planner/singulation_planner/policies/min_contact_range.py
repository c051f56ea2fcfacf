"""Minimum Contact Range: the central object in the direction in which it meets others least (paper, section V-C)."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.candidates import Candidates, through_centroid
from singulation_planner.directions import COUNT, away, comparable, fan
from singulation_planner.kernels.sweep import obstructed_widths
from singulation_planner.policy import Task, policy
from singulation_planner.scene import Scene
from singulation_planner.selection import by_removal

_HALF, _QUARTER = COUNT // 2, COUNT // 4
_REACH = 4.0  # mean bounding radii ahead in which objects count


@dataclass(frozen=True, slots=True)
class Options:
    """Readings of the paper, which does not define the range.

    Attributes:
        contact_range: the ``width`` of the object across the push (as in the authors' code; of the two senses of
            such a direction the one away from the others first), or the width of its path that is ``obstructed``
            by others.
    """

    contact_range: Literal["width", "obstructed"] = "width"


@policy(Options)
def rank(task: Task, options: Options) -> Iterator[Candidates]:
    """Objects by the gain of their removal; for each the 16 directions by contact range."""
    order = _narrowest if options.contact_range == "width" else _least_obstructed
    for index in by_removal(task.scene):
        yield through_centroid(index, order(task.scene, index, fan(away(task.scene, index))))


def _narrowest(scene: Scene, index: int, directions: FloatArray) -> FloatArray:
    vertices = scene.vertices[scene.firsts[index] : scene.firsts[index + 1]]
    across = vertices @ np.array((-directions[:_HALF, 1], directions[:_HALF, 0]))
    axes = np.argsort(comparable(np.ptp(across, axis=0), scene.scale), kind="stable")
    forward = np.where(axes <= _QUARTER, axes, axes + _HALF)  # the sense within a right angle of directions[0]
    return directions[np.concatenate((forward, (forward + _HALF) % COUNT))]


def _least_obstructed(scene: Scene, index: int, directions: FloatArray) -> FloatArray:
    reach = _REACH * scene.scale
    widths = obstructed_widths(scene.centroids, scene.vertices, scene.firsts, index, directions, reach)
    agreement = directions @ directions[0]
    return directions[np.lexsort((-comparable(agreement, 1.0), comparable(widths, scene.scale)))]
