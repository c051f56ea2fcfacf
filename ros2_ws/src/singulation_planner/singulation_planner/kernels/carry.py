"""What a push would carry over the edge of the workspace."""

import numpy as np
from numba import njit

from singulation_core.polygon import FloatArray


@njit(cache=True)
def _stays(normals: FloatArray, limits: FloatArray, x: float, y: float, radius: float, mx: float, my: float) -> bool:
    """Whether a disc moved by (mx, my) keeps inside, or at least does not come nearer to an edge it sticks out of."""
    for k in range(len(limits)):
        inward = normals[k, 0] * mx + normals[k, 1] * my
        depth = (x + mx) * normals[k, 0] + (y + my) * normals[k, 1] - limits[k]
        if inward < 0.0 and depth < radius:
            return False
    return True


@njit(cache=True)
def carried_over(
    centroids: FloatArray,
    radii: FloatArray,
    normals: FloatArray,
    limits: FloatArray,
    target: int,
    dx: float,
    dy: float,
    travel: float,
    margin: float,
    moved: FloatArray,
) -> bool:
    """Whether the push could carry an object over the edge of the workspace.

    The bounding circle of the pushed object moves by the whole travel; a circle that it meets on the way moves on by
    what is then left, and so on. Each must stay inside both for a move along the push and along the line of centres.
    """
    n = len(radii)
    moved[:] = 0.0
    moved[target] = travel
    if not _stays(normals, limits, centroids[target, 0], centroids[target, 1], radii[target], dx * travel, dy * travel):
        return True
    for _ in range(n):
        changed = False
        for i in range(n):
            if moved[i] <= 0.0:
                continue
            for j in range(n):
                if j == i:
                    continue
                rx, ry = centroids[j, 0] - centroids[i, 0], centroids[j, 1] - centroids[i, 1]
                along, across = rx * dx + ry * dy, ry * dx - rx * dy
                reach = radii[i] + radii[j] + margin
                if along <= 0.0 or abs(across) >= reach:
                    continue
                left = moved[i] - max(0.0, along - np.sqrt(reach * reach - across * across))
                if left <= moved[j] * (1.0 + 1e-9):
                    continue
                moved[j] = left
                changed = True
                nx, ny = rx / np.hypot(rx, ry) * left, ry / np.hypot(rx, ry) * left
                if not _stays(normals, limits, centroids[j, 0], centroids[j, 1], radii[j], dx * left, dy * left):
                    return True
                if not _stays(normals, limits, centroids[j, 0], centroids[j, 1], radii[j], nx, ny):
                    return True
        if not changed:
            break
    return False
