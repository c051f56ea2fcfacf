"""What a push would do if blocks kept their directions: the score that decides which pushes are simulated.

Two blocks are in each other's way where two outlines would be that are cut roughly around them: a disc, as large that
the two would touch at the distance of centroids at which they touch as they lie now, and the plane between them there.
That is what makes so little good enough in touching clutter. A block that is pushed goes its quasi-static way: it
turns as the force beside its centroid makes it turn, but its outline does not.
"""

import numpy as np

from singulation_core.jit import compiled_inline, compiled_maker, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.log_change import inverse_squares, log_change
from singulation_planner.kernels.types import IntArray

# The first block slides off those it meets, and is held up by them: shares of what it would push them aside and ahead.
# Found by comparison with the push physics (scenes of ``benchmarks/rollout`` with seeds 3000 to 3003).
_YIELD, _HELD = 0.3, 0.1
_LEAST = 1e-3  # of the way that a contact gives way; without a bound a block beside its contact would go anywhere
_FLOOR = 0.05  # smallest distance that counts, in units of the scale, as in the singulation distance


@compiled_inline
def _in_the_way(
    points: FloatArray, i: int, j: int, contact: FloatArray, planes: FloatArray
) -> tuple[float, float, float, bool]:
    """How deep blocks i and j are in each other (0: not), the normal from i to j, and whether it is that of the plane.

    Args:
        points: (n, 2) where the blocks are [m].
        contact: (n, n) distances of centroids at which they touch [m].
        planes: (n, n, 3) from ``touching``.
    """
    dx, dy = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1]
    apart2 = dx * dx + dy * dy
    if apart2 >= contact[i, j] * contact[i, j] or apart2 == 0.0:
        return 0.0, 1.0, 0.0, False
    nx, ny = planes[i, j, 0], planes[i, j, 1]
    flat = planes[i, j, 2] - dx * nx - dy * ny
    if flat <= 0.0:
        return 0.0, 1.0, 0.0, False
    apart = np.sqrt(apart2)
    if flat < contact[i, j] - apart:
        return flat, nx, ny, True
    return contact[i, j] - apart, dx / apart, dy / apart, False


@compiled_inline
def _shift(
    mx: float,
    my: float,
    nx: float,
    ny: float,
    rx: float,
    ry: float,
    gyration: float,
    depth: float,
    friction: float,
) -> tuple[float, float]:
    """Shift of a block that another one, going along (mx, my), pushes out of its way by ``depth`` along (nx, ny).

    It does so at (rx, ry) from the block's centroid, by a force within the cone of friction.
    """
    lever = (rx * my - ry * mx) / (gyration + rx * rx + ry * ry)
    fx, fy = mx + ry * lever, my - rx * lever
    pressed, aside = fx * nx + fy * ny, fy * nx - fx * ny
    if abs(aside) > friction * pressed:
        side = friction if aside > 0.0 else -friction
        fx, fy = nx - side * ny, ny + side * nx
    spin = (rx * fy - ry * fx) / gyration
    yields = (fx - spin * ry) * nx + (fy + spin * rx) * ny
    way = depth / max(yields, _LEAST)
    return way * fx, way * fy


@compiled_inline
def _spread(
    points: FloatArray,
    before: FloatArray,
    contact: FloatArray,
    planes: FloatArray,
    arms: FloatArray,
    gyrations: FloatArray,
    friction: float,
    target: int,
    queue: IntArray,
    rank: IntArray,
    moved: FloatArray,
) -> None:
    """Let the target push others, these push others, and so on; nobody pushes back.

    Args:
        points: (n, 2) where the blocks are, the target already further on; written [m].
        before: (n, 2) where they were [m].
        contact, planes, arms, gyrations: of all pairs, and of all blocks.
        friction: where blocks touch.
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
        if way > 0.0:
            mx, my = mx / way, my / way
        for j in range(n):
            if rank[j] >= 0 and rank[j] <= rank[i]:
                continue
            depth, nx, ny, flat = _in_the_way(points, i, j, contact, planes)
            if depth <= 0.0:
                continue
            rx, ry = (arms[i, j, 0], arms[i, j, 1]) if flat else (0.0, 0.0)
            x, y = _shift(mx, my, nx, ny, rx, ry, gyrations[j], depth, friction)
            points[j, 0], points[j, 1] = points[j, 0] + x, points[j, 1] + y
            moved[j] = 1.0
            if rank[j] < 0:
                rank[j] = rank[i] + 1
                queue[tail] = j
                tail += 1


@compiled_inline
def _give_way(
    points: FloatArray,
    contact: FloatArray,
    planes: FloatArray,
    target: int,
    dx: float,
    dy: float,
    deflection: FloatArray,
) -> None:
    """Move the target back by a share of what it would push others, across (dx, dy) and along it."""
    for j in range(len(points)):
        if j == target:
            continue
        depth, nx, ny, _ = _in_the_way(points, target, j, contact, planes)
        aside, back = _YIELD * depth * (ny * dx - nx * dy), _HELD * depth * (nx * dx + ny * dy)
        x, y = back * dx - aside * dy, back * dy + aside * dx
        if depth > 0.0:
            points[target, 0], points[target, 1] = points[target, 0] - x, points[target, 1] - y
            deflection[0], deflection[1] = deflection[0] - x, deflection[1] - y


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
    planes: FloatArray,
    arms: FloatArray,
    gyrations: FloatArray,
    targets: IntArray,
    directions: FloatArray,
    paths: FloatArray,
    counted: FloatArray,
    scale: float,
    width: float,
    weights: FloatArray,
    friction: float,
    scores: FloatArray,
) -> None:
    """Scores of m pushes.

    Args:
        centroids: (n, 2) [m].
        gaps: (n, n) gaps between the outlines [m], the diagonal is not read.
        planes, arms, gyrations: from ``touching``.
        targets: (m,) the blocks that are pushed.
        directions: (m, 2) unit vectors of the pushes.
        paths: (m, k, 2) displacements of the targets on their way [m].
        counted: (n,) 1 for blocks whose distances count, else 0.
        scale: mean bounding radius [m].
        width: gap beyond which nothing is gained [m].
        weights: of the change of the mean log distance and of the mean gap (both without unit).
        friction: where blocks touch.
        scores: (m,), written.
    """
    n, floor = len(centroids), _FLOOR * scale
    contact, inverse = np.empty((n, n)), np.empty((n, n))
    inverse_squares(centroids, floor, inverse)
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
            _give_way(after, contact, planes, target, directions[c, 0], directions[c, 1], deflection)
            _spread(after, last, contact, planes, arms, gyrations, friction, target, queue, rank, moved)
        scores[c] = weights[0] * log_change(after, inverse, moved, counted, floor)
        if weights[1] != 0.0:
            scores[c] += weights[1] * _clearance(centroids, after, gaps, moved, width)
