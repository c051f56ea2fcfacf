"""The node against a driver node: one goal, one coded result, whatever happens; and the next goal works."""

import numpy as np
import pytest
import rclpy
from action_msgs.msg import GoalStatus
from fake_robot import ARMS, HOME
from node_cell import Blocker, NodeCell
from rclpy.context import Context
from rclpy.parameter import Parameter
from singulation_msgs.msg import DriverState, PushOutcome
from std_srvs.srv import Trigger

from singulation_core import Arrangement, PlanarObject, ResultCode, SingulationError
from singulation_core.conversions import arrangement_to_msg
from singulation_node.qos import LATCHED
from singulation_node.testing import Mailbox, call, reserved_domain, spinning, wait_until
from yumi_push_executor.supervision import Phase

PHASES = [Phase.GRIPPER, Phase.APPROACH, Phase.DESCEND, Phase.PUSH, Phase.RETREAT, Phase.CLEAR_VIEW]


@pytest.fixture(scope="module")
def running():
    context = Context()
    with reserved_domain() as domain:
        rclpy.init(context=context, domain_id=domain)
        made = NodeCell(context)
        with spinning(*made.nodes, threads=6):
            made.start()
            yield made
        context.try_shutdown()


@pytest.fixture
def cell(running):
    """Healthy before each test; after it the next push works and all counts agree."""
    running.heal()
    yield running
    running.heal()
    status, result = running.execute()
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_SUCCEEDED, ResultCode.OK), result.message
    counts = running.executor.ledger.counts()
    assert counts["open"] == 0
    assert counts["received"] == sum(value for name, value in counts.items() if name not in ("received", "open"))


def ended(status_and_result):
    status, result = status_and_result
    return status, ResultCode(result.code)


def test_a_push_is_executed_and_reported(cell):
    status, result = cell.execute()
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_SUCCEEDED, ResultCode.OK)
    assert list(dict.fromkeys(cell.phases)) == PHASES
    np.testing.assert_allclose((result.reached.x, result.reached.y, result.reached.z), HOME["left"][:3], atol=0.01)
    sent = [message for _, arm, message in cell.driver.trajectories[-5:] if arm == "left"]
    assert len(sent) == 5


def test_the_last_outcome_is_there_for_whoever_comes_late(cell):
    push = cell.push(policy="mine", target_id=3)
    cell.execute(push)
    late = Mailbox(cell.client, PushOutcome, "last_outcome", LATCHED)
    message = late.wait()
    assert (message.code, message.push.policy, message.push.target_id) == (ResultCode.OK, "mine", 3)
    assert message.push.header.stamp == push.header.stamp


@pytest.mark.parametrize("phase", [Phase.GRIPPER, Phase.PUSH])
def test_cancelled_means_standing_still(cell, phase):
    cell.executor.planner.duration = 2.0
    goal = cell.send()
    cell.reach(phase)
    goal.cancel_goal_async()
    status, result = cell.result(goal)
    assert cell.stands()
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_CANCELED, ResultCode.CANCELLED)
    assert cell.executor.planner.lifts == 0


def test_cancel_before_anything_moved(cell):
    cell.executor.planner.trouble = Blocker()
    goal = cell.send()
    assert cell.executor.planner.trouble.reached.wait(20.0)
    answer = goal.cancel_goal_async()
    wait_until(answer.done, what="answer to cancel")
    orders = len(cell.driver.trajectories)
    cell.executor.planner.trouble.released.set()
    status, result = cell.result(goal)
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_CANCELED, ResultCode.CANCELLED)
    assert "nothing had moved" in result.message
    assert len(cell.driver.trajectories) == orders


def test_cancel_twice_and_after_the_end(cell):
    cell.executor.planner.duration = 2.0
    goal = cell.send()
    cell.reach(Phase.PUSH)
    goal.cancel_goal_async()
    goal.cancel_goal_async()
    assert ended(cell.result(goal)) == (GoalStatus.STATUS_CANCELED, ResultCode.CANCELLED)
    late = goal.cancel_goal_async()
    wait_until(late.done, what="answer to cancel")
    assert not late.result().goals_canceling


def test_a_second_goal_is_refused_with_busy_and_the_first_goes_on(cell):
    cell.executor.planner.duration = 2.0
    first = cell.send()
    cell.reach(Phase.APPROACH)
    assert ended(cell.execute()) == (GoalStatus.STATUS_ABORTED, ResultCode.BUSY)
    assert ended(cell.result(first)) == (GoalStatus.STATUS_SUCCEEDED, ResultCode.OK)


