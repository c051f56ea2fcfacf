"""Splitting a face that holds several touching blocks: the cheapest set of cuts that leaves convex pieces."""

from dataclasses import dataclass

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.cutting import both_pieces, concave_cost, judged, seam_line
from singulation_perception.outlines import simplified
from singulation_perception.rings import Scale
from singulation_perception.seams import SeamCosts, candidates, corner_tolerance, corners_of_ring

_COSTS = SeamCosts()
_DEEPEST = 4  # cuts after one another
_BRANCHES = 5  # cuts looked at closely
_CONVEX = 0.005  # [m] cost of a ring that is left alone


@dataclass(frozen=True, eq=False)
class Split:
    """Pieces of a ring.

    Args:
        cost: of the cuts and of what remains concave [m].
        pieces: rings.
        cuts: both ends of each cut, (2, 2) [m].
        rivals: for each cut, how much dearer the next best way to cut was [m].
    """

    cost: float
    pieces: tuple[FloatArray, ...]
    cuts: tuple[FloatArray, ...] = ()
    rivals: tuple[float, ...] = ()


def split(ring: FloatArray, scale: Scale, depth: int = _DEEPEST) -> Split:
    """Branch and bound over the cuts that the outline suggests.

    Args:
        ring: (m, 2) rim of a face, counter-clockwise [m].
        scale: of the cloud.
        depth: most cuts after one another.
    """
    uncut = Split(concave_cost(ring, scale.roughness), (ring,))
    if depth == 0 or uncut.cost < _CONVEX:
        return uncut
    polygon = simplified(ring, corner_tolerance(scale))
    if len(polygon) < 4:
        return uncut
    corners = corners_of_ring(ring, polygon)
    cuts = candidates(
        ring, corners.index, corners.lines, corners.length, scale.pitch,
        _COSTS.open_end, _COSTS.corner_end, _COSTS.bend, _COSTS.neck,
    )  # fmt: skip
    costs = judged(
        ring, cuts, corners.index, corners.lines, corners.fitted, scale,
        _COSTS.cut, _COSTS.length, _COSTS.thin, _COSTS.thin_width,
    )  # fmt: skip
    best, second = uncut, np.inf
    for k in np.argsort(costs[:, 1])[:_BRANCHES]:
        if not (costs[k, 0] < best.cost):
            continue
        i, j = int(cuts[k, 0]), int(cuts[k, 1])
        line = seam_line(ring, cuts[k], corners.index, corners.lines, corners.fitted, scale)
        parts = [split(part, scale, depth - 1) for part in both_pieces(ring, i, j, line, scale)]
        cost = float(costs[k, 0]) + sum(part.cost for part in parts)
        if cost < best.cost:
            best, second = _joined(cost, np.array((ring[i], ring[j])), parts), best.cost
        else:
            second = min(second, cost)
    if best is uncut:
        return uncut
    return Split(best.cost, best.pieces, best.cuts, (second - best.cost, *best.rivals[1:]))


def _joined(cost: float, cut: FloatArray, parts: list[Split]) -> Split:
    first, second = parts
    return Split(
        cost,
        first.pieces + second.pieces,
        (cut, *first.cuts, *second.cuts),
        (0.0, *first.rivals, *second.rivals),
    )
