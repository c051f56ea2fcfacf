"""What a push would do if blocks were discs: the score that decides which pushes are simulated.

Two blocks keep, while one pushes the other, the distance of centroids at which they would touch as they lie now; that
is what makes discs good enough in touching clutter.
"""

import numpy as np

from singulation_core.jit import compiled_maker, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray

_FLOOR = 0.05  # smallest distance that counts, in units of the scale, as in the singulation distance


@compiled_part
def _spread(
    points: FloatArray, contact: FloatArray, target: int, queue: IntArray, rank: IntArray, moved: FloatArray
) -> None:
    """Let the target push others, these push others, and so on; nobody pushes back."""
    n = len(points)
    for j in range(n):
        rank[j] = -1
    queue[0], rank[target] = target, 0
    head, tail = 0, 1
    while head < tail:
        i = queue[head]
        head += 1
        for j in range(n):
            if rank[j] >= 0 and rank[j] <= rank[i]:
                continue
            dx, dy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
            apart2 = dx * dx + dy * dy
            if apart2 >= contact[i, j] * contact[i, j] or apart2 == 0.0:
                continue
            share = contact[i, j] / np.sqrt(apart2)
            points[j, 0], points[j, 1] = points[i, 0] + share * dx, points[i, 1] + share * dy
            moved[j] = 1.0
            if rank[j] < 0:
                rank[j] = rank[i] + 1
                queue[tail] = j
                tail += 1


@compiled_part
def _log_gain(before: FloatArray, after: FloatArray, moved: FloatArray, floor: float) -> float:
    """Change of the mean log distance of all pairs."""
    n = len(before)
    total = 0.0
    for i in range(n):
        if moved[i] == 0.0:
            continue
        ratio = 1.0
        for j in range(n):
            if j == i or (moved[j] != 0.0 and j < i):
                continue
            dx, dy = after[j, 0] - after[i, 0], after[j, 1] - after[i, 1]
            ex, ey = before[j, 0] - before[i, 0], before[j, 1] - before[i, 1]
            ratio *= max(dx * dx + dy * dy, floor * floor) / max(ex * ex + ey * ey, floor * floor)
        total += 0.5 * np.log(ratio)
    return float(total / (0.5 * n * (n - 1)))


@compiled_part
def _clearance(before: FloatArray, after: FloatArray, gaps: FloatArray, moved: FloatArray, width: float) -> float:
    """Mean over the blocks of the gap to the nearest other one, at most ``width``, in units of it."""
    n = len(before)
    total = 0.0
    for i in range(n):
        nearest = width
        for j in range(n):
            if j == i:
                continue
            gap = gaps[i, j]
            if moved[i] != 0.0 or moved[j] != 0.0:
                dx, dy = after[j, 0] - after[i, 0], after[j, 1] - after[i, 1]
                ex, ey = before[j, 0] - before[i, 0], before[j, 1] - before[i, 1]
                gap += np.sqrt(dx * dx + dy * dy) - np.sqrt(ex * ex + ey * ey)
            nearest = min(nearest, gap)
        total += max(0.0, nearest) / width
    return total / n


@compiled_maker
def disc_scores(
    centroids: FloatArray,
    gaps: FloatArray,
    targets: IntArray,
    paths: FloatArray,
    scale: float,
    width: float,
    weights: FloatArray,
    scores: FloatArray,
) -> None:
    """Scores of m pushes.

    Args:
        centroids: (n, 2) [m].
        gaps: (n, n) gaps between the outlines [m], the diagonal is not read.
        targets: (m,) the blocks that are pushed.
        paths: (m, k, 2) displacements of the targets on their way [m].
        scale: mean bounding radius [m].
        width: gap beyond which nothing is gained [m].
        weights: of the change of the mean log distance and of the mean gap (both without unit).
        scores: (m,), written.
    """
    n = len(centroids)
    contact = np.empty((n, n))
    for i in range(n):
        for j in range(n):
            dx, dy = centroids[j, 0] - centroids[i, 0], centroids[j, 1] - centroids[i, 1]
            contact[i, j] = np.sqrt(dx * dx + dy * dy) - max(gaps[i, j], 0.0)
    after, moved = np.empty((n, 2)), np.empty(n)
    queue, rank = np.empty(n, dtype=np.int64), np.empty(n, dtype=np.int64)
    for c in range(len(targets)):
        for j in range(n):  # whole arrays would compile three times as long
            after[j, 0], after[j, 1], moved[j] = centroids[j, 0], centroids[j, 1], 0.0
        target = targets[c]
        moved[target] = 1.0
        for step in range(paths.shape[1]):
            after[target, 0] = centroids[target, 0] + paths[c, step, 0]
            after[target, 1] = centroids[target, 1] + paths[c, step, 1]
            _spread(after, contact, target, queue, rank, moved)
        scores[c] = weights[0] * _log_gain(centroids, after, moved, _FLOOR * scale)
        if weights[1] != 0.0:
            scores[c] += weights[1] * _clearance(centroids, after, gaps, moved, width)
