"""Faults while a motion runs: the code, the reaction and the standstill of each; and the next push works."""

import dataclasses

import numpy as np
import pytest
from fake_robot import ARMS, HOME, push_segments
from rig import Rig

from singulation_core import ResultCode, SingulationError
from yumi_push_executor.supervision import ArmOrder, DriverMode, JawOrder, Phase, SupervisionLimits

LIMITS = SupervisionLimits()
MOVING = [Phase.APPROACH, Phase.DESCEND, Phase.PUSH, Phase.RETREAT, Phase.CLEAR_VIEW]


def set_arm(name="left", **values):
    return lambda rig, _: [setattr(rig.arms[name], key, value) for key, value in values.items()]


def set_rig(**values):
    return lambda rig, _: [setattr(rig, key, value) for key, value in values.items()]


def freeze(rig, _):
    """Same numbers, new stamps."""
    kept = rig.watch.latest
    rig.corrupt = lambda sample: dataclasses.replace(kept, taken=sample.taken, arrived=sample.arrived)


def same_stamp(rig, _):
    kept = rig.watch.latest
    rig.corrupt = lambda sample: dataclasses.replace(sample, taken=kept.taken)


def late(rig, _):
    rig.corrupt = lambda sample: dataclasses.replace(sample, taken=sample.taken - 0.6)


def replaced(value, arm="left", joint=2):
    def spoil(sample):
        positions = {name: np.array(q) for name, q in sample.positions.items()}
        positions[arm][joint if joint is not None else slice(None)] = value
        return dataclasses.replace(sample, positions=positions)

    return set_rig(corrupt=spoil)


def lost_arm(sample):
    return dataclasses.replace(sample, positions={"left": sample.positions["left"]})


STATE_FAULTS = {
    "drop": (set_rig(corrupt=lambda sample: None), LIMITS.state_age, "old"),
    "same stamps": (same_stamp, LIMITS.state_age, "old"),
    "late": (late, LIMITS.state_age, "before they arrive"),
    "NaN": (replaced(np.nan), 0.0, "left joint 3 is nan"),
    "infinite": (replaced(-np.inf), 0.0, "left joint 3 is -inf"),
    "all zero": (replaced(0.0, joint=None), 0.0, "exactly 0"),
    "other arm NaN": (replaced(np.nan, "right", 6), 0.0, "right joint 7 is nan"),
    "outside the range": (replaced(9.0), 0.0, "outside its range"),
    "one arm missing": (set_rig(corrupt=lost_arm), 0.0, "lack the right arm"),
}


@pytest.mark.parametrize("phase", [Phase.GRIPPER, Phase.APPROACH, Phase.PUSH])
@pytest.mark.parametrize("name", STATE_FAULTS)
def test_lost_states_stop_the_arm_on_its_path(rig, name, phase):
    happen, allowed, text = STATE_FAULTS[name]
    outcome = rig.run(events=[(phase, 0.15, happen)])
    assert outcome.code is ResultCode.STATE_LOST
    assert text in outcome.text
    assert not outcome.standing  # nobody can see it
    assert "standstill was not seen" in outcome.text
    assert rig.reaction() <= allowed + 0.02
    assert rig.standstill() <= 0.1
    assert rig.fastest_command() <= 3.2
    assert rig.asked_to_lift == 0
    rig.require_good_push()


def test_states_that_come_back_during_the_stop_confirm_it(rig):
    outcome = rig.run(
        events=[
            (Phase.PUSH, 0.3, set_rig(corrupt=lambda sample: None)),
            (Phase.STOPPING, 0.3, set_rig(corrupt=lambda sample: sample)),
        ]
    )
    assert (outcome.code, outcome.standing) == (ResultCode.STATE_LOST, True)
    rig.require_good_push()


@pytest.mark.parametrize("phase", [Phase.APPROACH, Phase.PUSH, Phase.CLEAR_VIEW])
def test_frozen_states_are_noticed_and_not_believed(rig, phase):
    outcome = rig.run(events=[(phase, 0.35, freeze)])
    assert outcome.code is ResultCode.NO_PROGRESS
    assert "frozen" in outcome.text
    assert not outcome.standing
    assert rig.reaction() <= LIMITS.progress_window + 0.02
    assert rig.standstill() <= 0.1
    assert rig.fastest_command() <= 3.2
    assert rig.asked_to_lift == 0
    rig.require_good_push()


@pytest.mark.parametrize("phase", MOVING)
def test_states_frozen_before_the_arm_was_seen_to_move_are_noticed(rig, phase):
    outcome = rig.run(events=[(phase, 0.0, freeze)])
    assert outcome.code is ResultCode.NO_PROGRESS
    assert "frozen" in outcome.text
    assert not outcome.standing
    assert rig.reaction() <= LIMITS.start_latency + 0.2
    assert rig.asked_to_lift == 0
    rig.require_good_push()


