"""Geometry of convex polygons."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from singulation_core import InvalidInputError, ResultCode
from singulation_core.polygon import (
    area_centroid,
    bounding_radius,
    contains,
    convex_hull,
    inward_half_planes,
    measured_outline,
    separation,
    signed_area,
    validated_outline,
)

SQUARE = np.array(((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)))
NUMBER = st.floats(-1.0, 1.0, allow_nan=False)


@st.composite
def outlines(draw):
    """Convex counter-clockwise outlines of 3 to 8 vertices, some centimetres in size, anywhere on a table."""
    count = draw(st.integers(3, 8))
    gaps = np.array([draw(st.floats(0.2, 1.0)) for _ in range(count)])
    angles = np.cumsum(gaps) * 2.0 * np.pi / gaps.sum()
    assume(np.diff(angles, append=angles[0] + 2.0 * np.pi).max() < 0.9 * np.pi)
    centre = np.array((draw(NUMBER), draw(NUMBER)))
    return centre + draw(st.floats(0.01, 0.1)) * np.column_stack((np.cos(angles), np.sin(angles)))


def turned(points, angle, shift=(0.0, 0.0)):
    cosine, sine = math.cos(angle), math.sin(angle)
    return points @ np.array(((cosine, sine), (-sine, cosine))) + np.asarray(shift)


def test_square_has_known_area_centroid_and_radius():
    assert signed_area(SQUARE) == pytest.approx(4.0)
    assert signed_area(SQUARE[::-1]) == pytest.approx(-4.0)
    assert area_centroid(SQUARE) == pytest.approx((1.0, 1.0))
    assert bounding_radius(SQUARE, area_centroid(SQUARE)) == pytest.approx(math.sqrt(2.0))


def test_centroid_is_that_of_the_area_and_not_of_the_vertices():
    triangle_with_a_dense_corner = np.array(((0.0, 0.0), (3.0, 0.0), (3.0, 0.01), (2.99, 0.02), (0.0, 3.0)))
    assert area_centroid(triangle_with_a_dense_corner) == pytest.approx((1.0, 1.0), abs=0.01)


def test_centroid_keeps_its_accuracy_far_from_the_origin():
    far = SQUARE * 0.01 + 1000.0
    assert area_centroid(far) == pytest.approx((1000.01, 1000.01), abs=1e-9)


@given(outlines(), st.floats(-math.pi, math.pi), NUMBER, NUMBER)
def test_area_and_centroid_move_with_the_polygon(outline, angle, x, y):
    moved = turned(outline, angle, (x, y))
    assert signed_area(moved) == pytest.approx(signed_area(outline), rel=1e-9)
    assert area_centroid(moved) == pytest.approx(turned(area_centroid(outline), angle, (x, y)), abs=1e-9)


@given(outlines())
def test_convex_outlines_are_accepted_as_they_are_and_read_only(outline):
    checked = validated_outline(outline)
    assert np.array_equal(checked, outline)
    assert not checked.flags.writeable


@given(outlines())
def test_what_is_measured_at_once_is_what_is_measured_alone(outline):
    measured = measured_outline(outline)
    assert np.array_equal(measured.outline, outline)
    assert measured.area == signed_area(outline)
    assert np.array_equal(measured.centroid, area_centroid(outline))
    assert measured.bounding_radius == bounding_radius(outline, measured.centroid)
    assert not measured.centroid.flags.writeable


@pytest.mark.parametrize(
    ("points", "text"),
    [
        ([(0, 0), (1, 0)], "shape"),
        (np.zeros((4, 3)), "shape"),
        ([(0, 0), (1, 0), (1, math.nan)], "vertex 2 is not finite"),
        ([(0, 0), (1, 0), (math.inf, 1)], "not finite"),
        ([(0, 0), (1, 0), (1, 0), (0, 1)], "repeated"),
        ([(0, 0), (0, 0), (0, 0)], "coincide"),
        ([(0, 0), (1, 1), (2, 2)], "one line"),
        (SQUARE[::-1], "clockwise"),
        ([(0, 0), (2, 0), (1, 0.5), (2, 2), (0, 2)], "not convex"),
        ([(0, 0), (1, 1), (1, 0), (0, 1.5)], "block"),
        ([(math.cos(0.8 * math.pi * k), math.sin(0.8 * math.pi * k)) for k in range(5)], "crosses itself"),
    ],
)
def test_malformed_outlines_are_refused_by_name(points, text):
    with pytest.raises(InvalidInputError, match=text) as caught:
        validated_outline(points, "block 7")
    assert caught.value.code is ResultCode.INVALID_INPUT
    assert "block 7" in caught.value.message
    assert len(validated_outline(SQUARE)) == 4


@given(st.lists(st.tuples(st.integers(-50, 50), st.integers(-50, 50)), min_size=3, max_size=30, unique=True))
def test_hull_is_convex_and_contains_its_points(points):
    hull = convex_hull(points)
    assume(len(hull) >= 3 and signed_area(hull) > 1e-3)
    assert validated_outline(hull) is not None
    assert contains(hull, points, margin=-1e-9).all()


def test_hull_leaves_out_inner_and_collinear_points():
    points = [*SQUARE.tolist(), (1.0, 1.0), (1.0, 0.0), (2.0, 1.0), (0.0, 0.0)]
    assert sorted(convex_hull(points).tolist()) == sorted(SQUARE.tolist())
    assert len(convex_hull([(0, 0), (1, 1), (2, 2)])) < 3


def test_contains_respects_its_margin():
    points = [(1.0, 1.0), (0.1, 1.0), (-0.1, 1.0), (2.05, 1.0)]
    assert contains(SQUARE, points).tolist() == [True, True, False, False]
    assert contains(SQUARE, points, margin=0.2).tolist() == [True, False, False, False]
    assert contains(SQUARE, points, margin=-0.2).all()


@given(outlines())
def test_half_planes_hold_the_centroid_and_touch_every_vertex(outline):
    normals, offsets = inward_half_planes(outline)
    assert np.hypot(*normals.T) == pytest.approx(np.ones(len(outline)))
    assert (normals @ area_centroid(outline) > offsets).all()
    assert (normals @ outline.T - offsets[:, None]).min(axis=0) == pytest.approx(np.zeros(len(outline)), abs=1e-9)


@pytest.mark.parametrize(
    ("shift", "gap"),
    [((3.0, 0.0), 1.0), ((5.0, 6.0), 5.0), ((2.0, 0.5), 0.0), ((1.5, 0.0), -0.5), ((0.0, 1.9), -0.1)],
)
def test_separation_of_two_squares(shift, gap):
    assert separation(SQUARE, SQUARE + np.array(shift)) == pytest.approx(gap, abs=1e-12)


@given(outlines(), outlines(), st.floats(-math.pi, math.pi), NUMBER, NUMBER)
def test_separation_is_symmetric_and_moves_with_the_scene(first, second, angle, x, y):
    gap = separation(first, second)
    assert separation(second, first) == pytest.approx(gap, abs=1e-12)
    assert separation(turned(first, angle, (x, y)), turned(second, angle, (x, y))) == pytest.approx(gap, abs=1e-9)


@given(outlines(), outlines())
def test_moving_two_outlines_apart_by_their_gap_makes_them_touch(first, second):
    gap = separation(first, second)
    assume(gap > 1e-6)
    towards = area_centroid(first) - area_centroid(second)
    towards /= np.hypot(*towards)
    # Any straight way towards the other is at least as long as the gap.
    assert separation(first, second + 0.999 * gap * towards) > 0.0
