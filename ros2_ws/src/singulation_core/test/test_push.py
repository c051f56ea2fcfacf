"""Pushes, jaws and contact modes."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from singulation_core import (
    ContactMode,
    InvalidInputError,
    Push,
    PusherGeometry,
    ResultCode,
    SingulationError,
    contact_mode,
)

POINT, EDGE, TWO = ContactMode
COORDINATE = st.floats(-1.0, 1.0)


@given(COORDINATE, COORDINATE, st.floats(-math.pi, math.pi), st.floats(1e-3, 0.5))
def test_length_and_direction_follow_from_start_and_end(x, y, angle, length):
    way = length * np.array((math.cos(angle), math.sin(angle)))
    push = Push((x, y), (x, y) + way, POINT)
    assert push.length == pytest.approx(length, rel=1e-9)
    assert push.direction == pytest.approx(way / length, abs=1e-9)
    assert math.isnan(push.expected_gain)


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"end": (0.0, 0.0)}, "coincide"),
        ({"start": (math.nan, 0.0)}, "start"),
        ({"end": (math.inf, 0.0)}, "end"),
        ({"end": (1.0, 0.0, 0.0)}, "two finite numbers"),
        ({"contact_width": 0.01}, "single_point"),
        ({"contact_mode": EDGE}, "positive for the others"),
        ({"contact_mode": TWO, "contact_width": -0.01}, "contact width"),
        ({"contact_mode": TWO, "contact_width": math.nan}, "contact width"),
        ({"contact_mode": EDGE, "contact_width": math.inf}, "contact width"),
    ],
)
def test_malformed_pushes_are_refused(values, text):
    good = {"start": (0.0, 0.0), "end": (0.1, 0.0), "contact_mode": POINT}
    with pytest.raises(InvalidInputError, match=text):
        Push(**{**good, **values})
    assert Push(**good).length == pytest.approx(0.1)


def test_points_cannot_be_changed():
    push = Push((0.0, 0.0), (0.1, 0.0), EDGE, 0.02)
    with pytest.raises(ValueError, match="read-only"):
        push.start[0] = 1.0


@pytest.mark.parametrize("name", ["tip_radius", "edge_width", "edge_thickness"])
@pytest.mark.parametrize("value", [0.0, -0.001, math.nan, math.inf])
def test_jaws_without_a_size_are_refused(name, value):
    with pytest.raises(InvalidInputError, match=name):
        PusherGeometry(**{name: value})
    assert getattr(PusherGeometry(), name) > 0.0


@pytest.mark.parametrize("value", ["two_point", "TWO_POINT", 2, TWO])
def test_contact_modes_by_name_and_number(value):
    assert contact_mode(value) is TWO


@pytest.mark.parametrize("value", ["suction", 3, -1, ""])
def test_an_unknown_contact_mode_is_refused_with_the_valid_ones(value):
    with pytest.raises(SingulationError, match=r"single_point \(0\), edge \(1\), two_point \(2\)") as caught:
        contact_mode(value)
    assert caught.value.code is ResultCode.UNKNOWN_CONTACT_MODE
    assert contact_mode("edge") is EDGE
