"""Inverse kinematics: round trips, limits, straight lines, refusals."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from singulation_core import InvalidInputError, ResultCode, SingulationError
from yumi_push_executor import YumiArm
from yumi_push_executor.kinematics import BRANCHES, TIP_OFFSET, chain

NAMES = ("left", "right")


def near(name, branch, spread):
    rest = BRANCHES[branch][name]
    return st.lists(st.floats(-spread, spread), min_size=7, max_size=7).map(lambda off: rest + np.array(off))


@given(st.sampled_from(NAMES), st.integers(0, 2), st.data())
def test_round_trip_stays_on_the_branch_of_the_seed(name, branch, data):
    arm = YumiArm(name)
    q = np.clip(data.draw(near(name, branch, 0.3)), arm.lower, arm.upper)
    seed = np.clip(q + data.draw(near(name, branch, 0.15)) - BRANCHES[branch][name], arm.lower, arm.upper)
    found = arm.inverse(arm.forward(q), seed)
    np.testing.assert_allclose(arm.forward(found), arm.forward(q), atol=3e-6)
    assert (arm.lower <= found).all() and (found <= arm.upper).all()
    assert np.abs(found - seed).max() < 1.0


@pytest.mark.parametrize("name", NAMES)
def test_exact_seed_is_its_own_solution(name):
    arm = YumiArm(name)
    q = BRANCHES[0][name]
    np.testing.assert_allclose(arm.inverse(arm.forward(q), q), q, atol=1e-6)


@given(st.floats(0.9, 5.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_out_of_reach_is_refused_with_what_is_missing(x, y, z):
    arm = YumiArm("left")
    pose = arm.forward(BRANCHES[0]["left"])
    good = pose.copy()
    pose[:3, 3] = (x, y, z)
    with pytest.raises(SingulationError, match=r"missed by [1-9][0-9.]* mm") as refusal:
        arm.inverse(pose)
    assert refusal.value.code is ResultCode.UNREACHABLE
    np.testing.assert_allclose(arm.forward(arm.inverse(good)), good, atol=3e-6)


def test_half_a_turn_away_is_found():
    arm, q = YumiArm("left"), BRANCHES[0]["left"]
    pose = arm.forward(q)
    pose[:3, :2] *= -1.0  # the jaws turned by exactly half a turn
    np.testing.assert_allclose(arm.forward(arm.inverse(pose, q)), pose, atol=3e-6)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda pose: pose[:3],
        lambda pose: pose * np.nan,
        lambda pose: pose * 2.0,
        lambda pose: pose @ np.diag((1.0, 1.0, -1.0, 1.0)),
    ],
)
def test_what_is_no_pose_is_refused(spoil):
    arm = YumiArm("right")
    pose = arm.forward(BRANCHES[0]["right"])
    with pytest.raises(InvalidInputError):
        arm.inverse(spoil(pose))
    arm.inverse(pose, BRANCHES[0]["right"])


@given(st.sampled_from(NAMES), st.integers(0, 1), st.floats(0.0, 2 * np.pi), st.floats(0.01, 0.06))
def test_line_is_straight_without_turning_and_rates_are_its_slope(name, branch, angle, length):
    arm = YumiArm(name)
    q = BRANCHES[branch][name]
    direction = np.array((np.cos(angle), np.sin(angle), 0.0))
    gone = np.linspace(0.0, length, 40)
    angles, rates, misses = chain.follow_line(arm.chain, q, direction, gone, q, 1.0)
    assume(misses.max() < 1e-7 and np.abs(rates).max() < 12.0)  # the end of the reach lies within 6 cm of some postures
    start = arm.forward(q)
    for row, distance in zip(angles, gone, strict=True):
        pose = arm.forward(row)
        np.testing.assert_allclose(pose[:3, 3], start[:3, 3] + distance * direction, atol=1e-7)
        np.testing.assert_allclose(pose[:3, :3], start[:3, :3], atol=1e-7)
    slope = np.gradient(angles, gone, axis=0)[1:-1]
    assert np.abs(slope - rates[1:-1]).max() < 0.02 * max(1.0, np.abs(rates).max())


def test_a_line_out_of_reach_misses_its_far_way_points():
    arm, q = YumiArm("left"), BRANCHES[0]["left"]
    gone = np.linspace(0.0, 0.5, 30)
    _, _, misses = chain.follow_line(arm.chain, q, np.array((1.0, 0.0, 0.0)), gone, q, 1.0)
    assert misses.max() > 0.01 and misses[:5].max() < 1e-7


@given(st.sampled_from(NAMES), st.data())
def test_tip_way_bounds_the_speed_of_the_tips(name, data):
    arm = YumiArm(name)
    start = data.draw(near(name, 0, 0.5))
    end = data.draw(near(name, 0, 0.5))
    path = np.linspace(start, end, 200)
    tips = chain.tips(arm.chain, path, TIP_OFFSET)
    np.testing.assert_allclose(tips[0], arm.tip(start)[:3, 3], atol=1e-12)
    fastest = np.sqrt((np.diff(tips, axis=0) ** 2).sum(axis=1)).max() * 199
    assert fastest <= arm.tip_way(start, end) * 1.02 + 1e-9
    assert chain.longest_step(arm.chain, path, TIP_OFFSET) >= fastest / 199 - 1e-12
