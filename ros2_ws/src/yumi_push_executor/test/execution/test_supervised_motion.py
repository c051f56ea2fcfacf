"""A motion that goes well, and how it is brought to rest on request."""

import numpy as np
import pytest
from fake_robot import CYCLE, HOME, push_segments
from rig import Rig

from singulation_core import ResultCode
from yumi_push_executor.supervision import ArmOrder, JawOrder, Phase, SupervisionLimits

PHASES = [Phase.GRIPPER, Phase.APPROACH, Phase.DESCEND, Phase.PUSH, Phase.RETREAT, Phase.CLEAR_VIEW]


def set_arm(**values):
    """An event that changes the left arm."""
    return lambda rig, supervisor: [setattr(rig.arms["left"], name, value) for name, value in values.items()]


@pytest.mark.parametrize("arm", ["left", "right"])
@pytest.mark.parametrize("lag", [0.0, 0.02, 0.15])
@pytest.mark.parametrize("latency", [0.0, 0.3])
def test_a_good_motion_ends_ok_whatever_the_controller_lags(rig, arm, lag, latency):
    rig.arms[arm].lag, rig.arms[arm].latency = lag, latency
    assert rig.run(push_segments(arm)).code is ResultCode.OK
    assert rig.steps[-1].outcome.standing
    np.testing.assert_allclose(rig.arms[arm].q, HOME[arm], atol=rig.limits.goal_tolerance)


def test_each_segment_is_one_order_and_each_phase_is_reported_in_turn(rig):
    segments = push_segments()
    rig.run(segments)
    orders = [order for _, _, order in rig.orders]
    assert [type(order) for order in orders] == [JawOrder, *[ArmOrder] * 5]
    assert orders[0].opening == segments[0].opening
    for order, segment in zip(orders[1:], segments[1:], strict=True):
        assert order.trajectory is segment.trajectory
    phases = [step.phase for step in rig.steps]
    assert list(dict.fromkeys(phases)) == PHASES
    assert phases == sorted(phases)
    assert all(0.0 <= step.fraction <= 1.0 for step in rig.steps)
    assert max(step.fraction for step in rig.steps if step.phase is Phase.PUSH) > 0.99


def test_the_outcome_comes_once_and_nothing_is_ordered_after_it(rig):
    supervisor = rig.supervisor()
    rig.obey(supervisor.start(rig.driver, rig.instant()))
    steps = []
    for _ in range(1500):
        steps.append(supervisor.step(rig.cycle(), rig.driver, rig.instant()))
        rig.obey(steps[-1])
    first = next(index for index, step in enumerate(steps) if step.outcome is not None)
    assert {id(step.outcome) for step in steps[first:]} == {id(steps[first].outcome)}
    assert not any(step.orders for step in steps[first:])


def test_states_that_come_in_bursts_are_all_judged():
    rig = Rig()
    supervisor = rig.supervisor()
    rig.obey(supervisor.start(rig.driver, rig.instant()))
    while rig.steps[-1].outcome is None:
        fresh = [sample for _ in range(8) for sample in rig.cycle()]
        rig.obey(supervisor.step(fresh, rig.driver, rig.instant()))
    assert rig.steps[-1].outcome.code is ResultCode.OK


@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize("after", [0.0, 0.2])
@pytest.mark.parametrize(("request_name", "code"), [("cancel", ResultCode.CANCELLED), ("halt", ResultCode.HALTED)])
def test_a_request_to_stop_is_obeyed_within_a_tenth_of_a_second_without_a_jump(rig, phase, after, request_name, code):
    arguments = ["asked to"] if request_name == "halt" else []
    outcome = rig.run(events=[(phase, after, lambda _, supervisor: getattr(supervisor, request_name)(*arguments))])
    assert (outcome.code, outcome.standing) == (code, True)
    assert rig.reaction() <= 0.0081
    assert rig.standstill() <= 0.1
    assert rig.asked_to_lift == 0
    assert rig.fastest_command() <= 3.2
    rig.require_good_push()


