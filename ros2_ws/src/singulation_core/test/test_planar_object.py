"""A block and what is derived from its outline."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from singulation_core import InvalidInputError, PlanarObject
from singulation_core.polygon import measured_outline

RECTANGLE = np.array(((0.0, 0.0), (0.04, 0.0), (0.04, 0.02), (0.0, 0.02)))


def test_centroid_radius_and_area_follow_from_the_outline():
    block = PlanarObject(3, RECTANGLE, height=0.03)
    assert block.centroid == pytest.approx((0.02, 0.01))
    assert block.bounding_radius == pytest.approx(math.hypot(0.02, 0.01))
    assert block.area == pytest.approx(8e-4)


def test_a_list_of_vertices_is_copied_and_cannot_be_changed():
    given_outline = RECTANGLE.copy()
    block = PlanarObject(0, given_outline)
    given_outline[0] = 99.0
    assert block.centroid == pytest.approx((0.02, 0.01))
    with pytest.raises(ValueError, match="read-only"):
        block.outline[0, 0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        block.centroid[0] = 1.0


@given(st.floats(-3.2, 3.2), st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
def test_moving_and_moving_back_gives_the_same_block(angle, x, y):
    block = PlanarObject(1, RECTANGLE, 0.02, 55, 0.5)
    moved = block.moved((x, y), angle)
    assert moved.centroid == pytest.approx(block.centroid + (x, y), abs=1e-12)
    assert moved.area == pytest.approx(block.area)
    assert (moved.id, moved.height, moved.point_count, moved.confidence) == (1, 0.02, 55, 0.5)
    assert moved.moved((-x, -y), -angle).outline == pytest.approx(block.outline, abs=1e-12)


def test_a_quarter_turn_is_counter_clockwise():
    turned = PlanarObject(1, RECTANGLE).moved((0.0, 0.0), math.pi / 2)
    assert turned.outline[0] == pytest.approx((0.03, -0.01))


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"id": -1}, "id out of range"),
        ({"id": 2**32}, "id out of range"),
        ({"height": math.nan}, "height"),
        ({"height": -0.001}, "height"),
        ({"height": math.inf}, "height"),
        ({"confidence": 1.1}, "confidence"),
        ({"confidence": math.nan}, "confidence"),
        ({"outline": RECTANGLE[::-1]}, "object 5: clockwise"),
        ({"outline": RECTANGLE * math.nan}, "object 5: vertex 0 is not finite"),
    ],
)
def test_malformed_blocks_are_refused_by_name(values, text):
    with pytest.raises(InvalidInputError, match=text):
        PlanarObject(**{"id": 5, "outline": RECTANGLE, **values})
    assert PlanarObject(5, RECTANGLE).id == 5


def test_an_object_of_a_measured_outline_is_the_one_of_the_outline():
    block = PlanarObject.measured(7, measured_outline(RECTANGLE), 0.03, 12, 0.5)
    plain = PlanarObject(7, RECTANGLE, 0.03, 12, 0.5)
    assert vars(block).keys() == vars(plain).keys()
    for name, value in vars(plain).items():
        np.testing.assert_array_equal(getattr(block, name), value)


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ((-1, 0.02, 1, 0.5), "object -1: id out of range, need 0 <= id < 2**32"),
        ((3, math.nan, 1, 0.5), "object 3: height nan m, need a finite one >= 0"),
        ((3, 0.02, 1, 1.5), "object 3: confidence 1.5, need 0..1"),
    ],
)
def test_a_measured_outline_does_not_excuse_the_rest(values, text):
    number, *others = values
    with pytest.raises(InvalidInputError) as caught:
        PlanarObject.measured(number, measured_outline(RECTANGLE), *others)
    assert str(caught.value) == f"INVALID_INPUT (5): {text}"
    assert PlanarObject.measured(3, measured_outline(RECTANGLE), 0.02, 1, 0.5).id == 3
