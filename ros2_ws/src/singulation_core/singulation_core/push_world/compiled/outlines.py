"""What follows from the outlines of blocks and pusher before anything moves."""

import numpy as np

from singulation_core.gyration import squared_gyration
from singulation_core.jit import compiled
from singulation_core.polygon import FloatArray
from singulation_core.push_world.compiled.types import Shapes


@compiled
def measure(corners: FloatArray, centroids: FloatArray, masses: FloatArray, unit: float, shapes: Shapes) -> None:
    """Fill in the shapes but for their radii and the pusher's discs.

    Args:
        corners: (v, 2) outlines of the blocks, then of the pusher in its own frame [m].
        centroids: (n, 2) of the blocks [m].
        masses: (n,) of the blocks, of any unit.
        unit: length of an inner unit [m].
        shapes: ``firsts`` is read, the rest written.
    """
    n = len(centroids)
    for body in range(n + 1):
        first, last = shapes.firsts[body], shapes.firsts[body + 1]
        x, y = (centroids[body, 0], centroids[body, 1]) if body < n else (0.0, 0.0)
        nearest = np.inf
        for k in range(first, last):
            after = k + 1 if k + 1 < last else first
            vx, vy = (corners[k, 0] - x) / unit, (corners[k, 1] - y) / unit
            ex, ey = (corners[after, 0] - corners[k, 0]) / unit, (corners[after, 1] - corners[k, 1]) / unit
            length = np.sqrt(ex * ex + ey * ey)
            shapes.vertices[k, 0], shapes.vertices[k, 1] = vx, vy
            shapes.normals[k, 0], shapes.normals[k, 1] = ey / length, -ex / length
            nearest = min(nearest, (vx * ey - vy * ex) / length)
        shapes.inner_radii[body], shapes.mobility[body, 0], shapes.mobility[body, 1] = 0.0, 0.0, 0.0
        if body < n:
            mobility = 1.0 / masses[body]
            shapes.inner_radii[body], shapes.mobility[body, 0] = nearest, mobility
            shapes.mobility[body, 1] = mobility / squared_gyration(shapes.vertices, first, last, 0.0, 0.0)
