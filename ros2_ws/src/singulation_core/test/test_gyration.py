"""Moment of inertia over mass of polygons."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core.gyration import squared_gyration

RECTANGLE = np.array(((0.0, 0.0), (0.04, 0.0), (0.04, 0.02), (0.0, 0.02)))


def test_a_rectangle_about_its_middle_and_about_another_point():
    about_middle = (0.04**2 + 0.02**2) / 12.0
    assert squared_gyration(RECTANGLE, 0, 4, 0.02, 0.01) == pytest.approx(about_middle)
    assert squared_gyration(RECTANGLE, 0, 4, 0.0, 0.0) == pytest.approx(about_middle + 0.02**2 + 0.01**2)


@settings(deadline=None)
@given(st.floats(-np.pi, np.pi), st.floats(-1.0, 1.0))
def test_turned_and_moved_among_other_vertices_it_stays_the_same(angle, shift):
    turn = np.array(((np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle))))
    moved = RECTANGLE @ turn.T + shift
    vertices = np.concatenate((RECTANGLE[:3], moved))
    found = squared_gyration(vertices, 3, 7, *moved.mean(axis=0))
    assert found == pytest.approx((0.04**2 + 0.02**2) / 12.0)
