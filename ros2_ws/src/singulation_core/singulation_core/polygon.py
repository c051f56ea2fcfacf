"""Geometry of convex polygons in the plane. Outlines are (k, 2) float64, counter-clockwise, metres."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from singulation_core.errors import InvalidInputError

FloatArray = NDArray[np.float64]

# A vertex may lie this share of the outline's size inside the line through its neighbours: an outline that came as
# float32 (geometry_msgs/Polygon) has straight edges bent by rounding.
_CONVEXITY_SLACK = 1e-5


def cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Two-dimensional cross product over the last axis of (..., 2) arrays."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


class MeasuredOutline(NamedTuple):
    """A convex, counter-clockwise outline and what follows from it.

    Attributes:
        outline: (k, 2) vertices [m], read-only.
        area: [m^2].
        centroid: (2,) of the area [m], read-only.
        bounding_radius: largest distance of the centroid to a vertex [m] (paper, section V-A).
    """

    outline: FloatArray
    area: float
    centroid: FloatArray
    bounding_radius: float


def signed_area(outline: FloatArray) -> float:
    """Area of a (k, 2) polygon, positive when counter-clockwise [m^2]."""
    return _moments(outline.tolist())[0]


def area_centroid(outline: FloatArray) -> FloatArray:
    """Centroid of the area of a (k, 2) polygon, shape (2,) [m]."""
    return np.array(_moments(outline.tolist())[1:])


def bounding_radius(outline: FloatArray, centre: FloatArray) -> float:
    """Largest distance of ``centre`` to a vertex [m] (paper, section V-A)."""
    return _farthest(outline.tolist(), float(centre[0]), float(centre[1]))


# What is asked of every outline is in plain Python: for a few vertices it is ten times as fast as NumPy.
def _moments(corners: list[list[float]]) -> tuple[float, float, float]:
    """Signed area [m^2] and x, y of its centroid [m], which are NaN if there is no area."""
    x0, y0 = corners[0]
    total, x, y = 0.0, 0.0, 0.0
    ax, ay = 0.0, 0.0
    for x1, y1 in corners:
        bx, by = x1 - x0, y1 - y0
        weight = ax * by - ay * bx
        total, x, y = total + weight, x + weight * (ax + bx), y + weight * (ay + by)
        ax, ay = bx, by
    scale = 1.0 / (3.0 * total) if total != 0.0 else math.nan
    return 0.5 * total, x0 + x * scale, y0 + y * scale


def _farthest(corners: list[list[float]], x: float, y: float) -> float:
    return max([math.hypot(ax - x, ay - y) for ax, ay in corners])


def validated_outline(outline: ArrayLike, name: str = "outline") -> FloatArray:
    """A read-only (k, 2) float64 copy of a convex, counter-clockwise outline.

    Raises:
        InvalidInputError: as ``measured_outline``.
    """
    return measured_outline(outline, name).outline


def measured_outline(outline: ArrayLike, name: str = "outline") -> MeasuredOutline:
    """A copy of a convex, counter-clockwise outline, with its area, centroid and bounding radius.

    Raises:
        InvalidInputError: fewer than three vertices, not finite, repeated vertices, no area,
            clockwise, self-intersecting or not convex; the text starts with ``name``.
    """
    points = np.array(outline, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3:
        raise InvalidInputError(f"{name}: shape {points.shape}, need (k >= 3, 2)")
    corners: list[list[float]] = points.tolist()
    across, up = zip(*corners, strict=True)
    if not math.isfinite(sum(across) + sum(up)) and not np.isfinite(points).all():
        raise InvalidInputError(f"{name}: vertex {_first_bad(points)} is not finite")
    size = max(max(across) - min(across), max(up) - min(up))
    edges = [(bx - ax, by - ay) for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True)]
    lengths = [math.hypot(x, y) for x, y in edges]
    if not (min(lengths) > 1e-9 * size):
        raise InvalidInputError(f"{name}: vertex {lengths.index(min(lengths))} is repeated or all coincide")
    area, x, y = _moments(corners)
    if not (abs(area) > 1e-9 * size * size):
        raise InvalidInputError(f"{name}: area {area:.3g} m^2, the vertices lie on one line")
    if area < 0.0:
        raise InvalidInputError(f"{name}: clockwise, need counter-clockwise")
    _require_convex(edges, size, name)
    centroid = np.array((x, y))
    points.flags.writeable = centroid.flags.writeable = False
    return MeasuredOutline(points, area, centroid, _farthest(corners, x, y))


def _first_bad(points: FloatArray) -> int:
    return int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])


def _require_convex(edges: list[tuple[float, float]], size: float, name: str) -> None:
    """Every turn to the left and one full turn in all, else it crosses itself."""
    dents, turned = [], 0.0
    ax, ay = edges[-1]
    for vertex, (bx, by) in enumerate(edges):
        turn = ax * by - ay * bx
        if not (turn > 0.0):
            dents.append((-turn / max(math.hypot(ax + bx, ay + by), 1e-12 * size), vertex))
        turned += math.atan2(turn, ax * bx + ay * by)
        ax, ay = bx, by
    inside, vertex = max(dents, default=(0.0, 0))
    if not (inside <= _CONVEXITY_SLACK * size):
        raise InvalidInputError(f"{name}: not convex at vertex {vertex} ({inside:.3g} m inside)")
    full_turns = turned / (2.0 * math.pi)
    if not (abs(full_turns - 1.0) < 1e-3):
        raise InvalidInputError(f"{name}: crosses itself ({full_turns:.1f} turns, need 1)")


def convex_hull(points: ArrayLike) -> FloatArray:
    """Counter-clockwise convex hull of (m, 2) points without collinear vertices, (k, 2).

    Andrew's monotone chain. Fewer than three rows come back for points on one line.
    """
    ordered = np.unique(np.asarray(points, dtype=np.float64), axis=0)
    if len(ordered) < 3:
        return ordered
    return np.array(_chain(ordered)[:-1] + _chain(ordered[::-1])[:-1])


def _chain(points: FloatArray) -> list[FloatArray]:
    chain: list[FloatArray] = []
    for point in points:
        while len(chain) >= 2 and cross(chain[-1] - chain[-2], point - chain[-2]) <= 0.0:
            chain.pop()
        chain.append(point)
    return chain


def contains(outline: FloatArray, points: ArrayLike, margin: float = 0.0) -> NDArray[np.bool_]:
    """Which of (m, 2) points lie inside the convex outline, at least ``margin`` [m] from its edges."""
    tested = np.atleast_2d(np.asarray(points, dtype=np.float64))
    normals, offsets = inward_half_planes(outline)
    return np.asarray((tested @ normals.T - offsets >= margin).all(axis=1))


def inward_half_planes(outline: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unit inward normals (k, 2) and offsets (k,): inside is ``normal . x >= offset``."""
    edges = np.roll(outline, -1, axis=0) - outline
    normals = np.column_stack((-edges[:, 1], edges[:, 0]))
    normals /= np.hypot(normals[:, 0], normals[:, 1])[:, None]
    return normals, (normals * outline).sum(axis=1)


def separation(first: FloatArray, second: FloatArray) -> float:
    """Signed gap between two convex outlines [m]: distance if apart, minus the penetration depth if not."""
    deepest = max(_best_axis(first, second), _best_axis(second, first))
    if deepest <= 0.0:
        return deepest
    return min(_vertex_edge_distance(first, second), _vertex_edge_distance(second, first))


def _best_axis(first: FloatArray, second: FloatArray) -> float:
    """Largest separation along the edge normals of ``first``."""
    normals, offsets = inward_half_planes(first)
    return float((offsets[:, None] - normals @ second.T).min(axis=1).max())


def _vertex_edge_distance(polygon: FloatArray, vertices: FloatArray) -> float:
    """Smallest distance of any of the vertices to any edge of the polygon."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    relative = vertices[:, None, :] - polygon[None, :, :]
    along = (relative * edges).sum(axis=2) / (edges**2).sum(axis=1)
    nearest = np.clip(along, 0.0, 1.0)[..., None] * edges
    return float(np.sqrt(((relative - nearest) ** 2).sum(axis=2).min()))