def test_of_a_burst_of_goals_each_gets_its_answer(cell):
    goals = [cell.send() for _ in range(30)]
    codes = [ended(cell.result(goal)) for goal in goals]
    assert codes.count((GoalStatus.STATUS_SUCCEEDED, ResultCode.OK)) >= 1
    assert set(codes) <= {(GoalStatus.STATUS_SUCCEEDED, ResultCode.OK), (GoalStatus.STATUS_ABORTED, ResultCode.BUSY)}


def test_halt_stops_a_push(cell):
    cell.executor.planner.duration = 2.0
    goal = cell.send()
    cell.reach(Phase.PUSH)
    answer = call(cell.client, Trigger, "halt", Trigger.Request())
    assert answer.success
    assert cell.stands()
    assert ended(cell.result(goal)) == (GoalStatus.STATUS_ABORTED, ResultCode.HALTED)


def test_halt_holds_both_arms_when_nothing_is_executed(cell):
    before = len(cell.driver.trajectories)
    answer = call(cell.client, Trigger, "halt", Trigger.Request())
    assert answer.success
    wait_until(lambda: len(cell.driver.trajectories) == before + 2, what="two orders")
    for _, arm, message in cell.driver.trajectories[-2:]:
        np.testing.assert_allclose(message.points[-1].positions, HOME[arm], atol=1e-3)


def test_an_arm_that_was_stopped_in_the_view_leaves_it_when_asked(cell):
    cell.executor.planner.duration = 2.0
    goal = cell.send()
    cell.reach(Phase.PUSH)
    busy = call(cell.client, Trigger, "clear_view", Trigger.Request())
    assert not busy.success
    assert busy.message.startswith("BUSY")
    goal.cancel_goal_async()
    cell.result(goal)
    answer = call(cell.client, Trigger, "clear_view", Trigger.Request())
    assert answer.success
    assert answer.message == "OK: done"
    np.testing.assert_allclose(cell.driver.arms["left"].q, HOME["left"], atol=0.01)
    assert call(cell.client, Trigger, "clear_view", Trigger.Request()).message == "OK: no arm is in the camera's view"


def test_what_the_planner_refuses_has_its_code_and_nothing_moves(cell):
    def refuse():
        raise SingulationError(ResultCode.PATH_BLOCKED, "block 3 is in the way")

    cell.executor.planner.trouble = refuse
    orders = len(cell.driver.trajectories)
    status, result = cell.execute()
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_ABORTED, ResultCode.PATH_BLOCKED)
    assert result.message == "block 3 is in the way"
    assert len(cell.driver.trajectories) == orders
    wait_until(lambda: cell.outcomes.messages[-1].message == "block 3 is in the way", what="outcome")


def test_an_exception_is_an_internal_error_with_its_text(cell):
    cell.executor.planner.trouble = lambda: 1 // 0
    status, result = cell.execute()
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_ABORTED, ResultCode.INTERNAL)
    assert "ZeroDivisionError" in result.message


def test_a_defect_while_the_arm_moves_holds_it(cell, monkeypatch):
    cell.executor.planner.duration = 2.0
    goal = cell.send()
    cell.reach(Phase.PUSH)

    def broken(*_):
        raise RuntimeError("injected")

    with monkeypatch.context() as patch:
        patch.setattr("yumi_push_executor.supervision.supervisor.Supervisor.step", broken)
        status, result = cell.result(goal)
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_ABORTED, ResultCode.INTERNAL)
    assert "injected" in result.message
    wait_until(cell.stands, what="standstill")
    assert {arm for _, arm, _ in cell.driver.trajectories[-2:]} == set(ARMS)


@pytest.mark.parametrize(
    ("changes", "code", "text"),
    [
        ({"contact_width": float("nan")}, ResultCode.INVALID_INPUT, "contact width"),
        ({"contact_width": 0.01}, ResultCode.INVALID_INPUT, "contact width"),
    ],
)
def test_malformed_pushes_are_refused(cell, changes, code, text):
    status, result = cell.execute(cell.push(**changes))
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_ABORTED, code)
    assert text in result.message


