"""Interpolation between trajectory points."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from singulation_sim.driver.spline import Spline
from singulation_sim.driver.trajectory import TrajectoryPoint, point

numbers = st.floats(-3.0, 3.0)
durations = st.floats(0.05, 5.0)
STEP = 1e-5


def derivative(spline: Spline, time: float) -> float:
    return float((spline.sample(time + STEP)[0] - spline.sample(time - STEP)[0]) / (2.0 * STEP))


def test_positions_alone_are_joined_by_straight_lines() -> None:
    spline = Spline([point(1.0, [0.0, 2.0]), point(3.0, [1.0, 0.0]), point(4.0, [1.0, 1.0])])
    assert spline.sample(2.0) == pytest.approx([0.5, 1.0])
    assert spline.sample(3.25) == pytest.approx([1.0, 0.25])


def test_before_the_first_and_after_the_last_knot_positions_hold() -> None:
    spline = Spline([point(1.0, [0.5], [1.0]), point(2.0, [1.5], [0.0])])
    assert spline.sample(-5.0) == pytest.approx([0.5])
    assert spline.sample(2.0) == pytest.approx([1.5])
    assert spline.sample(99.0) == pytest.approx([1.5])


@given(numbers, numbers, numbers, numbers, durations)
def test_with_velocities_position_and_velocity_are_met(p0: float, p1: float, v0: float, v1: float, t: float) -> None:
    spline = Spline([point(0.0, [p0], [v0]), point(t, [p1], [v1])])
    assert spline.sample(0.0)[0] == pytest.approx(p0, abs=1e-9)
    assert spline.sample(t * (1.0 - 1e-9))[0] == pytest.approx(p1, abs=1e-6)
    assert derivative(spline, 2 * STEP) == pytest.approx(v0, abs=0.03 * (1.0 + abs(p1 - p0) + abs(v0) + abs(v1)) / t**2)


@given(numbers, numbers, numbers, numbers, durations)
def test_cubic_with_its_own_derivatives_is_reproduced(a: float, b: float, c: float, d: float, t: float) -> None:
    def value(u: float) -> float:
        return a + b * u + c * u**2 + d * u**3

    def rate(u: float) -> float:
        return b + 2.0 * c * u + 3.0 * d * u**2

    spline = Spline([point(0.0, [value(0.0)], [rate(0.0)]), point(t, [value(t)], [rate(t)])])
    for share in (0.2, 0.5, 0.9):
        assert spline.sample(share * t)[0] == pytest.approx(value(share * t), abs=1e-8 * (1.0 + t**3))


@given(st.lists(numbers, min_size=6, max_size=6), durations)
def test_quintic_with_its_own_derivatives_is_reproduced(coefficients: list[float], t: float) -> None:
    polynomial = np.polynomial.Polynomial(coefficients)

    def knot(u: float) -> TrajectoryPoint:
        return point(u, [polynomial(u)], [polynomial.deriv()(u)], [polynomial.deriv(2)(u)])

    spline = Spline([knot(0.0), knot(t)])
    for share in (0.1, 0.5, 0.8):
        assert spline.sample(share * t)[0] == pytest.approx(polynomial(share * t), abs=1e-7 * (1.0 + t**5))


def test_a_piece_is_as_smooth_as_its_poorer_end() -> None:
    rich, poor = point(0.0, [0.0], [1.0], [5.0]), point(1.0, [1.0])
    assert Spline([rich, poor]).sample(0.25) == pytest.approx([0.25])
    cubic_end = point(1.0, [1.0], [1.0])
    assert Spline([rich, cubic_end]).sample(0.25) == pytest.approx([0.25])  # the acceleration is not used
