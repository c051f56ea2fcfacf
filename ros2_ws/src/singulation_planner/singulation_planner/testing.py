"""Scenes for tests and timing: touching clutter of convex blocks."""

from collections.abc import Sequence

import numpy as np

from singulation_core import Arrangement, PlanarObject
from singulation_core.polygon import FloatArray, convex_hull, separation

_RADIUS = 0.02  # m


def block(number: int, random: np.random.Generator, size: float = 1.0) -> PlanarObject:
    """A convex block of about 20 mm times ``size`` bounding radius around the origin."""
    while True:
        count = int(random.integers(4, 10))
        angles, radii = random.uniform(0.0, 2.0 * np.pi, count), random.uniform(0.6, 1.0, count)
        hull = convex_hull(_RADIUS * size * radii[:, None] * np.column_stack((np.cos(angles), np.sin(angles))))
        if len(hull) < 3:
            continue
        made = PlanarObject(number, hull)
        if made.area > 0.5 * (_RADIUS * size) ** 2:
            return PlanarObject(number, hull - made.centroid)


def clutter(count: int, seed: int, size: float = 1.0) -> Arrangement:
    """``count`` blocks side by side around the origin."""
    random = np.random.default_rng(seed)
    placed: list[PlanarObject] = []
    while len(placed) < count:
        item = block(len(placed), random, size)
        away = random.uniform(0.0, 2.0 * np.pi)
        way = np.array((np.cos(away), np.sin(away)))
        distance = _first_free(item, way, placed, 0.1 * _RADIUS * size, 1e-4 * size)
        placed.append(item.moved(distance * way))
    middle = np.mean([item.centroid for item in placed], axis=0)
    return Arrangement([item.moved(-middle) for item in placed])


def _first_free(item: PlanarObject, way: FloatArray, placed: list[PlanarObject], step: float, gap: float) -> float:
    """How far along ``way`` from the origin the block first has a gap to all others [m]."""
    distance = 0.0
    while True:
        outline = item.outline + distance * way
        reach = [item.bounding_radius + other.bounding_radius + gap for other in placed]
        near = [
            other
            for other, limit in zip(placed, reach, strict=True)
            if np.hypot(*(distance * way - other.centroid)) < limit
        ]
        if all(separation(outline, other.outline) > gap for other in near):
            return distance
        distance += step


def turned_squares(count: int, seed: int) -> Arrangement:
    """``count`` congruent squares lying about in all directions, as wooden blocks of one kind do."""
    random, side = np.random.default_rng(seed), squares([(0.0, 0.0)]).objects[0].outline
    placed: list[PlanarObject] = []
    while len(placed) < count:
        shift = random.uniform(-_RADIUS, _RADIUS, 2) * np.sqrt(count)
        item = PlanarObject(len(placed), side).moved(shift, random.uniform(0.0, 2.0 * np.pi))
        if all(separation(item.outline, other.outline) > 0.0 for other in placed):
            placed.append(item)
    return Arrangement(placed)


def squares(centres: Sequence[tuple[float, float]], half: float = 0.01) -> Arrangement:
    """Axis-parallel squares at the given centres [m]."""
    corners = half * np.array(((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)))
    return Arrangement([PlanarObject(number, corners + np.array(at)) for number, at in enumerate(centres)])
