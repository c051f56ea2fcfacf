"""How far a polygon can slide before it touches another."""

from collections.abc import Sequence

import numpy as np

from singulation_core.polygon import FloatArray, cross


def free_travel(moving: FloatArray, others: Sequence[FloatArray], direction: FloatArray) -> float:
    """Way of a convex polygon along the unit vector (2,) until it touches another; infinite if it passes them all.

    First contact of convex polygons is a vertex of one on an edge of the other.
    """
    return min((_until_contact(moving, other, direction) for other in others), default=np.inf)


def _until_contact(moving: FloatArray, other: FloatArray, direction: FloatArray) -> float:
    return min(_vertices_on_edges(moving, other, direction), _vertices_on_edges(other, moving, -direction))


def _vertices_on_edges(points: FloatArray, polygon: FloatArray, direction: FloatArray) -> float:
    """Smallest non-negative way along ``direction`` from any point to any edge."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    turn = cross(np.broadcast_to(direction, edges.shape), edges)[None]
    relative = polygon[None, :, :] - points[:, None, :]
    with np.errstate(divide="ignore", invalid="ignore"):
        way = cross(relative, np.broadcast_to(edges, relative.shape)) / turn
        along = cross(relative, np.broadcast_to(direction, relative.shape)) / turn
    hit = (np.abs(turn) > 1e-12) & (along >= -1e-9) & (along <= 1.0 + 1e-9) & (way >= -1e-9)
    return float(way[hit].min(initial=np.inf))