def test_pushes_that_do_not_fit_the_table_are_refused(cell):
    foreign, unknown, stampless, old = (cell.push() for _ in range(4))
    foreign.header.frame_id = "world"
    unknown.contact_mode.value = 9
    stampless.header.stamp.sec = stampless.header.stamp.nanosec = 0
    old.header.stamp.sec -= 31
    codes = [ResultCode(cell.execute(message)[1].code) for message in (foreign, unknown, stampless, old)]
    assert codes == [
        ResultCode.INVALID_INPUT,
        ResultCode.UNKNOWN_CONTACT_MODE,
        ResultCode.STALE_INPUT,
        ResultCode.STALE_INPUT,
    ]


def test_a_push_planned_before_the_last_motion_ended_is_stale(cell):
    push = cell.push()
    assert ended(cell.execute(push)) == (GoalStatus.STATUS_SUCCEEDED, ResultCode.OK)
    assert ended(cell.execute(push)) == (GoalStatus.STATUS_ABORTED, ResultCode.STALE_INPUT)


def test_the_arrangement_that_a_push_was_planned_on_is_kept_clear_of(cell):
    push = cell.push()
    for number in (1, 2):
        square = ((0.0, 0.0), (0.02, 0.0), (0.02, 0.02), (0.0, 0.02))
        message = arrangement_to_msg(Arrangement((PlanarObject(number, square),)))
        message.header.stamp.sec = push.header.stamp.sec
        message.header.stamp.nanosec = (push.header.stamp.nanosec + number - 1) % 10**9
        cell.objects.publish(message)
    wait_until(lambda: len(cell.executor._gate._seen) >= 2, what="objects")
    cell.execute(push)
    assert [item.id for item in cell.executor.planner.seen.objects] == [1]


def test_the_topic_push_is_only_executed_if_wanted(cell):
    received = cell.executor.ledger.counts()["received"]
    cell.pushes.publish(cell.push(policy="not wanted"))
    cell.execute()
    cell.executor.set_parameters([Parameter("auto_execute", value=True)])
    try:
        cell.pushes.publish(cell.push(policy="wanted"))
        wait_until(lambda: cell.outcomes.messages[-1].push.policy == "wanted", what="outcome")
    finally:
        cell.executor.set_parameters([Parameter("auto_execute", value=False)])
    assert cell.outcomes.messages[-1].code == ResultCode.OK
    assert cell.executor.ledger.counts()["received"] == received + 2


def drop(_):
    return None


def spoil(message):
    message.position[message.name.index("yumi_robr_joint_4")] = float("nan")
    return message


def cut(message):
    message.position.pop()
    return message


@pytest.mark.parametrize(("change", "text"), [(drop, "old"), (spoil, "right joint 4 is nan"), (cut, "old")])
def test_lost_states_end_the_push(cell, change, text):
    cell.executor.planner.duration = 1.0
    cell.driver.during(Phase.PUSH, 0.3, lambda: setattr(cell.driver, "change", change))
    status, result = cell.execute()
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_ABORTED, ResultCode.STATE_LOST)
    assert text in result.message
    assert cell.stands()


def test_an_emergency_stop_ends_the_push_and_its_release_resumes_nothing(cell):
    def press():
        cell.driver.state.mode, cell.driver.state.motion_enabled = DriverState.EMERGENCY_STOP, False

    cell.executor.planner.duration = 1.0
    cell.driver.during(Phase.PUSH, 0.3, press)
    assert ended(cell.execute()) == (GoalStatus.STATUS_ABORTED, ResultCode.SAFETY_STOP)
    with cell.driver.lock:
        cell.driver.state.mode, cell.driver.state.motion_enabled = DriverState.MOTORS_ON, True
        stopped = cell.driver.arms["left"].q
    released = cell.driver.time
    wait_until(lambda: cell.driver.time > released + 2.0, what="two seconds")
    np.testing.assert_allclose(cell.driver.arms["left"].q, stopped, atol=1e-3)


def test_a_held_arm_is_retreated(cell):
    cell.executor.planner.duration = 1.5
    lifts = cell.executor.planner.lifts
    cell.driver.during(Phase.PUSH, 0.4, lambda: setattr(cell.driver.arms["left"], "stuck", True))
    cell.driver.during(Phase.RETREAT, 0.0, lambda: setattr(cell.driver.arms["left"], "stuck", False))  # the stop
    status, result = cell.execute()
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_ABORTED, ResultCode.NO_PROGRESS)
    assert result.message.endswith("retreated upwards; left the camera's view")
    assert cell.executor.planner.lifts == lifts + 1
