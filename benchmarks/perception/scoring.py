"""Found objects against the truth."""

from dataclasses import dataclass

import numpy as np

from singulation_core import Arrangement, PlanarObject
from singulation_core.polygon import FloatArray, inward_half_planes, signed_area

FOUND = 0.8  # intersection over union from which a block counts as found


@dataclass(frozen=True)
class Match:
    """One true block and the object that overlaps it best.

    Args:
        overlap: intersection over union of the outlines, 0 if nothing overlaps.
        centroid: distance of the centroids [m].
        vertices_right: as many vertices as the block has.
        angle: largest difference of an edge's direction [rad], NaN unless the vertices are right.
        vertex: mean distance of the vertices [m], NaN unless the vertices are right.
        height: difference of the heights [m].
        confidence: of the object.
    """

    overlap: float
    centroid: float
    vertices_right: bool
    angle: float
    vertex: float
    height: float
    confidence: float

    @property
    def found(self) -> bool:
        """Whether the block counts as found."""
        return self.overlap > FOUND


def score(seen: Arrangement, truth: Arrangement) -> list[Match]:
    """A match for every true block."""
    return [_match(block, seen) for block in truth.objects]


def _match(block: PlanarObject, seen: Arrangement) -> Match:
    best, best_overlap = None, 0.0
    for item in seen.objects:
        if np.hypot(*(item.centroid - block.centroid)) < item.bounding_radius + block.bounding_radius:
            overlap = intersection_over_union(item.outline, block.outline)
            if overlap > best_overlap:
                best, best_overlap = item, overlap
    if best is None:
        return Match(0.0, np.nan, False, np.nan, np.nan, np.nan, np.nan)
    angle, vertex = _shape_errors(best.outline, block.outline)
    return Match(
        best_overlap,
        float(np.hypot(*(best.centroid - block.centroid))),
        len(best.outline) == len(block.outline),
        angle,
        vertex,
        abs(best.height - block.height),
        best.confidence,
    )


def intersection_over_union(one: FloatArray, two: FloatArray) -> float:
    """Of two convex outlines."""
    common = clipped(one, two)
    shared = signed_area(common) if len(common) > 2 else 0.0
    return shared / (signed_area(one) + signed_area(two) - shared)


def clipped(subject: FloatArray, clip: FloatArray) -> FloatArray:
    """The part of a convex outline inside another one (Sutherland and Hodgman 1974)."""
    points = list(subject)
    for normal, offset in zip(*inward_half_planes(clip), strict=True):
        kept = []
        for here, following in zip(points, points[1:] + points[:1], strict=True):
            a, b = float(normal @ here - offset), float(normal @ following - offset)
            if a >= 0:
                kept.append(here)
            if a * b < 0:
                kept.append(here + (following - here) * a / (a - b))
        points = kept
        if not points:
            break
    return np.array(points).reshape(-1, 2)


def _shape_errors(seen: FloatArray, true: FloatArray) -> tuple[float, float]:
    """Largest edge angle error and mean vertex error over the best cyclic assignment."""
    if len(seen) != len(true):
        return np.nan, np.nan
    shifts = [np.roll(seen, k, axis=0) for k in range(len(seen))]
    best = min(shifts, key=lambda one: float(np.hypot(*(one - true).T).sum()))
    edges, own = (np.roll(one, -1, axis=0) - one for one in (true, best))
    turn = np.arctan2(edges[:, 0] * own[:, 1] - edges[:, 1] * own[:, 0], (edges * own).sum(axis=1))
    return float(np.abs(turn).max()), float(np.hypot(*(best - true).T).mean())
