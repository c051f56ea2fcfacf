"""What a push would do if blocks were discs: the score that decides which pushes are simulated.

Two blocks keep, while one pushes the other, the distance of centroids at which they would touch as they lie now; that
is what makes discs good enough in touching clutter.
"""

import numpy as np

from singulation_core.jit import compiled_maker, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray

# A block goes along the line of centres and, by friction, a little the way of the one that pushes it; the first one
# slides off those it meets. Both found by comparison with the push physics.
_DRAG, _YIELD = 0.3, 0.6
_FLOOR = 0.05  # smallest distance that counts, in units of the scale, as in the singulation distance


@compiled_part
def _spread(
    points: FloatArray,
    before: FloatArray,
    contact: FloatArray,
    target: int,
    queue: IntArray,
    rank: IntArray,
    moved: FloatArray,
) -> None:
    """Let the target push others, these push others, and so on; nobody pushes back.

    Args:
        points: (n, 2) where the blocks are, the target already further on; written [m].
        before: (n, 2) where they were [m].
        contact: (n, n) distances at which they touch [m].
        target: the block that the pusher pushes.
        queue, rank: (n,) room to work in.
        moved: (n,) written: 1 where a block was pushed.
    """
    n = len(points)
    for j in range(n):
        rank[j] = -1
    queue[0], rank[target] = target, 0
    head, tail = 0, 1
    while head < tail:
        i = queue[head]
        head += 1
        mx, my = points[i, 0] - before[i, 0], points[i, 1] - before[i, 1]
        way = np.sqrt(mx * mx + my * my)
        drag = _DRAG / way if way > 0.0 else 0.0
        for j in range(n):
            if rank[j] >= 0 and rank[j] <= rank[i]:
                continue
            dx, dy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
            apart2 = dx * dx + dy * dy
            if apart2 >= contact[i, j] * contact[i, j] or apart2 == 0.0:
                continue
            apart = np.sqrt(apart2)
            wx, wy = dx / apart + drag * mx, dy / apart + drag * my
            size = np.sqrt(wx * wx + wy * wy)
            wx, wy = wx / size, wy / size
            along = dx * wx + dy * wy  # on along w until the distance is that of contact
            shift = np.sqrt(max(0.0, along * along - apart2 + contact[i, j] ** 2)) - along
            points[j, 0], points[j, 1] = points[j, 0] + shift * wx, points[j, 1] + shift * wy
            moved[j] = 1.0
            if rank[j] < 0:
                rank[j] = rank[i] + 1
                queue[tail] = j
                tail += 1


@compiled_part
def _give_way(
    points: FloatArray, contact: FloatArray, target: int, dx: float, dy: float, deflection: FloatArray
) -> None:
    """Move the target aside, across (dx, dy), by a share of what it would push others aside."""
    for j in range(len(points)):
        rx, ry = points[j, 0] - points[target, 0], points[j, 1] - points[target, 1]
        apart2 = rx * rx + ry * ry
        if j == target or apart2 >= contact[target, j] * contact[target, j] or apart2 == 0.0:
            continue
        apart = np.sqrt(apart2)
        aside = _YIELD * (contact[target, j] - apart) * (ry * dx - rx * dy) / apart
        for axis, across in ((0, -dy), (1, dx)):
            points[target, axis] -= aside * across
            deflection[axis] -= aside * across


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
    directions: FloatArray,
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
        directions: (m, 2) unit vectors of the pushes.
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
    after, last, moved, deflection = np.empty((n, 2)), np.empty((n, 2)), np.empty(n), np.empty(2)
    queue, rank = np.empty(n, dtype=np.int64), np.empty(n, dtype=np.int64)
    for c in range(len(targets)):
        for j in range(n):  # whole arrays would compile three times as long
            after[j, 0], after[j, 1], moved[j] = centroids[j, 0], centroids[j, 1], 0.0
        target = targets[c]
        moved[target] = 1.0
        deflection[0], deflection[1] = 0.0, 0.0
        for step in range(paths.shape[1]):
            for j in range(n):
                last[j, 0], last[j, 1] = after[j, 0], after[j, 1]
            after[target, 0] = centroids[target, 0] + paths[c, step, 0] + deflection[0]
            after[target, 1] = centroids[target, 1] + paths[c, step, 1] + deflection[1]
            _give_way(after, contact, target, directions[c, 0], directions[c, 1], deflection)
            _spread(after, last, contact, target, queue, rank, moved)
        scores[c] = weights[0] * _log_gain(centroids, after, moved, _FLOOR * scale)
        if weights[1] != 0.0:
            scores[c] += weights[1] * _clearance(centroids, after, gaps, moved, width)
