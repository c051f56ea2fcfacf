"""From the boundary of a top face to a convex polygon on the table."""

import cv2
import numpy as np
from singulation_core.polygon import FloatArray, convex_hull, cross


def outline_of(boundary: FloatArray, tolerance: float, growth: float) -> FloatArray | None:
    """Convex polygon of a face: hull, Douglas-Peucker, then edges fitted to the boundary and moved outwards.

    Args:
        boundary: (m, 2) points on the rim of the face, in any order [m].
        tolerance: of Douglas-Peucker [m].
        growth: by which edges move outwards [m].

    Returns:
        (k, 2), counter-clockwise; None if the points have no area.
    """
    hull = convex_hull(boundary)
    if len(hull) < 3:
        return None
    origin = hull[0]  # float32 keeps micrometres only near zero
    corners = cv2.approxPolyDP((hull - origin).astype(np.float32)[:, None, :], tolerance, True)
    polygon = corners[:, 0, :].astype(np.float64) + origin
    if len(polygon) < 3:
        return None
    return _corners_of(*_fitted_edges(polygon, boundary, tolerance), growth, polygon)


def _fitted_edges(polygon: FloatArray, boundary: FloatArray, tolerance: float) -> tuple[FloatArray, FloatArray]:
    """Outward unit normals and offsets of the lines through the boundary points of each edge."""
    following = np.roll(polygon, -1, axis=0)
    edges = following - polygon
    lengths = np.linalg.norm(edges, axis=1)
    along = edges / lengths[:, None]
    normals = np.column_stack((along[:, 1], -along[:, 0]))
    relative = boundary[:, None, :] - polygon[None, :, :]
    position = (relative * along).sum(axis=2)
    distance = (relative * normals).sum(axis=2)
    margin = np.minimum(1.5 * tolerance, 0.25 * lengths)
    near = (position > margin) & (position < lengths - margin) & (np.abs(distance) < tolerance)
    offsets = (normals * polygon).sum(axis=1)
    for edge in range(len(polygon)):
        chosen = boundary[near[:, edge]]
        if len(chosen) < 6:
            continue
        centre = chosen.mean(axis=0)
        axis = np.linalg.eigh(np.cov((chosen - centre).T))[1][:, 1]
        normal = np.array((axis[1], -axis[0]))
        normal = normal if normal @ normals[edge] > 0.0 else -normal
        if normal @ normals[edge] > 0.94:
            normals[edge], offsets[edge] = normal, normal @ centre
    return normals, offsets


def _corners_of(normals: FloatArray, offsets: FloatArray, growth: float, fallback: FloatArray) -> FloatArray:
    """Intersections of consecutive edges; the unrefined polygon where fitted edges do not meet in order."""
    before_n, before_o = np.roll(normals, 1, axis=0), np.roll(offsets, 1) + growth
    sine = cross(before_n, normals)
    if not (sine.min() > 0.05):
        return fallback
    own = offsets + growth
    x = (before_o * normals[:, 1] - own * before_n[:, 1]) / sine
    y = (own * before_n[:, 0] - before_o * normals[:, 0]) / sine
    corners = np.column_stack((x, y))
    edges = np.roll(corners, -1, axis=0) - corners
    forward = cross(normals, edges)
    return corners if forward.min() > 0.0 else fallback
