"""Trajectories: what is refused, and that they are interpolated as a JointTrajectoryController does."""

import numpy as np
import pytest
from fake_robot import RANGES
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import InvalidInputError
from yumi_push_executor.supervision import SupervisionLimits, Trajectory
from yumi_push_executor.supervision.stops import hold_at, stop_along
from yumi_push_executor.supervision.trajectory import MAX_POINTS

LIMITS = SupervisionLimits()


def rows(count, value=0.1):
    return np.full((count, 7), value)


def spoiled(count, point, joint, value):
    array = rows(count)
    array[point, joint] = value
    return array


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (([], np.zeros((0, 7))), "0 points"),
        ((np.arange(MAX_POINTS + 1.0), rows(MAX_POINTS + 1)), f"need 1 to {MAX_POINTS}"),
        (([0.0, 1.0], rows(3)), r"positions of shape \(3, 7\), need \(2, 7\)"),
        (([0.0, 1.0], np.zeros((2, 6))), r"shape \(2, 6\)"),
        (([0.0, 1.0], rows(2), np.zeros((2, 8))), r"velocities of shape \(2, 8\)"),
        (([0.0, 1.0, 1.0], rows(3)), "point 2 at 1.0 s does not follow point 1"),
        (([0.0, 2.0, 1.0], rows(3)), "point 2 at 1.0 s"),
        (([-0.1, 1.0], rows(2)), "point 0 is at -0.1 s"),
        (([0.0, np.nan], rows(2)), "time of point 1 is nan"),
        (([0.0, np.inf], rows(2)), "time of point 1 is inf"),
        (([0.0, 1.0], spoiled(2, 1, 4, np.nan)), "positions of point 1, joint 5 is nan"),
        (([0.0, 1.0], rows(2), spoiled(2, 0, 6, -np.inf)), "velocities of point 0, joint 7 is -inf"),
        (([0.0, 1.0], rows(2), rows(2), spoiled(2, 0, 0, np.nan)), "accelerations of point 0, joint 1 is nan"),
        (([0.0, 1.0], rows(2), None, rows(2)), "accelerations without velocities"),
    ],
)
def test_malformed_trajectories_are_refused_with_point_and_joint(arguments, text):
    with pytest.raises(InvalidInputError, match=text):
        Trajectory(*arguments)


@st.composite
def splines(draw):
    count = draw(st.integers(2, 6))
    steps = draw(st.lists(st.floats(0.05, 2.0), min_size=count, max_size=count))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return np.cumsum(steps), *rng.uniform(-2.0, 2.0, (3, count, 7))


@settings(max_examples=50, deadline=None)
@given(splines())
def test_points_are_met_exactly_with_their_derivatives(data):
    times, positions, velocities, accelerations = data
    for given_fields in ((), (velocities,), (velocities, accelerations)):
        trajectory = Trajectory(times, positions, *given_fields)
        np.testing.assert_allclose(trajectory.sample(times)[0], positions, atol=1e-9)
        if given_fields:
            np.testing.assert_allclose(trajectory.sample(times[:-1])[1], velocities[:-1], atol=1e-6)
        if len(given_fields) == 2:
            step = 1e-8
            near = trajectory.sample(times[:-1] + step)[1]
            np.testing.assert_allclose((near - velocities[:-1]) / step, accelerations[:-1], atol=0.05)


@settings(max_examples=50, deadline=None)
@given(splines(), st.floats(0.0, 1.0))
def test_velocities_are_the_derivatives_of_the_positions(data, where):
    times, positions, velocities, accelerations = data
    step = 1e-6
    moment = times[0] + where * (times[-1] - times[0]) * 0.999
    for given_fields in ((velocities,), (velocities, accelerations)):
        trajectory = Trajectory(times, positions, *given_fields)
        (before, after), _ = trajectory.sample((moment - step, moment + step))
        if not np.any(np.abs(times - moment) < 2 * step):
            slopes = (after - before) / (2 * step)
            np.testing.assert_allclose(trajectory.sample(moment)[1][0], slopes, atol=1e-3, rtol=1e-4)


def test_it_rests_before_the_start_and_after_the_end():
    trajectory = Trajectory([0.5, 1.0], [np.zeros(7), np.ones(7)], rows(2, 3.0))
    positions, velocities = trajectory.sample((-1.0, 0.0, 1.0, 9.0))
    np.testing.assert_array_equal(positions, np.repeat(((0.0,), (0.0,), (1.0,), (1.0,)), 7, axis=1))
    np.testing.assert_array_equal(velocities, 0.0)
    single = Trajectory([0.3], [np.ones(7)])
    np.testing.assert_array_equal(single.sample((0.0, 1.0))[0], 1.0)


@settings(max_examples=50, deadline=None)
@given(splines(), st.floats(0.0, 1.0))
def test_a_stop_along_the_path_stays_on_it_and_ends_at_rest(data, where):
    times, positions, velocities, _ = data
    trajectory = Trajectory(times, positions, velocities)
    elapsed = times[0] + where * (times[-1] - times[0])
    stop = stop_along(trajectory, elapsed, LIMITS)
    np.testing.assert_array_equal(stop.velocities[-1], 0.0)
    ahead = trajectory.sample(elapsed + stop.duration * np.linspace(0.0, 1.0, 2001))[0]
    for point in stop.positions:
        assert np.abs(ahead - point).max(axis=1).min() < 0.02 * max(1.0, np.ptp(ahead, axis=0).max())


@settings(max_examples=100, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 3.0), st.floats(0.0, 0.3))
def test_a_hold_never_leaves_the_range_and_is_no_faster_than_allowed(seed, fastest, apart):
    rng = np.random.default_rng(seed)
    allowed = RANGES["left"]
    position = rng.uniform(allowed.lower, allowed.upper)
    velocity, commanded = rng.uniform(-fastest, fastest, 7), position + rng.uniform(-apart, apart, 7)
    hold = hold_at(position, velocity, commanded, LIMITS, allowed)
    assert np.all((hold.end >= allowed.lower) & (hold.end <= allowed.upper))
    assert hold.duration >= LIMITS.stop_duration
    assert hold.duration >= 1.5 * np.abs(commanded - hold.end).max() / LIMITS.stop_speed - 1e-12
    np.testing.assert_array_equal(hold.velocities, 0.0)
