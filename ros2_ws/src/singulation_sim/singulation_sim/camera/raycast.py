"""Compiled ray casting: distance to the nearest solid, and which points the projector does not light."""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray

FloatImage = NDArray[np.float32]  # (H, W)
IntArray = NDArray[np.int64]

_SURFACE = 1e-4  # share of the way to the projector that is left out, so that a surface does not shade itself


class Solids(NamedTuple):
    """Convex solids in the camera frame, in a form that compiled code takes.

    Args:
        planes: (M, 4) half-spaces ``normal . x <= offset`` of all solids.
        starts: (S + 1,) first half-space of each solid.
        windows: (S, 4) first row, last row + 1, first column, last column + 1 that concern a solid.
    """

    planes: FloatArray
    starts: IntArray
    windows: IntArray


@njit(cache=True, nogil=True)
def cast(rays: FloatImage, solids: Solids, distance: FloatImage, cosine: FloatImage) -> None:
    """Shorten ``distance`` to the nearest solid along each ray and set the ``cosine`` of the angle of incidence.

    Args:
        rays: (H, W, 3) unit vectors from the origin.
        solids: to be seen, each in its window.
        distance: (H, W) along the ray [m], in and out.
        cosine: (H, W), out.
    """
    for solid in range(len(solids.windows)):
        top, bottom, left, right = solids.windows[solid]
        for row in range(top, bottom):
            for column in range(left, right):
                x, y, z = rays[row, column]
                enter, leave, facing = 0.0, 1.0 * distance[row, column], 0.0
                for plane in range(solids.starts[solid], solids.starts[solid + 1]):
                    a, b, c, offset = solids.planes[plane]
                    slope = a * x + b * y + c * z
                    if slope < 0.0:
                        if offset < enter * slope:
                            enter, facing = offset / slope, -slope
                    elif slope > 0.0:
                        leave = min(leave, offset / slope)
                    elif offset < 0.0:
                        leave = 0.0
                    if leave <= enter:
                        break
                if 0.0 < enter < leave:
                    distance[row, column] = enter
                    cosine[row, column] = facing


@njit(cache=True, nogil=True)
def shade(
    rays: FloatImage, solids: Solids, distance: FloatImage, projector: FloatArray, lit: NDArray[np.bool_]
) -> None:
    """Clear ``lit`` (H, W) where a solid stands between the point seen and the projector (3,) [m]."""
    for solid in range(len(solids.windows)):
        top, bottom, left, right = solids.windows[solid]
        for row in range(top, bottom):
            for column in range(left, right):
                if not lit[row, column]:
                    continue
                t = 1.0 * distance[row, column]
                x, y, z = rays[row, column, 0] * t, rays[row, column, 1] * t, rays[row, column, 2] * t
                to_x, to_y, to_z = projector[0] - x, projector[1] - y, projector[2] - z
                enter, leave = _SURFACE, 1.0
                for plane in range(solids.starts[solid], solids.starts[solid + 1]):
                    a, b, c, offset = solids.planes[plane]
                    inside = offset - (a * x + b * y + c * z)
                    slope = a * to_x + b * to_y + c * to_z
                    if slope < 0.0:
                        enter = max(enter, inside / slope)
                    elif slope > 0.0:
                        leave = min(leave, inside / slope)
                    elif inside < 0.0:
                        leave = 0.0
                    if leave <= enter:
                        break
                if enter < leave:
                    lit[row, column] = False
