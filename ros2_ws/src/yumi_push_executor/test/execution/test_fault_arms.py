"""Arms that do not go as ordered while a motion runs, and how they get away; and the next push works."""

import numpy as np
import pytest
from fake_robot import ARMS, HOME
from rig import set_arm

from singulation_core import ResultCode, SingulationError
from yumi_push_executor.supervision import ArmOrder, Phase, SupervisionLimits

LIMITS = SupervisionLimits()
MOVING = [Phase.APPROACH, Phase.DESCEND, Phase.PUSH, Phase.RETREAT, Phase.CLEAR_VIEW]


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
