"""Where two shapes touch, or are about to."""

import numpy as np

from singulation_core.jit import compiled_inline, compiled_part
from singulation_core.polygon import FloatArray
from singulation_core.push_world.compiled.types import Shapes, State


@compiled_part
def place(shapes: Shapes, state: State, body: int) -> None:
    """Corners and normals of a shape at its pose."""
    x, y, angle = state.poses[body, 0], state.poses[body, 1], state.poses[body, 2]
    c, s = np.cos(angle), np.sin(angle)
    for k in range(shapes.firsts[body], shapes.firsts[body + 1]):
        vx, vy = shapes.vertices[k, 0], shapes.vertices[k, 1]
        nx, ny = shapes.normals[k, 0], shapes.normals[k, 1]
        state.corners[k, 0], state.corners[k, 1] = x + c * vx - s * vy, y + s * vx + c * vy
        state.outward[k, 0], state.outward[k, 1] = c * nx - s * ny, s * nx + c * ny


@compiled_part
def _edge_gap(shapes: Shapes, state: State, edge: int, other: int) -> float:
    """Gap between the line of an edge and another shape along the edge's normal."""
    nx, ny = state.outward[edge, 0], state.outward[edge, 1]
    least = np.inf
    for k in range(shapes.firsts[other], shapes.firsts[other + 1]):
        least = min(least, nx * state.corners[k, 0] + ny * state.corners[k, 1])
    return float(least - nx * state.corners[edge, 0] - ny * state.corners[edge, 1])


@compiled_inline
def separation(shapes: Shapes, state: State, one: int, other: int, enough: float) -> tuple[float, int]:
    """Largest gap over the edges of both, and that edge; stops as soon as a gap is larger than ``enough``."""
    best, best_edge = -np.inf, state.axes[one, other]
    if best_edge >= 0:
        owner_is_one = shapes.firsts[one] <= best_edge < shapes.firsts[one + 1]
        best = _edge_gap(shapes, state, best_edge, other if owner_is_one else one)
        if best > enough:
            return best, best_edge
    for turn in range(2):
        own, opposite = (one, other) if turn == 0 else (other, one)
        x, y = state.poses[opposite, 0], state.poses[opposite, 1]
        for edge in range(shapes.firsts[own], shapes.firsts[own + 1]):
            ahead = state.outward[edge, 0] * (x - state.corners[edge, 0])
            ahead += state.outward[edge, 1] * (y - state.corners[edge, 1])
            if ahead - shapes.inner_radii[opposite] <= best:  # no gap can be larger than this
                continue
            gap = _edge_gap(shapes, state, edge, opposite)
            if gap > best:
                best, best_edge = gap, edge
                if gap > enough:
                    break
        if best > enough:
            break
    state.axes[one, other] = best_edge
    return best, best_edge


@compiled_part
def touching_edge(shapes: Shapes, state: State, body: int, nx: float, ny: float) -> int:
    """Edge of a shape that faces against a direction most."""
    best, found = np.inf, shapes.firsts[body]
    for k in range(shapes.firsts[body], shapes.firsts[body + 1]):
        facing = state.outward[k, 0] * nx + state.outward[k, 1] * ny
        if facing < best:
            best, found = facing, k
    return int(found)


@compiled_inline
def polygon_contacts(
    shapes: Shapes, state: State, one: int, other: int, margin: float, points: FloatArray
) -> tuple[int, int, float, float]:
    """Contacts of two polygons that are nearer than ``margin``.

    Args:
        shapes, state: of the scene.
        one, other: the two.
        margin: gaps below it count.
        points: (2, 4) written: x, y, gap, key of up to two contacts.

    Returns:
        Number of contacts; 1 if the normal belongs to ``other``, else 0; and the normal, outward from its owner.
    """
    gap, edge = separation(shapes, state, one, other, margin)
    if gap > margin:
        return 0, 0, 0.0, 0.0
    swapped = 0 if shapes.firsts[one] <= edge < shapes.firsts[one + 1] else 1
    owner, incident = (one, other) if swapped == 0 else (other, one)
    nx, ny = state.outward[edge, 0], state.outward[edge, 1]
    facing = touching_edge(shapes, state, incident, nx, ny)
    end = _next(shapes, owner, edge)
    tx, ty = -ny, nx
    low = tx * state.corners[edge, 0] + ty * state.corners[edge, 1]
    high = tx * state.corners[end, 0] + ty * state.corners[end, 1]
    level = nx * state.corners[edge, 0] + ny * state.corners[edge, 1]
    count = 0
    facing_end = _next(shapes, incident, facing)
    for turn in range(2):
        here, there = (facing, facing_end) if turn == 0 else (facing_end, facing)
        x, y, inside = _clip(state, here, there, tx, ty, low, high)
        depth = nx * x + ny * y - level
        if inside and depth <= margin:
            points[count, 0], points[count, 1], points[count, 2] = x, y, depth
            points[count, 3] = edge * 4096.0 + here * 2.0
            count += 1
    return count, swapped, nx, ny


@compiled_part
def _next(shapes: Shapes, body: int, vertex: int) -> int:
    return vertex + 1 if vertex + 1 < shapes.firsts[body + 1] else int(shapes.firsts[body])


@compiled_part
def _clip(
    state: State, here: int, there: int, tx: float, ty: float, low: float, high: float
) -> tuple[float, float, bool]:
    """The point of the edge from ``here`` to ``there`` that is nearest to ``here`` within low <= t . x <= high."""
    x, y = state.corners[here, 0], state.corners[here, 1]
    dx, dy = state.corners[there, 0] - x, state.corners[there, 1] - y
    at, slope = tx * x + ty * y, tx * dx + ty * dy
    bound = low if at < low else (high if at > high else at)
    if bound == at:
        return x, y, True
    share = (bound - at) / slope if slope != 0.0 else 2.0
    return x + share * dx, y + share * dy, 0.0 <= share <= 1.0


@compiled_inline
def disc_contact(
    shapes: Shapes, state: State, body: int, x: float, y: float, radius: float
) -> tuple[float, float, float, float]:
    """Gap between a block and a disc, the normal from the block to the disc, and a key of the feature that touches."""
    best, edge = -np.inf, shapes.firsts[body]
    for k in range(shapes.firsts[body], shapes.firsts[body + 1]):
        height = state.outward[k, 0] * (x - state.corners[k, 0]) + state.outward[k, 1] * (y - state.corners[k, 1])
        if height > best:
            best, edge = height, k
    nx, ny = state.outward[edge, 0], state.outward[edge, 1]
    if best <= 0.0:
        return best - radius, nx, ny, float(edge)
    end = _next(shapes, body, edge)
    for corner in (edge, end):
        other = end if corner == edge else edge
        rx, ry = x - state.corners[corner, 0], y - state.corners[corner, 1]
        ex, ey = state.corners[other, 0] - state.corners[corner, 0], state.corners[other, 1] - state.corners[corner, 1]
        if rx * ex + ry * ey <= 0.0:
            distance = np.sqrt(rx * rx + ry * ry)
            return distance - radius, rx / distance, ry / distance, 1e6 + corner
    return best - radius, nx, ny, float(edge)
