"""What planned pushes would do, by the push physics."""

import numpy as np

from singulation_core import Arrangement, singulation_distance
from singulation_core.polygon import FloatArray
from singulation_core.push_world import simulate_pushes
from singulation_planner.candidates import Candidates
from singulation_planner.kernels.types import IntArray
from singulation_planner.policy import Task


def simulated_changes(task: Task, candidates: Candidates, chosen: IntArray, starts: FloatArray) -> FloatArray:
    """(k,) s' - s of the chosen candidates; NaN where the simulation failed.

    Args:
        task: scene, jaws and physics.
        candidates: m pushes.
        chosen: (k,) indices of the feasible ones.
        starts: (k, 2) their start points [m].
    """
    place = task.placer.push
    pushes = [
        place(target, start, direction)
        for target, start, direction in zip(
            candidates.objects[chosen].tolist(), starts, candidates.directions[chosen], strict=True
        )
    ]
    outcomes = simulate_pushes(task.scene.in_order(), pushes, task.physics, task.placer.geometry)
    return np.asarray(outcomes.gains())


def relative_gain(change: float, arrangement: Arrangement) -> float:
    """(s' - s) / s, with lengths in mean bounding radii of the arrangement; NaN if s is 0."""
    present = singulation_distance(arrangement)
    return change / present if present != 0.0 else float("nan")
