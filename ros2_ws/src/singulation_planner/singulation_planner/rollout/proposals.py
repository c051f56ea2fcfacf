"""Which pushes are tried: a grid ordered by score, and variations of pushes that turned out well."""

from dataclasses import dataclass

import numpy as np

from singulation_core import ContactMode
from singulation_core.polygon import FloatArray
from singulation_planner.candidates import Candidates
from singulation_planner.directions import ascending, away
from singulation_planner.kernels.types import IntArray
from singulation_planner.placer import Placer
from singulation_planner.rollout.objective import Objective

_DIRECTIONS = 16
_LINES = np.linspace(-0.6, 0.6, 7)  # beside the centroid [bounding radii]
_GYRATION = 0.55  # radius of gyration of a block [bounding radii]


@dataclass(frozen=True, slots=True)
class Proposals:
    """Feasible pushes with their start points (m, 2) [m]."""

    candidates: Candidates
    starts: FloatArray

    def __len__(self) -> int:
        return len(self.starts)

    def part(self, chosen: slice | IntArray) -> "Proposals":
        """Those that a slice or indices choose."""
        one = self.candidates
        kept = Candidates(one.objects[chosen], one.directions[chosen], one.offsets[chosen])
        return Proposals(kept, self.starts[chosen])


def feasible(placer: Placer, candidates: Candidates) -> Proposals:
    """Those of the candidates that the pusher can perform."""
    chosen, starts = placer.feasible(candidates)
    kept = Candidates(candidates.objects[chosen], candidates.directions[chosen], candidates.offsets[chosen])
    return Proposals(kept, starts)


def by_score(placer: Placer, objective: Objective) -> Proposals:
    """All feasible pushes of the grid, best score first."""
    found = feasible(placer, _grid(placer))
    scores = objective.scores(found.candidates, _ways(placer, found.candidates))
    return found.part(ascending(-scores))


def _grid(placer: Placer) -> Candidates:
    scene = placer.scene
    count = len(scene)
    fan = 2.0 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    first = np.array([np.arctan2(*away(scene, index)[::-1]) for index in range(count)])
    angles = (first[:, None, None] + fan[:, None] + np.zeros(len(_LINES))).ravel()
    offsets = (scene.radii[:, None, None] * (np.zeros((_DIRECTIONS, 1)) + _LINES)).ravel()
    objects = np.repeat(np.arange(count), _DIRECTIONS * len(_LINES))
    return Candidates(objects, np.column_stack((np.cos(angles), np.sin(angles))), offsets)


def _ways(placer: Placer, candidates: Candidates) -> FloatArray:
    """How far the targets would go alone [m]: pushed beside its centroid, a block turns and lags behind."""
    after_contact = placer.travel - float(placer.pusher[3])
    if placer.mode is not ContactMode.SINGLE_POINT:
        return np.full(len(candidates.objects), after_contact)
    lever = candidates.offsets / (_GYRATION * placer.scene.radii[candidates.objects])
    return np.asarray(after_contact / (1.0 + lever**2))


def variations(placer: Placer, around: Candidates, width: float, count: int, random: np.random.Generator) -> Proposals:
    """Feasible random variations of one candidate: ``width`` 1 is a step of the grid."""
    target = int(around.objects[0])
    turns = width * 2.0 * np.pi / _DIRECTIONS * random.uniform(-1.0, 1.0, count)
    shifts = width * (_LINES[1] - _LINES[0]) * random.uniform(-1.0, 1.0, count)
    angles = np.arctan2(around.directions[0, 1], around.directions[0, 0]) + turns
    offsets = around.offsets[0] + shifts * placer.scene.radii[target]
    ways = np.column_stack((np.cos(angles), np.sin(angles)))
    return feasible(placer, Candidates(np.full(count, target), ways, offsets))