@pytest.mark.parametrize("phase", MOVING)
def test_an_arm_that_is_held_is_let_go_and_lifted(rig, phase):
    outcome = rig.run(events=[(phase, 0.1, set_arm(stuck=True)), (Phase.STOPPING, 0.05, set_arm(stuck=False))])
    assert (outcome.code, outcome.standing) == (ResultCode.NO_PROGRESS, True)
    assert "retreated upwards" in outcome.text
    assert rig.reaction() <= 0.5
    assert rig.standstill() <= 0.1
    rig.require_good_push()


def test_an_arm_that_stays_held_ends_without_a_retreat(rig):
    outcome = rig.run(events=[(Phase.PUSH, 0.3, set_arm(stuck=True))])
    assert (outcome.code, outcome.standing) == (ResultCode.NO_PROGRESS, True)
    assert "the retreat was stopped" in outcome.text
    assert rig.asked_to_lift == 1
    rig.require_good_push()


def test_an_arm_that_never_starts_is_given_up(rig):
    outcome = rig.run(events=[(Phase.GRIPPER, 0.0, set_arm(deaf=True))])
    assert outcome.code is ResultCode.NO_PROGRESS
    assert "has not begun to move" in outcome.text
    rig.require_good_push()


def test_a_lost_order_ends_and_its_stop_does_not_start_the_arm(rig):
    """The first trajectory is lost, the stop is not: an arm that never moved must not be sent ahead on its path."""
    rig.arms["left"].deaf = True
    outcome = rig.run(events=[(Phase.STOPPING, 0.0, set_arm(deaf=False))], until=10.0)
    assert outcome.code is ResultCode.NO_PROGRESS
    first = next(order for _, phase, order in rig.orders if phase is Phase.STOPPING and isinstance(order, ArmOrder))
    np.testing.assert_allclose(first.trajectory.end, HOME["left"], atol=1e-3)
    rig.require_good_push()


@pytest.mark.parametrize("phase", MOVING)
def test_an_arm_beside_its_path_is_held_where_it_is_and_lifted(rig, phase):
    """One joint is held, the others go on."""
    jam, release = set_arm(stuck=np.arange(7) == 1), set_arm(stuck=False)
    outcome = rig.run(events=[(phase, 0.1, jam), (Phase.STOPPING, 0.15, release)])
    assert (outcome.code, outcome.standing) == (ResultCode.PATH_TOLERANCE, True)
    assert "away from the path" in outcome.text
    assert "retreated upwards" in outcome.text
    assert rig.standstill() <= 0.1
    rig.require_good_push()


def test_an_arm_that_is_too_slow_is_stopped(rig):
    outcome = rig.run(events=[(Phase.PUSH, 0.3, set_arm(fastest=0.05)), (Phase.STOPPING, 0.05, set_arm(fastest=3.0))])
    assert outcome.code is ResultCode.PATH_TOLERANCE
    rig.require_good_push()


def test_an_arm_that_stops_short_of_its_end_is_given_up(rig):
    """Within the tolerance of the path, but not of the goal."""
    outcome = rig.run(events=[(Phase.PUSH, 0.1, set_arm(pull=np.full(7, 0.012)))])
    assert outcome.code is ResultCode.GOAL_TOLERANCE
    assert "before its end" in outcome.text
    rig.require_good_push()


def test_the_other_arm_must_stand(rig):
    outcome = rig.run(events=[(Phase.PUSH, 0.1, set_arm("right", pull=np.full(7, 0.05)))])
    assert outcome.code is ResultCode.PATH_TOLERANCE
    assert "right joint" in outcome.text
    held = {order.arm for _, phase, order in rig.orders if phase is Phase.STOPPING}
    assert held == set(ARMS)
    rig.require_good_push()


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


def pause(seconds):
    def happen(rig, supervisor):
        rig.skip_steps = True
        until = rig.now + seconds
        inner = rig.corrupt

        def count(sample):
            if rig.now >= until:
                rig.skip_steps, rig.corrupt = False, inner
            return inner(sample)

        rig.corrupt = count

    return happen


def test_a_supervision_that_slept_too_long_stops_the_motion(rig):
    outcome = rig.run(push_segments(), events=[(Phase.PUSH, 0.1, pause(0.6))])
    assert outcome.code is ResultCode.TIMEOUT
    assert "did not run" in outcome.text
    rig.require_good_push()


def test_a_short_hiccup_is_no_fault(rig):
    """Shorter than blind_time, longer than state_age: the states that waited are read before they are called old."""
    outcome = rig.run(events=[(Phase.PUSH, 0.1, pause(0.4))])
    assert outcome.code is ResultCode.OK


