"""Brute Force: a large grid of pushes, each simulated; the best one is taken (paper, section V-B)."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from singulation_core import InvalidInputError
from singulation_core.polygon import FloatArray
from singulation_planner.candidates import Candidates
from singulation_planner.directions import away
from singulation_planner.placer import NOT_SIMULATED
from singulation_planner.policy import Task, policy
from singulation_planner.rollouts import relative_gain, simulated_changes

_WIDEST = 0.9  # bounding radii; a line further out hardly moves its object


@dataclass(frozen=True, slots=True)
class Options:
    """The grid.

    Attributes:
        grid: ``offsets``: parallel lines from -0.9 to 0.9 bounding radii beside the centroid for each direction
            (text; an even number of them leaves the centroid itself out); ``chords``: from each to each other of
            equally spaced points of the bounding circle (authors' code).
        directions: how many of them, or points on the circle.
        offsets: how many lines for each direction.
        max_objects: larger scenes are refused: n^2 work, many minutes for a thousand objects.
    """

    grid: Literal["offsets", "chords"] = "offsets"
    directions: int = 16
    offsets: int = 16
    max_objects: int = 60


@policy(Options)
def rank(task: Task, options: Options) -> Iterator[Candidates]:
    """All feasible pushes of the grid by simulated s' - s, best first.

    Raises:
        InvalidInputError: more objects than ``max_objects``.
    """
    scene = task.scene
    if len(scene) > options.max_objects:
        raise InvalidInputError(
            f"brute_force: {len(scene)} objects, at most {options.max_objects} (option max_objects) are simulated"
        )
    candidates = _grid(task, options)
    chosen, starts = task.placer.feasible(candidates)
    if not len(chosen):
        return
    changes = simulated_changes(task, candidates, chosen, starts)
    order = np.argsort(-np.nan_to_num(changes, nan=-np.inf), kind="stable")
    order = order[np.isfinite(changes[order])]
    task.placer.rejected[NOT_SIMULATED] += len(chosen) - len(order)
    best = chosen[order]
    gains = changes[order] * relative_gain(1.0, scene.in_order())
    yield Candidates(candidates.objects[best], candidates.directions[best], candidates.offsets[best], gains)


def _grid(task: Task, options: Options) -> Candidates:
    scene = task.scene
    angles, lines = _chords(options.directions) if options.grid == "chords" else _parallels(options)
    objects = np.repeat(np.arange(len(scene)), len(angles))
    first = np.array([np.arctan2(*away(scene, index)[::-1]) for index in range(len(scene))])
    turned = (first[:, None] + angles).ravel()
    offsets = (scene.radii[:, None] * lines).ravel()
    return Candidates(objects, np.column_stack((np.cos(turned), np.sin(turned))), offsets)


def _parallels(options: Options) -> tuple[FloatArray, FloatArray]:
    """Angles [rad] and offsets [bounding radii] of the lines of one object."""
    angles = 2.0 * np.pi * np.arange(options.directions) / options.directions
    lines = np.linspace(-_WIDEST, _WIDEST, options.offsets) if options.offsets > 1 else np.zeros(1)
    return np.repeat(angles, options.offsets), np.tile(lines, options.directions)


def _chords(count: int) -> tuple[FloatArray, FloatArray]:
    """The same for the chords between ``count`` points of the unit circle."""
    angles = 2.0 * np.pi * np.arange(count) / count
    points = np.column_stack((np.cos(angles), np.sin(angles)))
    start, end = (points[index] for index in np.nonzero(~np.eye(count, dtype=np.bool_)))
    ahead = end - start
    ahead /= np.hypot(ahead[:, 0], ahead[:, 1])[:, None]
    return np.arctan2(ahead[:, 1], ahead[:, 0]), ahead[:, 0] * start[:, 1] - ahead[:, 1] * start[:, 0]
