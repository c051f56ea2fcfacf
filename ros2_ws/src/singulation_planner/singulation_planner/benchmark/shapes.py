"""Random blocks of the paper's four groups of eccentricity (section V-A, figure 4)."""

import numpy as np

from singulation_core.polygon import FloatArray, area_centroid, bounding_radius, convex_hull, signed_area

# Smallest and largest vertex radius and number of vertices of groups 0..3, as in the authors' generator.
GROUPS = ((1.0, 1.0, 15), (0.75, 1.0, 12), (0.5, 1.0, 9), (0.25, 1.0, 6))
_SMALLEST_AREA = 0.05  # of the unit square; thinner ones are drawn again


def random_outline(group: int, random: np.random.Generator) -> FloatArray:
    """(k, 2) convex outline of a random block around its listed centroid, bounding radius about 1.

    Vertices at uniform angles and uniform radii, scaled so that the one furthest from the area centroid of the list is
    at distance 1. The list may be non-convex; the block is its convex hull, as in the authors' simulator, so that its
    own bounding radius differs a little from 1.
    """
    smallest, largest, count = GROUPS[group]
    while True:
        angles = np.sort(random.uniform(0.0, 2.0 * np.pi, count))
        radii = random.uniform(smallest, largest, count)
        listed = np.stack((np.cos(angles), np.sin(angles)), axis=1) * radii[:, None]
        if signed_area(listed) < _SMALLEST_AREA:  # all vertices on one side: a sliver, or turned inside out
            continue
        centre = area_centroid(listed)
        hull = convex_hull((listed - centre) / bounding_radius(listed, centre))
        if signed_area(hull) >= _SMALLEST_AREA:
            return hull