@pytest.mark.parametrize("jump", [-3600.0, -2.0, 3600.0])
def test_a_clock_that_jumps_stops_the_motion(rig, jump):
    outcome = rig.run(events=[(Phase.PUSH, 0.1, lambda rig, _: setattr(rig, "now", rig.now + jump))], until=1e9)
    assert outcome.code is ResultCode.TIMEOUT
    assert f"jumped by {jump:.1f}"[:14] in outcome.text
    rig.require_good_push()


def test_a_paused_clock_is_noticed_on_the_steady_clock():
    rig = Rig(SupervisionLimits(wall_silence=2.0))
    supervisor = rig.supervisor()
    rig.obey(supervisor.start(rig.driver, rig.instant()))
    for _ in range(50):
        rig.obey(supervisor.step(rig.cycle(), rig.driver, rig.instant()))
    began = rig.wall
    while rig.steps[-1].outcome is None:
        rig.wall += 0.02
        rig.obey(supervisor.step([], rig.driver, rig.instant()))
        assert rig.wall < began + 10.0
    assert rig.steps[-1].outcome.code is ResultCode.STATE_LOST


@pytest.mark.parametrize("lift", [0.0, None])
def test_a_retreat_that_is_not_needed_or_not_possible_is_left_out(rig, lift):
    rig.lift = lift or 0.0
    rig.lift_error = None if lift is not None else SingulationError(ResultCode.UNREACHABLE, "no way up")
    outcome = rig.run(events=[(Phase.PUSH, 0.3, set_arm(pull=np.full(7, 0.05)))])
    assert (outcome.code, outcome.standing) == (ResultCode.PATH_TOLERANCE, True)
    assert ("no way up" in outcome.text) == (lift is None)
    rig.require_good_push()


def test_after_the_retreat_the_arm_leaves_the_cameras_view(rig):
    rig.clear = True
    jam, release = set_arm(stuck=np.arange(7) == 1), set_arm(stuck=False)
    outcome = rig.run(events=[(Phase.PUSH, 0.1, jam), (Phase.STOPPING, 0.15, release)])
    assert (outcome.code, outcome.standing) == (ResultCode.PATH_TOLERANCE, True)
    assert outcome.text.endswith("retreated upwards; left the camera's view")
    np.testing.assert_allclose(rig.arms["left"].q, HOME["left"], atol=LIMITS.goal_tolerance)
    rig.require_good_push()


def test_an_arm_that_is_high_enough_leaves_the_view_at_once(rig):
    rig.clear, rig.lift = True, 0.0
    jam, release = set_arm(stuck=np.arange(7) == 1), set_arm(stuck=False)
    outcome = rig.run(events=[(Phase.APPROACH, 0.1, jam), (Phase.STOPPING, 0.15, release)])
    assert outcome.text.endswith("rad; left the camera's view")
    rig.require_good_push()


def test_an_arm_that_finds_no_way_out_of_the_view_stays(rig):
    rig.clear_error = SingulationError(ResultCode.PATH_BLOCKED, "the other arm is in the way")
    jam, release = set_arm(stuck=np.arange(7) == 1), set_arm(stuck=False)
    outcome = rig.run(events=[(Phase.PUSH, 0.1, jam), (Phase.STOPPING, 0.15, release)])
    assert (outcome.code, outcome.standing) == (ResultCode.PATH_TOLERANCE, True)
    assert "it stays in view: the other arm is in the way" in outcome.text
    rig.require_good_push()


def test_a_late_order_is_waited_for_and_stopped(rig):
    """Not begun, given up, then it comes after all: the outcome must not be given while the arm still moves."""
    rig.arms["left"].latency = 0.6
    outcome = rig.run()
    assert (outcome.code, outcome.standing) == (ResultCode.NO_PROGRESS, True)
    ended = rig.arms["left"].q
    for _ in range(250):
        rig.cycle()
    np.testing.assert_allclose(rig.arms["left"].q, ended, atol=1e-3)
    rig.require_good_push()


@pytest.mark.parametrize("phase", [Phase.GRIPPER, Phase.PUSH])
def test_states_that_paused_while_the_goal_was_reached_are_no_fault(phase):
    """A busy machine hears nothing for two seconds of a fast simulation; what it hears then is good."""
    rig = Rig()
    rig.wall_rate = 0.02
    supervisor = rig.supervisor()
    rig.obey(supervisor.start(rig.driver, rig.instant()))
    while rig.steps[-1].phase is not phase:
        rig.obey(supervisor.step(rig.cycle(), rig.driver, rig.instant()))
    rig.corrupt = lambda sample: None
    for _ in range(300):
        rig.cycle()
    rig.corrupt = lambda sample: sample
    while rig.steps[-1].outcome is None:
        rig.obey(supervisor.step(rig.cycle(), rig.driver, rig.instant()))
    assert rig.steps[-1].outcome.code is ResultCode.OK
