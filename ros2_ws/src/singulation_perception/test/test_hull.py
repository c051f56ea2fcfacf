import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core.polygon import convex_hull, signed_area
from singulation_perception.hull import hull_indices
from singulation_perception.jit import compiled_maker
from singulation_perception.rings import least_width


@compiled_maker
def hull_of(ring):
    return hull_indices(ring)


@compiled_maker
def width_of(ring):
    return least_width(ring, hull_indices(ring))


@given(st.integers(0, 10_000), st.integers(1, 60), st.sampled_from([4, 30, 1_000_000]))
@settings(max_examples=60, deadline=None)
def test_hull_has_the_corners_of_the_monotone_chain_in_their_order(seed, count, places):
    points = np.random.default_rng(seed).integers(0, places, (count, 2)).astype(np.float64)
    hull = points[hull_of(points)]
    expected = convex_hull(points)
    if len(expected) < 3:
        assert len(hull) == len(expected)
        return
    assert len(np.unique(hull, axis=0)) == len(hull)
    corners = hull[[any((point == expected).all(axis=1)) for point in hull]]  # others lie on an edge
    start = int(np.flatnonzero((corners == expected[0]).all(axis=1))[0])
    np.testing.assert_array_equal(np.roll(corners, -start, axis=0), expected)
    assert signed_area(hull) == pytest.approx(signed_area(expected))


@given(st.integers(0, 10_000), st.integers(3, 60), st.sampled_from([4, 30, 1_000_000]))
@settings(max_examples=60, deadline=None)
def test_the_least_width_is_that_of_the_best_of_all_edges(seed, count, places):
    points = np.random.default_rng(seed).integers(0, places, (count, 2)).astype(np.float64)
    hull = convex_hull(points)
    if len(hull) < 3:
        return
    widths = []
    for start, stop in zip(hull, np.roll(hull, -1, axis=0), strict=True):
        along = (stop - start) / np.hypot(*(stop - start))
        widths.append((along[0] * (hull[:, 1] - start[1]) - along[1] * (hull[:, 0] - start[0])).max())
    assert width_of(points) == pytest.approx(min(widths), rel=1e-9)


@pytest.mark.parametrize("points", [np.empty((0, 2)), np.ones((5, 2))], ids=["none", "all in one place"])
def test_points_without_extent_have_no_more_than_one_corner(points):
    assert len(hull_of(points)) == min(1, len(points))


def test_line_has_its_two_ends():
    line = np.column_stack((np.arange(9.0), 2.0 * np.arange(9.0)))
    assert sorted(hull_of(line)) == [0, 8]
