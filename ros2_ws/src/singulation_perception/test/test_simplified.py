"""Douglas-Peucker in compiled code, beside OpenCV's."""

import cv2
import numpy as np
import pytest

from singulation_core.polygon import convex_hull
from singulation_perception.jit import compiled_maker
from singulation_perception.simplified import simplified

TOLERANCE = 0.0012  # m


@compiled_maker
def corners_of(ring, tolerance):
    return simplified(ring, tolerance)


def noisy_ring(seed, hull):
    """A block's rim as a camera sees it: 0.7 mm apart, 0.2 mm noise; or its convex hull."""
    random = np.random.default_rng(seed)
    angles = np.sort(random.uniform(0.0, 2.0 * np.pi, random.integers(3, 8)))
    block = 0.02 * np.column_stack((np.cos(angles), np.sin(angles)))
    sides = []
    for begin, end in zip(block, np.roll(block, -1, axis=0), strict=True):
        count = max(2, int(np.hypot(*(end - begin)) / 0.0007))
        sides.append(begin + (end - begin) * np.linspace(0.0, 1.0, count, endpoint=False)[:, None])
    rim = np.vstack(sides)
    ring = (rim + random.normal(0.0, 0.0002, rim.shape)).astype(np.float32).astype(np.float64)
    return np.ascontiguousarray(convex_hull(ring) if hull else ring)


def places(points):
    return set(map(tuple, points.astype(np.float32).tolist()))


@pytest.mark.parametrize("hull", [False, True], ids=["rim", "hull"])
def test_the_corners_are_those_of_opencv(hull):
    """Where two points are nearly as far, or one hardly stands out, the two may choose differently."""
    same = 0
    for seed in range(300):
        ring = noisy_ring(seed, hull)
        expected = cv2.approxPolyDP(ring.astype(np.float32)[:, None], TOLERANCE, True)[:, 0]
        same += places(ring[corners_of(ring, TOLERANCE)]) == places(expected)
    assert same >= 285


@pytest.mark.parametrize("hull", [False, True], ids=["rim", "hull"])
def test_no_point_is_far_from_what_is_left(hull):
    for seed in range(300, 600):
        ring = noisy_ring(seed, hull)
        kept = corners_of(ring, TOLERANCE)
        assert np.all(np.diff(kept) > 0)
        left = ring[kept].astype(np.float32)
        distances = [cv2.pointPolygonTest(left, (float(x), float(y)), True) for x, y in ring]
        # A corner that hardly stands out goes after the others were chosen: by up to 0.71 of the tolerance again.
        assert np.abs(distances).max() <= 1.71 * TOLERANCE
