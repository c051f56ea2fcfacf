"""What a push is worth."""

from dataclasses import dataclass

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_planner.candidates import Candidates
from singulation_planner.kernels.discs import disc_scores
from singulation_planner.kernels.gaps import all_gaps, mean_clearances
from singulation_planner.kernels.types import IntArray
from singulation_planner.rollout.options import WIDTH, Options
from singulation_planner.scene import Scene

# Of the change of s beside the clearance: among pushes that clear as much, the one that spreads more.
_SPREAD = 0.05
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
    """

    scene: Scene
    weights: FloatArray
    width: float
    gaps: FloatArray
    outlines: FloatArray

    def scores(self, candidates: Candidates, ways: FloatArray) -> FloatArray:
        """(m,) values if blocks were discs; ``ways`` (m,): how far the target would go alone [m]."""
        scores = np.empty(len(ways))
        scene = self.scene
        disc_scores(
            scene.centroids,
            self.gaps,
            candidates.objects,
            candidates.directions,
            ways,
            scene.scale,
            self.width,
            self.weights,
            scores,
        )
        return scores

    def values(self, poses: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(m,) values, and (m,) changes of s, of pushes that lead to ``poses`` (m, n, 3); NaN stays NaN."""
        changes = _log_distances(poses[..., :2], self.scene.scale) - _log_distances(
            self.scene.centroids, self.scene.scale
        )
        return self.weights[0] * changes + self.weights[1] * self._clearances(poses), changes

    def _clearances(self, poses: FloatArray) -> FloatArray:
        values = np.zeros(len(poses))
        if self.weights[1] != 0.0:
            scene = self.scene
            mean_clearances(
                self.outlines, scene.firsts, scene.centroids, scene.radii, self.gaps, poses, self.width, values
            )
        return values


def make_objective(scene: Scene, options: Options) -> Objective:
    """Objective that the options ask for."""
    weights = np.array((_SPREAD, 1.0) if options.objective == "clearance" else (1.0, 0.0))
    owners: IntArray = np.repeat(np.arange(len(scene)), np.diff(scene.firsts))
    return Objective(
        scene,
        weights,
        options.clearance_width or WIDTH * scene.scale,
        all_gaps(scene.vertices, scene.firsts),
        scene.vertices - scene.centroids[owners],
    )


def _log_distances(points: FloatArray, scale: float) -> FloatArray:
    first, second = np.triu_indices(points.shape[-2], 1)
    apart = points[..., first, :] - points[..., second, :]
    return np.asarray(np.log(np.maximum(np.hypot(apart[..., 0], apart[..., 1]), _FLOOR * scale)).mean(axis=-1))
