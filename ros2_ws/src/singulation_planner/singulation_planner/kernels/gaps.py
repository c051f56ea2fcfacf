"""Gaps between the outlines of all blocks, as they lie and after pushes."""

import numpy as np
from numba import njit

from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray

_FREED = 0.1  # what the last step to a wide enough gap counts for: almost free is not free
_PAIRS = 0.3  # weight of what the gaps of all pairs lack, beside each block's smallest gap


@njit(cache=True)
def _one_sided(corners: FloatArray, first: int, last: int, other_first: int, other_last: int) -> tuple[float, float]:
    """Largest separation along the normals of the first outline, and squared distance of the other's vertices to it."""
    widest, squared = -np.inf, np.inf
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
        widest = max(widest, nearest / np.sqrt(length2))
    return widest, squared


@njit(cache=True)
def outline_gap(corners: FloatArray, first: int, last: int, other_first: int, other_last: int) -> float:
    """Distance of two convex outlines [m]; minus the depth where they overlap."""
    one, squared = _one_sided(corners, first, last, other_first, other_last)
    other, squared_other = _one_sided(corners, other_first, other_last, first, last)
    deepest = max(one, other)
    return deepest if deepest <= 0.0 else np.sqrt(min(squared, squared_other))


@njit(cache=True)
def _put(shapes: FloatArray, first: int, last: int, x: float, y: float, turn: float, corners: FloatArray) -> None:
    c, s = np.cos(turn), np.sin(turn)
    for k in range(first, last):
        corners[k, 0] = x + c * shapes[k, 0] - s * shapes[k, 1]
        corners[k, 1] = y + s * shapes[k, 0] + c * shapes[k, 1]


@njit(cache=True)
def all_gaps(corners: FloatArray, firsts: IntArray) -> FloatArray:
    """(n, n) gaps of all pairs [m]; infinite on the diagonal."""
    n = len(firsts) - 1
    gaps = np.full((n, n), np.inf)
    for i in range(n):
        for j in range(i):
            gaps[i, j] = outline_gap(corners, firsts[i], firsts[i + 1], firsts[j], firsts[j + 1])
            gaps[j, i] = gaps[i, j]
    return gaps


@njit(cache=True)
def _nearest_gaps(
    pose: FloatArray,
    moved: IntArray,
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
            if moved[i] != 0 or moved[j] != 0:
                dx, dy = pose[i, 0] - pose[j, 0], pose[i, 1] - pose[j, 1]
                gap = np.sqrt(dx * dx + dy * dy) - radii[i] - radii[j]
                if gap < width:
                    gap = outline_gap(corners, firsts[i], firsts[i + 1], firsts[j], firsts[j + 1])
            nearest[i], nearest[j] = min(nearest[i], gap), min(nearest[j], gap)
            lacking += width - min(width, max(0.0, gap))
    return lacking


@njit(cache=True)
def _log_change(before: FloatArray, after: FloatArray, moved: IntArray, floor: float) -> float:
    """Change of the mean log distance of all pairs."""
    n, total = len(before), 0.0
    for i in range(n):
        if moved[i] == 0:
            continue
        ratio = 1.0
        for j in range(n):
            if j == i or (moved[j] != 0 and j < i):
                continue
            dx, dy = after[j, 0] - after[i, 0], after[j, 1] - after[i, 1]
            ex, ey = before[j, 0] - before[i, 0], before[j, 1] - before[i, 1]
            ratio *= max(dx * dx + dy * dy, floor * floor) / max(ex * ex + ey * ey, floor * floor)
        total += 0.5 * np.log(ratio)
    return float(total / (0.5 * n * (n - 1)))


@njit(cache=True)
def outcome_values(
    outlines: FloatArray,
    firsts: IntArray,
    radii: FloatArray,
    gaps: FloatArray,
    before: FloatArray,
    poses: FloatArray,
    width: float,
    floor: float,
    changes: FloatArray,
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
        width: gap beyond which nothing is gained [m]; 0: clearances are not asked for.
        floor: smallest distance that counts [m].
        changes: (m,) written: change of the mean log distance of all pairs.
        clearances: (m,) written: mean over the blocks of the gap to the nearest other one, at most ``width``, less a
            share of what the gaps of all pairs lack to ``width`` (else nothing is gained by freeing a block of one of
            several neighbours); in units of ``width``. Each block that is free counts for a little more.
    """
    n = len(radii)
    corners, nearest, moved = np.empty_like(outlines), np.empty(n), np.empty(n, dtype=np.int64)
    for c in range(len(poses)):
        pose = poses[c]
        changes[c], clearances[c] = np.nan, 0.0
        if np.isnan(pose[0, 0]):
            continue
        for i in range(n):
            way = max(abs(pose[i, 0] - before[i, 0]), abs(pose[i, 1] - before[i, 1]))
            moved[i] = 1 if max(way, abs(pose[i, 2] - before[i, 2]) * radii[i]) > 1e-9 * radii[i] else 0
            nearest[i] = width
        changes[c] = _log_change(before, pose, moved, floor)
        if width > 0.0:
            for i in range(n):
                _put(outlines, firsts[i], firsts[i + 1], pose[i, 0], pose[i, 1], pose[i, 2], corners)
            lacking = _nearest_gaps(pose, moved, radii, corners, firsts, gaps, width, nearest)
            for i in range(n):
                clearances[c] += (1.0 - _PAIRS) * max(0.0, nearest[i]) / (n * width)
                if nearest[i] >= width:
                    clearances[c] += _FREED / n
            clearances[c] -= _PAIRS * lacking / (n * width)
