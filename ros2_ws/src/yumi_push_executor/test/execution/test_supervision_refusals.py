"""What is refused before anything moves, and that the next push works."""

import dataclasses

import numpy as np
import pytest
from fake_robot import ARMS, HOME, SPEEDS, push_segments, smooth
from rig import Rig

from singulation_core import InvalidInputError, ResultCode
from yumi_push_executor.supervision import DriverMode, Phase, Segment, StateWatch, Supervisor, Trajectory


def accepted_afterwards(rig):
    rig.require_good_push()
    return True


def test_no_state_has_come(rig, refusal):
    rig.watch = StateWatch(rig.limits, rig.watch.ranges)
    code, text = refusal(rig)
    assert (code, text) == (ResultCode.NOT_READY, "no joint state has come yet")
    assert accepted_afterwards(rig)


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "exactly 0"), (np.nan, "joint 1 is nan"), (np.inf, "joint 1 is inf"), (7.0, "outside its")],
)
def test_the_first_states_are_not_real(refusal, value, text):
    rig = Rig()
    rig.watch = StateWatch(rig.limits, rig.watch.ranges)
    rig.corrupt = lambda sample: dataclasses.replace(sample, positions={arm: np.full(7, value) for arm in ARMS})
    for _ in range(10):
        rig.cycle()
    code, said = refusal(rig)
    assert code is ResultCode.NOT_READY
    assert text in said
    assert accepted_afterwards(rig)


def test_states_have_stopped(rig, refusal):
    rig.corrupt = lambda sample: None
    for _ in range(50):
        rig.cycle()
    code, text = refusal(rig)
    assert code is ResultCode.STATE_LOST
    assert "0.40 s old" in text
    assert accepted_afterwards(rig)


def test_states_have_become_nan(rig, refusal):
    rig.corrupt = lambda sample: dataclasses.replace(sample, positions={arm: np.full(7, np.nan) for arm in ARMS})
    rig.cycle()
    assert refusal(rig)[0] is ResultCode.STATE_LOST
    assert accepted_afterwards(rig)


def test_the_gripper_is_not_reported(rig, refusal):
    rig.corrupt = lambda sample: dataclasses.replace(sample, openings={"right": 0.0})
    rig.cycle()
    code, text = refusal(rig)
    assert code is ResultCode.NOT_READY
    assert "left gripper" in text
    assert accepted_afterwards(rig)


def test_the_driver_has_never_spoken(rig, refusal):
    rig.driver = None
    assert refusal(rig) == (ResultCode.NOT_READY, "no driver state has come yet")
    assert accepted_afterwards(rig)


def test_the_driver_is_silent(rig, refusal):
    rig.driver_talks = False
    for _ in range(150):
        rig.cycle()
    assert refusal(rig)[0] is ResultCode.STATE_LOST
    assert accepted_afterwards(rig)


@pytest.mark.parametrize("mode", [mode for mode in DriverMode if mode is not DriverMode.MOTORS_ON])
def test_the_driver_does_not_allow_motion(rig, refusal, mode):
    rig.mode, rig.enabled = mode, False
    rig.cycle()
    expected = ResultCode.COLLISION_STOP if mode is DriverMode.COLLISION_STOP else ResultCode.SAFETY_STOP
    assert refusal(rig)[0] is expected
    assert accepted_afterwards(rig)


def test_the_gripper_is_not_calibrated(rig, refusal):
    rig.calibrated["left"] = False
    rig.cycle()
    code, text = refusal(rig)
    assert code is ResultCode.GRIPPER_NOT_CALIBRATED
    assert "calibrate it" in text
    assert accepted_afterwards(rig)


def test_the_arm_is_not_where_the_motion_starts(rig, refusal):
    away = HOME["left"] + np.array((0.0, 0.0, 0.05, 0.0, 0.0, 0.0, 0.0))
    segments = (Segment(Phase.APPROACH, "left", smooth(away, HOME["left"], 1.0)),)
    code, text = refusal(rig, segments)
    assert code is ResultCode.START_TOO_FAR
    assert "left joint 3 is 0.050 rad away" in text
    assert accepted_afterwards(rig)


def test_an_empty_motion_is_refused(rig):
    with pytest.raises(InvalidInputError, match="no segments"):
        Supervisor((), rig.watch, rig.limits, SPEEDS, rig.plan_lift).start(rig.driver, rig.instant())
    assert accepted_afterwards(rig)


def test_segments_that_do_not_join_are_refused(rig, refusal):
    segments = list(push_segments())
    del segments[2]
    code, text = refusal(rig, tuple(segments))
    assert code is ResultCode.INVALID_INPUT
    assert "PUSH of the left arm starts" in text
    assert accepted_afterwards(rig)


def test_a_motion_beyond_a_joint_limit_is_refused(rig, refusal):
    beyond = np.array(HOME["left"])
    beyond[1] = rig.watch.ranges["left"].lower[1] - 0.01
    code, text = refusal(rig, (Segment(Phase.APPROACH, "left", smooth(HOME["left"], beyond, 2.0)),))
    assert code is ResultCode.INVALID_INPUT
    assert "joint 2 goes 0.010 rad beyond its limit" in text
    assert accepted_afterwards(rig)


def test_a_motion_faster_than_a_joint_is_refused(rig, refusal):
    duration = 0.2 * 1.875 / (1.2 * SPEEDS["left"][3])
    far = HOME["left"] + np.array((0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0))
    code, text = refusal(rig, (Segment(Phase.APPROACH, "left", smooth(HOME["left"], far, duration)),))
    assert code is ResultCode.INVALID_INPUT
    assert "joint 4 moves at 1.2" in text
    assert accepted_afterwards(rig)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("middle", None, 0.0), "arm 'middle'"),
        (("left", None, None), "either a trajectory or a jaw opening"),
        (("left", Trajectory([0.0], [HOME["left"]]), 0.0), "either a trajectory or a jaw opening"),
        (("left", None, -0.01), "jaw opening -0.01"),
        (("left", None, float("nan")), "jaw opening nan"),
    ],
)
def test_malformed_segments_are_refused(arguments, text):
    with pytest.raises(InvalidInputError, match=text):
        Segment(Phase.APPROACH, *arguments)
