"""Radius of gyration of a polygon."""

from singulation_core.jit import compiled
from singulation_core.polygon import FloatArray


@compiled
def squared_gyration(vertices: FloatArray, first: int, last: int, x: float, y: float) -> float:
    """Moment of inertia over mass about (x, y) of the polygon of vertices ``first`` to ``last`` - 1 [m^2].

    Args:
        vertices: (v, 2), of this polygon counter-clockwise [m].
        first, last: which of them.
        x, y: a point [m].
    """
    area, moment = 0.0, 0.0
    for k in range(first, last):
        after = k + 1 if k + 1 < last else first
        ax, ay = vertices[k, 0] - x, vertices[k, 1] - y
        bx, by = vertices[after, 0] - x, vertices[after, 1] - y
        weight = ax * by - bx * ay
        area += weight
        moment += weight * (ax * ax + ax * bx + bx * bx + ay * ay + ay * by + by * by)
    return moment / (6.0 * area)