def test_a_cancelled_motion_stays_on_its_path(rig):
    segments = push_segments()
    rig.run(segments, events=[(Phase.PUSH, 0.5, lambda _, supervisor: supervisor.cancel())])
    path = segments[3].trajectory.sample(np.linspace(0.0, 1.0, 4001))[0]
    away = np.abs(path - rig.arms["left"].q).max(axis=1).min()
    assert away < 5e-4
    rig.require_good_push()


def test_repeated_requests_change_nothing(rig):
    def twice(_, supervisor):
        supervisor.cancel()
        supervisor.cancel()

    outcome = rig.run(events=[(Phase.PUSH, 0.5, twice), (Phase.STOPPING, 0.01, twice)])
    assert outcome.code is ResultCode.CANCELLED
    assert sum(phase is Phase.STOPPING for _, phase, _ in rig.orders) == 1
    rig.require_good_push()


def test_halt_holds_the_other_arm_too(rig):
    rig.run(events=[(Phase.PUSH, 0.5, lambda _, supervisor: supervisor.halt("asked to"))])
    held = {order.arm for _, phase, order in rig.orders if phase is Phase.STOPPING}
    assert held == {"left", "right"}


def test_halt_during_the_retreat_stops_it(rig):
    rig.lift = 0.3
    outcome = rig.run(
        events=[
            (Phase.PUSH, 0.5, set_arm(stuck=True)),
            (Phase.STOPPING, 0.1, set_arm(stuck=False)),
            (Phase.STOPPING, 0.25, lambda _, supervisor: supervisor.halt("asked to")),
        ]
    )
    assert outcome.code is ResultCode.NO_PROGRESS
    assert "the retreat was stopped: asked to" in outcome.text
    assert rig.asked_to_lift == 1
    rig.require_good_push()


def test_cancelled_without_seen_standstill_is_not_called_cancelled(rig):
    def run_away(rig, supervisor):
        supervisor.cancel()
        rig.arms["left"].deaf = True
        rig.arms["left"].pull = np.linspace(0.0, 3.0, 7)

    outcome = rig.run(events=[(Phase.PUSH, 0.5, run_away)])
    assert (outcome.code, outcome.standing) == (ResultCode.TIMEOUT, False)
    rig.require_good_push()


@pytest.mark.parametrize("phase", PHASES[1:])
def test_an_executor_that_dies_leaves_the_arm_at_rest_at_the_end_of_its_segment(rig, phase):
    """Nobody steps the supervision any more: every segment ends at rest, and the next one is never ordered."""
    supervisor = rig.supervisor()
    rig.obey(supervisor.start(rig.driver, rig.instant()))
    while rig.steps[-1].phase is not phase:
        rig.obey(supervisor.step(rig.cycle(), rig.driver, rig.instant()))
    segment = next(one for one in push_segments() if one.phase is phase)
    for _ in range(round((segment.trajectory.duration + 0.5) / CYCLE)):
        rig.cycle()
    np.testing.assert_allclose(rig.arms["left"].q, segment.trajectory.end, atol=rig.limits.goal_tolerance)
    assert np.abs(rig.arms["left"].v).max() < rig.limits.stopped_speed
    rig.require_good_push()


@pytest.mark.parametrize("rate", [0.05, 20.0])
def test_simulated_time_may_run_faster_or_slower_than_the_steady_clock(rate):
    rig = Rig()
    rig.wall_rate = 1.0 / rate
    assert rig.run().code is ResultCode.OK


def test_limits_that_contradict_each_other_are_refused():
    from singulation_core import InvalidInputError

    for name, value in (("goal_tolerance", 1.0), ("state_age", 100.0), ("goal_time", 0.0), ("lag", float("nan"))):
        with pytest.raises(InvalidInputError, match=name):
            SupervisionLimits(**{name: value})
