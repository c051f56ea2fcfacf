"""Compiled measures of outlines against the ones that every object of an arrangement is measured with."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from ros2_ws.src.singulation_perception.test.table_top import box, turned

from singulation_core import InvalidInputError
from singulation_core.polygon import area_centroid, bounding_radius, convex_hull, measured_outline, signed_area
from singulation_perception.piles import cut_off
from singulation_perception.shapes import meeting_pairs, shape_of, shared_area

NUMBERS = st.floats(-0.3, 0.3, allow_subnormal=False)


@st.composite
def outlines(draw):
    """Convex, of at least a square millimetre."""
    hull = convex_hull(draw(st.lists(st.tuples(NUMBERS, NUMBERS), min_size=3, max_size=12)))
    if len(hull) < 3 or signed_area(hull) < 1e-6:
        hull = hull[0] + np.array(((0.0, 0.0), (0.02, 0.0), (0.01, 0.02)))
    return np.ascontiguousarray(hull)


@pytest.mark.parametrize("angle", [0.0, 0.5, 1.3])
def test_a_square_is_as_long_as_its_side_and_a_right_triangle_as_its_longer_leg(angle):
    square, triangle = box(0.0, 0.0, 0.04, 0.04), np.array(((0.0, 0.0), (0.06, 0.0), (0.0, 0.03)))
    assert shape_of(turned(square, angle)).length == pytest.approx(0.04)
    assert shape_of(turned(triangle, angle)).length == pytest.approx(0.06)


@given(outline=outlines())
def test_centre_and_radius_are_those_of_the_object(outline):
    shape, centre = shape_of(outline), area_centroid(outline)
    assert (shape.x, shape.y) == pytest.approx(tuple(centre), abs=1e-9)
    assert shape.radius == pytest.approx(bounding_radius(outline, centre), abs=1e-9)


TINY = np.array(((-1e-259, 0.0), (0.0, -1e-147), (0.25, 0.0), (0.0, 0.25)))  # products of such numbers are 0


@given(sides=st.integers(3, 40), size=st.floats(1e-3, 0.3), angle=st.floats(0.0, 7.0), x=NUMBERS, y=NUMBERS)
def test_regular_polygons_are_plain_and_have_an_area(sides, size, angle, x, y):
    ways = angle + 2.0 * np.pi * np.arange(sides) / sides
    outline = np.column_stack((x + size * np.cos(ways), y + size * np.sin(ways)))
    assert shape_of(outline).area == pytest.approx(signed_area(outline))


@given(corners=st.lists(st.tuples(*[NUMBERS | st.sampled_from((0.0, 0.1, np.nan))] * 2), min_size=3, max_size=7))
@example(corners=[(np.cos(k * 0.8 * np.pi), np.sin(k * 0.8 * np.pi)) for k in range(5)])  # a star, twice around
@example(corners=[(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.05, 0.04), (0.0, 0.1)])  # a dent
@example(corners=[(0.0, 0.0), (0.0, 0.1), (0.1, 0.1), (0.1, 0.0)])  # clockwise
@example(corners=[(0.0, 0.0), (0.1, 1e-12), (0.2, 1e-11)])  # a line
@example(corners=[(0.0, 0.0), (0.1, 0.0), (0.1, 1e-12), (0.0, 0.1)])  # a corner twice
@example(corners=[(0.1, 0.2), (0.25, 0.05), (0.3, 0.0), (0.3, 0.3)])  # a corner that is none but for rounding
def test_what_is_plain_passes_the_checks_of_every_object(corners):
    outline = np.array(corners)
    shape = shape_of(outline)
    try:
        measured = measured_outline(outline)
    except InvalidInputError:
        assert np.isnan(shape.area)
    else:
        assert np.isnan(shape.area) or shape.area == pytest.approx(measured.area, rel=1e-9)


@given(one=outlines(), two=outlines())
@example(one=np.array(((-1e-147, 0.0), (0.02, 0.0), (0.01, 0.02))), two=TINY)
def test_what_two_outlines_share_is_what_the_edges_of_one_leave_of_the_other(one, two):
    left = two
    for start, stop in zip(one, np.roll(one, -1, axis=0), strict=True):
        normal = np.array((start[1] - stop[1], stop[0] - start[0]))
        left = cut_off(left, normal, float(normal @ start)) if len(left) > 2 else left
    expected = signed_area(left) if len(left) > 2 else 0.0
    shared, own, others = shared_area(one, two)
    assert shared == pytest.approx(expected, abs=1e-8)
    assert (own, others) == pytest.approx((signed_area(one), signed_area(two)))


def test_pairs_are_those_of_different_height_whose_circles_meet():
    places = ((0.0, 0.0), (0.05, 0.0), (0.2, 0.0), (0.0, 0.05))
    shapes = np.array([(x, y, 0.03, 0.0, 0.0) for x, y in places])
    heights = np.array((0.02, 0.03, 0.04, 0.0205))
    assert meeting_pairs(shapes, heights, 0.001).tolist() == [[0, 1]]
    assert meeting_pairs(shapes[:0], heights[:0], 0.001).tolist() == []


def test_a_corner_on_the_line_of_a_cut_is_there_once():
    diamond = np.array(((0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)))
    assert cut_off(diamond, np.array((0.0, 1.0)), 0.0).tolist() == [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]]
