"""Stops of the driver, collisions and jaws while a motion runs: code and standstill; and the next push works."""

import dataclasses

import numpy as np
import pytest
from fake_robot import ARMS, push_segments
from rig import set_rig

from singulation_core import ResultCode
from yumi_push_executor.supervision import ArmOrder, DriverMode, JawOrder, Phase

STOPS = [DriverMode.EMERGENCY_STOP, DriverMode.GUARD_STOP, DriverMode.MOTORS_OFF, DriverMode.SYSTEM_FAILURE]


@pytest.mark.parametrize("phase", [Phase.GRIPPER, Phase.APPROACH, Phase.PUSH])
@pytest.mark.parametrize("mode", STOPS)
def test_a_safety_stop_ends_the_motion(rig, mode, phase):
    outcome = rig.run(events=[(phase, 0.1, set_rig(mode=mode, enabled=False, message="said the driver"))])
    assert (outcome.code, outcome.standing) == (ResultCode.SAFETY_STOP, True)
    assert "said the driver" in outcome.text
    assert rig.reaction() <= 0.0081
    assert rig.asked_to_lift == 0
    rig.require_good_push()


@pytest.mark.parametrize("after", [0.02, 0.2])
def test_a_released_emergency_stop_resumes_nothing(rig, after):
    """Whether it is released before or after the outcome, the arm stays where it stopped."""
    supervisor = rig.supervisor()
    rig.obey(supervisor.start(rig.driver, rig.instant()))
    while rig.steps[-1].phase is not Phase.PUSH:
        rig.obey(supervisor.step(rig.cycle(), rig.driver, rig.instant()))
    rig.mode, rig.enabled = DriverMode.EMERGENCY_STOP, False
    pressed = rig.now
    while rig.now < pressed + 3.0:
        if rig.now > pressed + after:
            rig.mode, rig.enabled = DriverMode.MOTORS_ON, True
        rig.obey(supervisor.step(rig.cycle(), rig.driver, rig.instant()))
    assert rig.steps[-1].outcome.code is ResultCode.SAFETY_STOP
    stopped = [arms["left"] for time, arms in rig.path if time > pressed + 0.15]
    assert np.ptp(np.array(stopped), axis=0).max() < 2e-3
    rig.require_good_push()


def test_motion_that_the_driver_does_not_take_is_a_safety_stop(rig):
    outcome = rig.run(events=[(Phase.PUSH, 0.1, set_rig(enabled=False, message="EGM session ended"))])
    assert outcome.code is ResultCode.SAFETY_STOP
    assert "EGM session ended" in outcome.text
    rig.require_good_push()


def collide(rig, _):
    rig.mode, rig.enabled = DriverMode.COLLISION_STOP, False


def test_a_collision_waits_for_the_driver_and_then_lifts(rig):
    outcome = rig.run(
        events=[(Phase.PUSH, 0.3, collide), (Phase.STOPPING, 0.6, set_rig(mode=DriverMode.MOTORS_ON, enabled=True))]
    )
    assert (outcome.code, outcome.standing) == (ResultCode.COLLISION_STOP, True)
    assert "retreated upwards" in outcome.text
    assert rig.asked_to_lift == 1
    rig.require_good_push()


def test_a_driver_may_allow_the_retreat_while_it_still_shows_the_collision(rig):
    outcome = rig.run(events=[(Phase.PUSH, 0.3, collide), (Phase.STOPPING, 0.3, set_rig(enabled=True))])
    assert "retreated upwards" in outcome.text
    assert outcome.code is ResultCode.COLLISION_STOP
    rig.require_good_push()


def test_a_collision_that_the_driver_does_not_clear_ends_without_a_retreat(rig):
    outcome = rig.run(events=[(Phase.PUSH, 0.3, collide)])
    assert (outcome.code, outcome.standing) == (ResultCode.COLLISION_STOP, True)
    assert "does not allow a retreat" in outcome.text
    assert rig.asked_to_lift == 0
    rig.require_good_push()


def test_an_emergency_stop_after_a_collision_forbids_the_retreat(rig):
    outcome = rig.run(
        events=[(Phase.PUSH, 0.3, collide), (Phase.STOPPING, 0.3, set_rig(mode=DriverMode.EMERGENCY_STOP))]
    )
    assert outcome.code is ResultCode.COLLISION_STOP
    assert rig.asked_to_lift == 0
    rig.require_good_push()


def test_a_silent_driver_is_lost(rig):
    outcome = rig.run(push_segments(turn=1.0), events=[(Phase.APPROACH, 0.1, set_rig(driver_talks=False))])
    assert outcome.code is ResultCode.STATE_LOST
    assert "driver has said nothing" in outcome.text
    rig.require_good_push()


def test_jaws_that_do_not_move_are_stuck(rig):
    outcome = rig.run(events=[(Phase.GRIPPER, 0.0, set_rig(jaw_speed=0.0))])
    assert outcome.code is ResultCode.GRIPPER_STUCK
    assert "not at 20.0 mm" in outcome.text
    assert not any(isinstance(order, ArmOrder) for _, phase, order in rig.orders if phase is not Phase.STOPPING)
    rig.require_good_push()


def test_jaws_stopped_by_something_are_stuck_and_no_longer_pressed(rig):
    outcome = rig.run(events=[(Phase.GRIPPER, 0.2, set_rig(jaw_speed=0.0))])
    assert outcome.code is ResultCode.GRIPPER_STUCK
    last = [order for _, _, order in rig.orders if isinstance(order, JawOrder)][-1]
    assert last.opening == pytest.approx(rig.openings["left"], abs=1e-6)
    rig.require_good_push()


def test_jaws_that_give_way_during_the_push_end_it(rig):
    outcome = rig.run(events=[(Phase.PUSH, 0.2, lambda rig, _: rig.openings.update(left=0.03))])
    assert outcome.code is ResultCode.GRIPPER_STUCK
    assert "from 20.0 mm to" in outcome.text
    rig.require_good_push()


def test_a_hand_that_loses_its_calibration_ends_the_motion(rig):
    outcome = rig.run(events=[(Phase.APPROACH, 0.2, lambda rig, _: rig.calibrated.update(left=False))])
    assert outcome.code is ResultCode.GRIPPER_NOT_CALIBRATED
    assert "retreated upwards" in outcome.text  # which needs no hand
    rig.require_good_push()


def test_the_other_hands_calibration_does_not_matter(rig):
    assert (
        rig.run(events=[(Phase.APPROACH, 0.2, lambda rig, _: rig.calibrated.update(right=False))]).code is ResultCode.OK
    )


@pytest.mark.parametrize("value", [float("nan"), None])
def test_a_gripper_that_is_no_longer_reported_ends_the_motion(rig, value):
    def spoil(sample):
        openings = {} if value is None else dict.fromkeys(ARMS, value)
        return dataclasses.replace(sample, openings=openings)

    outcome = rig.run(events=[(Phase.PUSH, 0.2, set_rig(corrupt=spoil))])
    assert outcome.code is ResultCode.STATE_LOST
    assert "opening" in outcome.text
    rig.require_good_push()
