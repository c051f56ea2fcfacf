"""Which pushes are tried: a grid ordered by score, and variations of pushes that turned out well."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from singulation_core import ContactMode
from singulation_core.polygon import FloatArray
from singulation_planner.candidates import Candidates
from singulation_planner.directions import ascending
from singulation_planner.kernels.alone import paths_alone
from singulation_planner.kernels.compass import fans
from singulation_planner.kernels.types import IntArray
from singulation_planner.placer import Placer
from singulation_planner.rollout.objective import Objective

_DIRECTIONS = 16
# Lines beside the centroid [bounding radii]: for all directions, and for those that look best on these.
_LINES, _MORE_LINES = np.array((0.0, -0.3, 0.3)), np.array((-0.15, 0.15, -0.45, 0.45, -0.6, 0.6, -0.75, 0.75))
_PROMISING = 30  # directions, of all objects together, that get more lines
_LINE_DISTANCE = 0.15  # of two lines of one direction [bounding radii]
_STEPS, _TIP_FRICTION = 3, 0.5  # of the paths that the score assumes
# Of blocks that touch. The pushes with the best scores are scored again with less and with more of it, and the mean
# counts: the best of many estimates owes some of that to its errors.
_FRICTION, _FRICTIONS = 0.35, (0.2, 0.35, 0.6)
_SCORED_AGAIN = 24


@dataclass(frozen=True, slots=True)
class Proposals:
    """Feasible pushes with their start points (m, 2) [m]."""

    candidates: Candidates
    starts: FloatArray

    def __len__(self) -> int:
        return len(self.starts)

    def part(self, chosen: slice | IntArray) -> "Proposals":
        """Those that a slice or indices choose."""
        objects, directions, offsets, *_ = self.candidates
        return Proposals(Candidates(objects[chosen], directions[chosen], offsets[chosen]), self.starts[chosen])

    def and_then(self, others: Self) -> "Proposals":
        """These and the others."""
        one, other = self.candidates, others.candidates
        both = Candidates(
            np.concatenate((one.objects, other.objects)),
            np.concatenate((one.directions, other.directions)),
            np.concatenate((one.offsets, other.offsets)),
        )
        return Proposals(both, np.concatenate((self.starts, others.starts)))


def feasible(placer: Placer, candidates: Candidates) -> tuple[Proposals, IntArray]:
    """Those of the candidates that the pusher can perform, and their indices."""
    chosen, starts = placer.feasible(candidates)
    kept = Candidates(candidates.objects[chosen], candidates.directions[chosen], candidates.offsets[chosen])
    return Proposals(kept, starts), chosen


def by_score(placer: Placer, objective: Objective) -> Proposals:
    """All feasible pushes of the grid, best score first; where the scores are best, the grid is finer."""
    scene = placer.scene
    ways = fans(scene.centroids, _DIRECTIONS, scene.scale)
    objects = np.repeat(np.arange(len(scene)), _DIRECTIONS)
    coarse, rows = feasible(placer, _on_lines(placer, objects, ways, _LINES))
    scores = _scores(placer, objective, coarse)
    if len(ways) > _PROMISING and len(scores):
        best_first = dict.fromkeys((rows[ascending(-scores)] // len(_LINES)).tolist())
        finer = list(best_first)[:_PROMISING]
        objects, ways = objects[finer], ways[finer]
    fine, _ = feasible(placer, _on_lines(placer, objects, ways, _MORE_LINES))
    scores = np.concatenate((scores, _scores(placer, objective, fine)))
    ranked = coarse.and_then(fine).part(ascending(-scores))
    best, rest = ranked.part(slice(_SCORED_AGAIN)), ranked.part(slice(_SCORED_AGAIN, None))
    return best.part(ascending(-_scores(placer, objective, best, _FRICTIONS))).and_then(rest)


def _on_lines(placer: Placer, objects: IntArray, ways: FloatArray, lines: FloatArray) -> Candidates:
    """For each object and direction the pushes along all lines."""
    offsets = placer.scene.radii[objects, np.newaxis] * lines
    return Candidates(objects.repeat(len(lines)), ways.repeat(len(lines), axis=0), offsets.ravel())


def _scores(
    placer: Placer, objective: Objective, proposals: Proposals, frictions: Sequence[float] = (_FRICTION,)
) -> FloatArray:
    """(m,) mean scores over the frictions."""
    one, paths = proposals.candidates, _paths(placer, objective, proposals)
    found = [objective.scores(one.objects, one.directions, paths, friction) for friction in frictions]
    return np.asarray(sum(found) / len(found))


def _paths(placer: Placer, objective: Objective, proposals: Proposals) -> FloatArray:
    """(m, k, 2) displacements of the push objects [m] if nothing else were there."""
    scene, one = placer.scene, proposals.candidates
    if placer.mode is not ContactMode.SINGLE_POINT:  # wide contacts hold their object
        shares = np.arange(1, _STEPS + 1) / _STEPS
        way = placer.travel - float(placer.pusher[3])
        return np.asarray(way * one.directions[:, np.newaxis] * shares[:, np.newaxis])
    paths = np.empty((len(proposals), _STEPS, 2))
    paths_alone(
        scene.centroids,
        scene.vertices,
        scene.firsts,
        objective.gyrations,
        one.objects,
        proposals.starts,
        one.directions,
        float(placer.pusher[0]),
        placer.travel,
        _TIP_FRICTION,
        paths,
    )
    return paths


def variations(placer: Placer, around: Candidates, width: float, count: int, random: np.random.Generator) -> Proposals:
    """Feasible random variations of one candidate: ``width`` 1 is half a direction and two lines of the grid."""
    target = int(around.objects[0])
    turns, shifts = width * random.uniform(-1.0, 1.0, (2, count))
    angles = np.arctan2(around.directions[0, 1], around.directions[0, 0]) + turns * np.pi / _DIRECTIONS
    offsets = around.offsets[0] + 2.0 * _LINE_DISTANCE * shifts * placer.scene.radii[target]
    ways = np.column_stack((np.cos(angles), np.sin(angles)))
    return feasible(placer, Candidates(np.full(count, target), ways, offsets))[0]
