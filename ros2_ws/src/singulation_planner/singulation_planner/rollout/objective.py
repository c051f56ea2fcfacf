"""What a push is worth."""

from dataclasses import dataclass

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.kernels.discs import disc_scores
from singulation_planner.kernels.gaps import all_gaps, outcome_values
from singulation_planner.kernels.touching import touching
from singulation_planner.kernels.types import IntArray
from singulation_planner.rollout.options import WIDTH, Options
from singulation_planner.scene import Scene

# Of the change of s beside the clearance: among pushes that clear as much, the one that spreads more.
_SPREAD = 0.05
_RESERVE = 1.05  # planned gaps over asked ones: what is simulated is not quite what happens
_FLOOR = 0.05  # smallest distance that counts [mean bounding radii], as in the singulation distance


@dataclass(frozen=True, slots=True)
class Objective:
    """Values of pushes of one scene.

    Attributes:
        scene: the blocks.
        weights: of the change of s and of the mean clearance.
        width: gap beyond which no clearance is gained [m].
        gaps: (n, n) between the outlines [m].
        outlines: (v, 2) vertices around their centroids [m].
        planes, arms, gyrations: from ``touching``.
        counted: (n,) 1 for blocks whose distances count in the change of s, else 0. Of a clearance, those that lack
            it: else blocks that are free long since would be spread for ever.
    """

    scene: Scene
    weights: FloatArray
    width: float
    gaps: FloatArray
    outlines: FloatArray
    planes: FloatArray
    arms: FloatArray
    gyrations: FloatArray
    counted: FloatArray

    def scores(self, objects: IntArray, directions: FloatArray, paths: FloatArray, friction: float) -> FloatArray:
        """(m,) values of pushes if blocks did not turn and the push objects (m,) went along ``paths`` (m, k, 2) [m]."""
        scores = np.empty(len(objects))
        scene = self.scene
        disc_scores(
            scene.centroids,
            self.gaps,
            self.planes,
            self.arms,
            self.gyrations,
            objects,
            directions,
            paths,
            self.counted,
            scene.scale,
            self.width,
            self.weights,
            friction,
            scores,
        )
        return scores

    def values(self, before: FloatArray, poses: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(m,) values, and (m,) changes of s, of pushes that lead from ``before`` (n, 3) to ``poses`` (m, n, 3)."""
        scene = self.scene
        changes, spreads, clearances = np.empty((3, len(poses)))
        width = self.width if self.weights[1] > 0.0 else 0.0
        floor = _FLOOR * scene.scale
        outcome_values(
            self.outlines,
            scene.firsts,
            scene.radii,
            self.gaps,
            before,
            poses,
            self.counted,
            width,
            floor,
            changes,
            spreads,
            clearances,
        )
        return self.weights[0] * spreads + self.weights[1] * clearances, changes


def make_objective(scene: Scene, options: Options) -> Objective:
    """Objective that the options ask for."""
    weights = np.array((_SPREAD, 1.0) if options.objective == "clearance" else (1.0, 0.0))
    owners: IntArray = np.repeat(np.arange(len(scene)), np.diff(scene.firsts))
    gaps, edges = all_gaps(scene.vertices, scene.firsts)
    width = _RESERVE * (options.clearance_width or WIDTH * scene.scale)
    return Objective(
        scene,
        weights,
        width,
        gaps,
        scene.vertices - scene.centroids[owners],
        *touching(scene.centroids, scene.vertices, scene.firsts, edges, scene.scale),
        (gaps.min(axis=1) < width if weights[1] > 0.0 else np.ones(len(scene))).astype(np.float64),
    )
