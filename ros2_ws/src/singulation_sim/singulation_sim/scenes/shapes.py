"""Outlines of single blocks, centred on their area centroid, not turned."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from singulation_core.polygon import FloatArray, area_centroid, bounding_radius, convex_hull

Shape = Callable[[np.random.Generator], FloatArray]

_RADIUS = (0.022, 0.032)  # m; bounding radii of random polygons, as large as the wooden blocks
_SLIMMEST = 0.35  # smallest distance of the centroid to an edge, in bounding radii
# Smallest and largest vertex radius, number of vertices, of the benchmark's four groups (the authors' generator).
_GROUPS = ((1.0, 1.0, 15), (0.75, 1.0, 12), (0.5, 1.0, 9), (0.25, 1.0, 6))


def square(rng: np.random.Generator) -> FloatArray:
    """Square of 35 to 45 mm."""
    side = rng.uniform(0.035, 0.045)
    return _centred(np.array(((0.0, 0.0), (side, 0.0), (side, side), (0.0, side))))


def rectangle(rng: np.random.Generator) -> FloatArray:
    """Rectangle, 50 to 65 mm by 25 to 35 mm."""
    length, width = rng.uniform(0.05, 0.065), rng.uniform(0.025, 0.035)
    return _centred(np.array(((0.0, 0.0), (length, 0.0), (length, width), (0.0, width))))


def triangle(rng: np.random.Generator) -> FloatArray:
    """Isosceles right triangle with legs of 45 to 60 mm."""
    leg = rng.uniform(0.045, 0.06)
    return _centred(np.array(((0.0, 0.0), (leg, 0.0), (0.0, leg))))


def polygon_of(group: int) -> Shape:
    """Random convex polygons of the benchmark's group 0 (round) to 3 (most eccentric)."""
    smallest, largest, count = _GROUPS[group]

    def polygon(rng: np.random.Generator) -> FloatArray:
        while True:
            angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
            radii = rng.uniform(smallest, largest, count)
            hull = convex_hull(radii[:, None] * np.column_stack((np.cos(angles), np.sin(angles))))
            if len(hull) >= 3:
                outline = _centred(hull)
                outline *= rng.uniform(*_RADIUS) / bounding_radius(outline, np.zeros(2))
                if _inner_radius(outline) > _SLIMMEST * bounding_radius(outline, np.zeros(2)):
                    return outline

    return polygon


SHAPES: Mapping[str, Shape] = MappingProxyType(
    {"square": square, "rectangle": rectangle, "triangle": triangle} | {f"group_{k}": polygon_of(k) for k in range(4)}
)


def _centred(outline: FloatArray) -> FloatArray:
    return np.asarray(outline - area_centroid(outline))


def _inner_radius(outline: FloatArray) -> float:
    """Smallest distance of the origin to a side."""
    edges = np.roll(outline, -1, axis=0) - outline
    return float(((outline[:, 0] * edges[:, 1] - outline[:, 1] * edges[:, 0]) / np.hypot(*edges.T)).min())
