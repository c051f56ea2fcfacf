"""Center Object Removal: the object that keeps the others together, away from its two nearest (paper, section V-C)."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.candidates import Candidates, object_by_object
from singulation_planner.directions import COUNT, around, ascending, away, unit
from singulation_planner.policy import Task, policy
from singulation_planner.scene import Scene
from singulation_planner.selection import by_removal

_FORWARD = COUNT // 2 + 1  # directions within a right angle of the wanted one


@dataclass(frozen=True, slots=True)
class Options:
    """Readings of the paper.

    Attributes:
        direction: "away from the segment" between the two nearest: ``perpendicular`` to it, or from its
            ``closest_point``, which differs where the object lies beyond an end of the segment.
    """

    direction: Literal["perpendicular", "closest_point"] = "perpendicular"


@policy(Options)
def rank(task: Task, options: Options) -> Iterator[Candidates]:
    """Objects by the gain of their removal; for each the directions nearest to the wanted one."""
    return object_by_object(_fans(task.scene, options))


def _fans(scene: Scene, options: Options) -> Iterator[tuple[int, FloatArray, FloatArray]]:
    for index in by_removal(scene):
        directions = around(_away_from_segment(scene, index, options))
        yield index, directions[:_FORWARD], directions[_FORWARD:]


def _away_from_segment(scene: Scene, index: int, options: Options) -> FloatArray:
    """(2,) unit vector; where the object lies on the segment, the side away from all others decides."""
    offsets = np.delete(scene.centroids, index, axis=0) - scene.centroids[index]
    nearest = offsets[ascending(np.hypot(offsets[:, 0], offsets[:, 1]), scene.scale)[:2]]
    general = away(scene, index)
    segment = None if len(nearest) < 2 else unit(nearest[1] - nearest[0], scene)
    if segment is None:
        found = unit(-nearest[0], scene)
        return general if found is None else found
    across = np.array((-segment[1], segment[0]))
    if options.direction == "closest_point":
        along = float(np.clip(-nearest[0] @ segment, 0.0, (nearest[1] - nearest[0]) @ segment))
        found = unit(-(nearest[0] + along * segment), scene)
        if found is not None:
            return found
    side = -float(nearest[0] @ across)
    if abs(side) < 1e-6 * scene.scale:
        side = float(general @ across)
    return across if side >= 0.0 else -across
