"""Speed profiles and joint moves."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from singulation_core import InvalidInputError
from yumi_push_executor import MotionParameters, YumiArm
from yumi_push_executor.kinematics import BRANCHES, CLEAR_VIEW
from yumi_push_executor.motion.timing import backwards, joined, joint_move, peaks, slowdown, slowed
from yumi_push_executor.motion.trapezoid import Trapezoid

POSITIVE = st.floats(1e-3, 1e2)


@given(POSITIVE, POSITIVE, POSITIVE)
def test_trapezoid_goes_the_distance_within_its_limits(distance, speed, acceleration):
    profile = Trapezoid(distance, speed, acceleration)
    times = np.linspace(0.0, profile.duration, 500)
    gone, rate = profile.at(times)
    assert gone[0] == 0.0 and gone[-1] == pytest.approx(distance, rel=1e-9)
    assert rate[0] == 0.0 and rate[-1] == pytest.approx(0.0, abs=1e-9 * speed)
    assert (np.diff(gone) >= -1e-12 * distance).all()
    assert rate.max() <= speed * (1 + 1e-12)
    step = times[1]
    assert np.abs(np.diff(rate)).max() <= acceleration * step * (1 + 1e-6)
    np.testing.assert_allclose(np.diff(gone) / step, 0.5 * (rate[1:] + rate[:-1]), atol=0.26 * acceleration * step)


@given(POSITIVE, POSITIVE, POSITIVE, st.floats(0.01, 1.0))
def test_knots_make_cubics_exact(distance, speed, acceleration, share):
    profile = Trapezoid(distance, speed, acceleration)
    step = share * profile.duration
    knots = profile.knots(step)
    assert knots[0] == 0.0 and knots[-1] == profile.duration
    assert np.diff(knots).min() > 0.0 and np.diff(knots).max() <= step * (1 + 1e-9)
    gone, rate = profile.at(knots)
    h = np.diff(knots)
    middle = 0.5 * (gone[:-1] + gone[1:]) + h / 8 * (rate[:-1] - rate[1:])  # of the cubic through both ends
    np.testing.assert_allclose(middle, profile.at(knots[:-1] + h / 2)[0], atol=1e-6 * distance)


@pytest.mark.parametrize("bad", [(0.0, 1.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1.0, float("nan")), (float("inf"), 1.0, 1.0)])
def test_trapezoid_refuses_what_is_no_motion(bad):
    with pytest.raises(InvalidInputError, match="trapezoid"):
        Trapezoid(*bad)
    assert Trapezoid(1.0, 1.0, 1.0).duration == pytest.approx(2.0)


@given(st.sampled_from(("left", "right")), st.lists(st.floats(-0.6, 0.6), min_size=7, max_size=7))
def test_joint_move_keeps_joints_and_tips_within_limits(name, off):
    arm, parameters = YumiArm(name), MotionParameters()
    start, end = CLEAR_VIEW[name], BRANCHES[0][name] + np.array(off)
    move = joint_move(arm, start, end, parameters)
    np.testing.assert_allclose((move.start, move.end), (start, end), atol=1e-12)
    speed, acceleration = peaks(move)
    assert (speed <= parameters.velocity_share * arm.velocity * (1 + 1e-9)).all()
    assert (acceleration <= np.array(parameters.joint_acceleration) * (1 + 1e-6)).all()
    tips = np.array([arm.tip(row)[:3, 3] for row in move.sample(np.arange(0.0, move.duration, 0.01))[0]])
    assert np.linalg.norm(np.diff(tips, axis=0), axis=1).max() <= 0.01 * parameters.approach_speed * 1.001


def test_a_move_to_where_it_stands_is_one_point():
    move = joint_move(YumiArm("left"), CLEAR_VIEW["left"], CLEAR_VIEW["left"], MotionParameters())
    assert move.duration == 0.0
    other = joint_move(YumiArm("left"), CLEAR_VIEW["left"], BRANCHES[0]["left"], MotionParameters())
    assert joined([move, other]).duration == pytest.approx(other.duration)


def test_the_last_joint_alone_is_limited_by_itself():
    arm, parameters, end = YumiArm("left"), MotionParameters(), CLEAR_VIEW["left"].copy()
    end[6] += 1.0
    move = joint_move(arm, CLEAR_VIEW["left"], end, parameters)
    profile = Trapezoid(1.0, parameters.velocity_share * float(arm.velocity[6]), parameters.joint_acceleration[6])
    assert move.duration == pytest.approx(profile.duration)


def test_backwards_twice_is_the_same_and_joined_keeps_rest_between():
    move = joint_move(YumiArm("left"), CLEAR_VIEW["left"], BRANCHES[0]["left"], MotionParameters())
    again = backwards(backwards(move))
    np.testing.assert_allclose(again.positions, move.positions)
    np.testing.assert_allclose(again.times, move.times, atol=1e-12)
    there_and_back = joined([move, backwards(move)])
    positions, velocities = there_and_back.sample(move.duration)
    np.testing.assert_allclose(positions[0], move.end, atol=1e-12)
    np.testing.assert_allclose(velocities[0], 0.0, atol=1e-9)


def test_slowed_brings_a_hasty_path_within_the_limits():
    arm, parameters = YumiArm("left"), MotionParameters()
    hasty = slowed(joint_move(arm, CLEAR_VIEW["left"], BRANCHES[0]["left"], parameters), 0.1)
    factor = slowdown(hasty, arm, parameters)
    assert factor > 2.0
    assert slowdown(slowed(hasty, factor), arm, parameters) == pytest.approx(1.0)
