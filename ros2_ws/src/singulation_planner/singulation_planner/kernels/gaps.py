"""Gaps between the outlines of all blocks, as they lie and after pushes."""

import numpy as np

from singulation_core.jit import compiled_maker, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.log_change import inverse_squares, log_change
from singulation_planner.kernels.types import IntArray

_FREED = 0.1  # what the last step to a wide enough gap counts for: almost free is not free
_PAIRS = 0.3  # weight of what the gaps of all pairs lack, beside each block's smallest gap


@compiled_part
def _one_sided(
    corners: FloatArray, first: int, last: int, other_first: int, other_last: int
) -> tuple[float, float, int]:
    """Largest separation along the normals of the first outline, squared distance of the other's vertices to it, and
    the edge with that normal.
    """
    widest, squared, edge = -np.inf, np.inf, first
    for k in range(first, last):
        after = k + 1 if k + 1 < last else first
        x, y = corners[k, 0], corners[k, 1]
        ex, ey = corners[after, 0] - x, corners[after, 1] - y
        length2 = ex * ex + ey * ey
        nearest = np.inf
        for m in range(other_first, other_last):
            rx, ry = corners[m, 0] - x, corners[m, 1] - y
            height = rx * ey - ry * ex
            nearest = min(nearest, height)
            along = min(1.0, max(0.0, (rx * ex + ry * ey) / length2))
            px, py = rx - along * ex, ry - along * ey
            squared = min(squared, px * px + py * py)
        if nearest / np.sqrt(length2) > widest:
            widest, edge = nearest / np.sqrt(length2), k
    return widest, squared, edge


@compiled_part
def outline_gap(corners: FloatArray, first: int, last: int, other_first: int, other_last: int) -> tuple[float, int]:
    """Distance of two convex outlines [m], minus the depth where they overlap, and the edge that separates most."""
    one, squared, edge = _one_sided(corners, first, last, other_first, other_last)
    other, squared_other, other_edge = _one_sided(corners, other_first, other_last, first, last)
    deepest = max(one, other)
    gap = deepest if deepest <= 0.0 else np.sqrt(min(squared, squared_other))
    return gap, edge if one >= other else other_edge


@compiled_part
def _put(shapes: FloatArray, first: int, last: int, x: float, y: float, turn: float, corners: FloatArray) -> None:
    c, s = np.cos(turn), np.sin(turn)
    for k in range(first, last):
        corners[k, 0] = x + c * shapes[k, 0] - s * shapes[k, 1]
        corners[k, 1] = y + s * shapes[k, 0] + c * shapes[k, 1]


@compiled_maker
def all_gaps(corners: FloatArray, firsts: IntArray) -> tuple[FloatArray, IntArray]:
    """(n, n) gaps of all pairs [m], infinite on the diagonal, and the edges (n, n) that separate them most."""
    n = len(firsts) - 1
    gaps, edges = np.empty((n, n)), np.zeros((n, n), dtype=np.int64)
    for i in range(n):
        gaps[i, i] = np.inf
        for j in range(i):
            gap, edge = outline_gap(corners, firsts[i], firsts[i + 1], firsts[j], firsts[j + 1])
            gaps[i, j], gaps[j, i], edges[i, j], edges[j, i] = gap, gap, edge, edge
    return gaps, edges


@compiled_part
def _nearest_gaps(
    pose: FloatArray,
    moved: FloatArray,
    radii: FloatArray,
    corners: FloatArray,
    firsts: IntArray,
    gaps: FloatArray,
    width: float,
    nearest: FloatArray,
) -> float:
    """Lower ``nearest`` (n,) to the gap of each block to its nearest other one, at most ``width``.

    Returns:
        Sum over all pairs of what their gap lacks to ``width``.
    """
    n, lacking = len(radii), 0.0
    for i in range(n):
        for j in range(i):
            gap = gaps[i, j]
            if moved[i] != 0.0 or moved[j] != 0.0:
                dx, dy = pose[i, 0] - pose[j, 0], pose[i, 1] - pose[j, 1]
                gap = np.sqrt(dx * dx + dy * dy) - radii[i] - radii[j]
                if gap < width:
                    gap = outline_gap(corners, firsts[i], firsts[i + 1], firsts[j], firsts[j + 1])[0]
            nearest[i], nearest[j] = min(nearest[i], gap), min(nearest[j], gap)
            lacking += width - min(width, max(0.0, gap))
    return lacking


@compiled_maker
def outcome_values(
    outlines: FloatArray,
    firsts: IntArray,
    radii: FloatArray,
    gaps: FloatArray,
    before: FloatArray,
    poses: FloatArray,
    counted: FloatArray,
    width: float,
    floor: float,
    changes: FloatArray,
    spreads: FloatArray,
    clearances: FloatArray,
) -> None:
    """What pushes changed.

    Args:
        outlines: (v, 2) vertices around their centroids [m].
        firsts: (n + 1,) where each outline begins.
        radii: (n,) bounding radii [m].
        gaps: (n, n) before the pushes [m].
        before: (n, 3) x, y [m], turn [rad].
        poses: (m, n, 3) after each push; NaN gives NaN.
        counted: (n,) 1 for blocks whose distances count for ``spreads``, else 0.
        width: gap beyond which nothing is gained [m]; 0: clearances are not asked for.
        floor: smallest distance that counts [m].
        changes: (m,) written: change of the mean log distance of all pairs.
        spreads: (m,) written: the same of the pairs of blocks that count.
        clearances: (m,) written: mean over the blocks of the gap to the nearest other one, at most ``width``, less a
            share of what the gaps of all pairs lack to ``width`` (else nothing is gained by freeing a block of one of
            several neighbours); in units of ``width``. Each block that is free counts for a little more.
    """
    n = len(radii)
    corners, nearest, moved = np.empty_like(outlines), np.empty(n), np.empty(n)
    everyone, inverse = np.ones(n), np.empty((n, n))
    inverse_squares(before, floor, inverse)
    for c in range(len(poses)):
        pose = poses[c]
        changes[c], spreads[c], clearances[c] = np.nan, np.nan, 0.0
        if np.isnan(pose[0, 0]):
            continue
        for i in range(n):
            way = max(abs(pose[i, 0] - before[i, 0]), abs(pose[i, 1] - before[i, 1]))
            moved[i] = 1.0 if max(way, abs(pose[i, 2] - before[i, 2]) * radii[i]) > 1e-9 * radii[i] else 0.0
            nearest[i] = width
        changes[c] = log_change(pose, inverse, moved, everyone, floor)
        spreads[c] = changes[c] if width == 0.0 else log_change(pose, inverse, moved, counted, floor)
        if width > 0.0:
            for i in range(n):
                _put(outlines, firsts[i], firsts[i + 1], pose[i, 0], pose[i, 1], pose[i, 2], corners)
            lacking = _nearest_gaps(pose, moved, radii, corners, firsts, gaps, width, nearest)
            for i in range(n):
                clearances[c] += (1.0 - _PAIRS) * max(0.0, nearest[i]) / (n * width)
                if nearest[i] >= width:
                    clearances[c] += _FREED / n
            clearances[c] -= _PAIRS * lacking / (n * width)
