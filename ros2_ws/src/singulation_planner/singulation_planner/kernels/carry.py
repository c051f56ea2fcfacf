"""What a push would carry over the edge of the workspace."""

import numpy as np

from singulation_core.jit import compiled_maker, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray

_INWARDS = 0.5  # share of its way by which an object that may stick out already has to move inwards
_SPREAD = np.deg2rad(30.0)  # between the line of centres and the direction in which one block moves another


@compiled_part
def _stays(normals: FloatArray, limits: FloatArray, x: float, y: float, radius: float, mx: float, my: float) -> bool:
    """Whether a disc moved by (mx, my) ends inside, or else was brought well away from the edge in question."""
    for k in range(len(limits)):
        inward = normals[k, 0] * mx + normals[k, 1] * my
        depth = (x + mx) * normals[k, 0] + (y + my) * normals[k, 1] - limits[k]
        if depth < radius and inward < _INWARDS * np.hypot(mx, my):
            return False
    return True


@compiled_part
def _stays_if_pushed_on(
    normals: FloatArray,
    limits: FloatArray,
    x: float,
    y: float,
    radius: float,
    dx: float,
    dy: float,
    angle: float,
    way: float,
) -> bool:
    """``_stays`` for a disc that another one, moving by ``way`` along (dx, dy), meets at ``angle`` from there.

    Friction may take it along the push; without friction it moves along the normal of the contact, and outlines have
    their normals to either side of the line of centres.
    """
    if not _stays(normals, limits, x, y, radius, dx * way, dy * way):
        return False
    for turn in (angle - _SPREAD, angle + _SPREAD):
        share = way * max(0.0, np.cos(turn))
        mx, my = share * (dx * np.cos(turn) - dy * np.sin(turn)), share * (dx * np.sin(turn) + dy * np.cos(turn))
        if not _stays(normals, limits, x, y, radius, mx, my):
            return False
    return True


@compiled_part
def _pushed_directly(
    centroids: FloatArray,
    radii: FloatArray,
    px: float,
    py: float,
    dx: float,
    dy: float,
    half_width: float,
    travel: float,
    moved: FloatArray,
) -> None:
    """How far the pusher itself moves each bounding circle that its path meets."""
    for j in range(len(radii)):
        rx, ry = centroids[j, 0] - px, centroids[j, 1] - py
        along, across = rx * dx + ry * dy, abs(ry * dx - rx * dy)
        aside = max(0.0, across - half_width)
        moved[j] = 0.0
        if along > 0.0 and aside < radii[j]:
            moved[j] = max(0.0, travel - max(0.0, along - np.sqrt(radii[j] ** 2 - aside**2)))


@compiled_part
def _passed_on(
    centroids: FloatArray, radii: FloatArray, i: int, j: int, dx: float, dy: float, way: float, margin: float
) -> float:
    """How far circle ``i``, moving by ``way``, moves circle ``j``."""
    rx, ry = centroids[j, 0] - centroids[i, 0], centroids[j, 1] - centroids[i, 1]
    along, across = rx * dx + ry * dy, ry * dx - rx * dy
    reach = radii[i] + radii[j] + margin
    if along <= 0.0 or abs(across) >= reach:
        return 0.0
    return way - max(0.0, along - np.sqrt(reach * reach - across * across))


@compiled_maker
def carried_over(
    centroids: FloatArray,
    radii: FloatArray,
    normals: FloatArray,
    limits: FloatArray,
    target: int,
    px: float,
    py: float,
    dx: float,
    dy: float,
    half_width: float,
    travel: float,
    margin: float,
) -> bool:
    """Whether a push could carry an object over the edge of the workspace.

    An estimate on the safe side: the bounding circles that the pusher meets, the target's in any case, go with it; a
    circle that one of them meets goes on by what is then left of the travel, and so on. Each must stay inside after
    such a move along the push and, where another circle moves it, to both sides of the line between the two.

    Args:
        centroids, radii: (n, 2), (n,) bounding circles [m].
        normals, limits: inward half planes of the workspace.
        target: index of the push object.
        px, py, dx, dy, half_width, travel: start, unit direction, half width of the pusher and length of the push.
        margin: gap that counts as touching [m].
    """
    n = len(radii)
    moved = np.empty(n)
    _pushed_directly(centroids, radii, px, py, dx, dy, half_width, travel, moved)
    moved[target] = travel
    for i in range(n):
        way = moved[i]
        if way > 0.0 and not _stays(normals, limits, centroids[i, 0], centroids[i, 1], radii[i], dx * way, dy * way):
            return True
    changed = True
    while changed:
        changed = False
        for i in range(n):
            for j in range(n):
                if j == i or moved[i] <= 0.0:
                    continue
                way = _passed_on(centroids, radii, i, j, dx, dy, moved[i], margin)
                if way <= moved[j] * (1.0 + 1e-9) or way <= 0.0:
                    continue
                moved[j] = way
                changed = True
                rx, ry = centroids[j, 0] - centroids[i, 0], centroids[j, 1] - centroids[i, 1]
                angle = np.arctan2(ry * dx - rx * dy, rx * dx + ry * dy)
                x, y = centroids[j, 0], centroids[j, 1]
                if not _stays_if_pushed_on(normals, limits, x, y, radii[j], dx, dy, angle, way):
                    return True
    return False


@compiled_maker
def mark_carried_over(
    centroids: FloatArray,
    radii: FloatArray,
    normals: FloatArray,
    limits: FloatArray,
    targets: IntArray,
    starts: FloatArray,
    directions: FloatArray,
    half_widths: FloatArray,
    travel: float,
    margin: float,
    status: IntArray,
    feasible: int,
    over_edge: int,
) -> None:
    """Give ``status`` (m,) ``over_edge`` where it is ``feasible`` and ``carried_over`` says so; the rest as there."""
    for c in range(len(targets)):
        if status[c] == feasible and carried_over(
            centroids,
            radii,
            normals,
            limits,
            targets[c],
            starts[c, 0],
            starts[c, 1],
            directions[c, 0],
            directions[c, 1],
            half_widths[targets[c]],
            travel,
            margin,
        ):
            status[c] = over_edge
