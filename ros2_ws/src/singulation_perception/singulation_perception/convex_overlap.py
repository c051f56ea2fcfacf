"""Area that two convex outlines share, compiled: neighbours are compared in every cloud."""

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.edge_fit import edges_of
from singulation_perception.jit import compiled
from singulation_perception.rings import ring_area


@compiled
def shared_area(one: FloatArray, two: FloatArray) -> float:
    """Area of the intersection of two convex counter-clockwise outlines [m^2] (Sutherland and Hodgman 1974)."""
    room = len(one) + len(two) + 2
    points, kept = np.empty((room, 2)), np.empty((room, 2))
    count = len(one)
    for i in range(count):
        points[i, 0], points[i, 1] = one[i, 0], one[i, 1]
    lines = edges_of(two)
    for k in range(len(lines)):
        size = 0
        for i in range(count):
            j = i + 1 if i + 1 < count else 0
            a = lines[k, 2] - lines[k, 0] * points[i, 0] - lines[k, 1] * points[i, 1]
            b = lines[k, 2] - lines[k, 0] * points[j, 0] - lines[k, 1] * points[j, 1]
            if a >= 0.0 and size < room:
                kept[size, 0], kept[size, 1] = points[i, 0], points[i, 1]
                size += 1
            if a * b < 0.0 and size < room:
                f = a / (a - b)
                kept[size, 0] = points[i, 0] + f * (points[j, 0] - points[i, 0])
                kept[size, 1] = points[i, 1] + f * (points[j, 1] - points[i, 1])
                size += 1
        points, kept, count = kept, points, size
    return max(0.0, ring_area(points[:count])) if count > 2 else 0.0
