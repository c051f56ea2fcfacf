"""The coordinator over ROS, with a scripted cell node that plans, pushes and looks."""

import threading
import time

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from singulation_msgs.action import ExecutePush, Singulate
from singulation_msgs.msg import Arrangement as ArrangementMsg
from singulation_msgs.msg import ContactMode as ContactModeMsg
from singulation_msgs.msg import PushOutcome
from singulation_msgs.srv import PlanPush
from std_msgs.msg import Header
from std_srvs.srv import Trigger

from singulation_bringup.singulate_node import SingulateNode
from singulation_core import Arrangement, ContactMode, PlanarObject, Push, ResultCode, conversions
from singulation_node.action_client import PatientActionClient
from singulation_node.qos import RECORD, STATE
from singulation_node.testing import Mailbox, spinning, wait_until

SQUARE = np.array(((0.0, 0.0), (0.04, 0.0), (0.04, 0.04), (0.0, 0.04)))


class ScriptedCell(Node):
    """Camera, planner and robot in one: every push widens the gap by 10 mm."""

    def __init__(self, context):
        super().__init__("scripted_cell", context=context)
        self.gap, self.blind, self.code, self.slow = 0.001, False, ResultCode.OK, False
        self.stood_still, self.pushing = threading.Event(), threading.Event()
        self.lost_clouds, self.triggers, self.cancel_code = 0, 0, ResultCode.CANCELLED
        self.asked = []
        self.stale, self.cleared, self.blocked, self.takes_pushes = False, 0, False, True
        group = ReentrantCallbackGroup()
        self.objects = self.create_publisher(ArrangementMsg, "objects", STATE)
        self.create_service(Trigger, "trigger_frame", self.trigger, callback_group=group)
        self.create_service(Trigger, "clear_view", self.clear_view, callback_group=group)
        self.create_service(PlanPush, "plan_push", self.plan, callback_group=group)
        self.server = ActionServer(
            self,
            ExecutePush,
            "execute_push",
            self.execute,
            callback_group=group,
            goal_callback=lambda _: GoalResponse.ACCEPT if self.takes_pushes else GoalResponse.REJECT,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )

    def trigger(self, request, response):
        blocks = [PlanarObject(7 * i, SQUARE + (i * (0.04 + self.gap), 0.0)) for i in range(2)]
        self.triggers += 1
        stamp = (self.get_clock().now() - Duration(seconds=5.0 * self.stale)).to_msg()
        if not self.blind and self.triggers > self.lost_clouds:
            self.objects.publish(conversions.arrangement_to_msg(Arrangement(blocks), stamp))
        response.success = True
        return response

    def clear_view(self, request, response):
        self.cleared += 1
        response.success, response.message = not self.blocked, "UNREACHABLE: scripted"
        return response

    def plan(self, request, response):
        push = Push((-0.02, 0.02), (0.02, 0.02), ContactMode.SINGLE_POINT, target_id=7, policy=request.policy)
        self.asked.append((request.policy, request.policy_options))
        response.push = conversions.push_to_msg(push, Header(frame_id="table", stamp=request.arrangement.header.stamp))
        return response

    def execute(self, handle):
        self.pushing.set()
        while self.slow and not handle.is_cancel_requested:
            time.sleep(0.01)
        if handle.is_cancel_requested:
            self.stood_still.set()
            handle.canceled()
            return ExecutePush.Result(code=int(self.cancel_code), message="scripted end of a cancelled push")
        if self.code is ResultCode.OK:
            self.gap += 0.01
            handle.succeed()
        else:
            handle.abort()
        return ExecutePush.Result(code=int(self.code), message="scripted")


@pytest.fixture
def setting(ros_context):
    quick = [Parameter(name, value=0.5) for name in ("view_timeout", "ready_timeout")]
    node, cell = SingulateNode(context=ros_context, parameter_overrides=quick), ScriptedCell(ros_context)
    with spinning(node, cell, threads=8):
        assert node.start()
        yield node, cell
        cell.slow = False
        cell.server.destroy()


@pytest.fixture
def ask(setting):
    client = PatientActionClient(setting[1], Singulate, "singulate")
    wait_until(client.server_is_ready, what="singulate")
    feedback = []

    def send(**fields):
        goal = Singulate.Goal(**{"max_pushes": 5, "min_gap": 0.02, **fields})
        future = client.send_goal_async(goal, feedback_callback=lambda message: feedback.append(message.feedback))
        wait_until(future.done, what="answer")
        return future.result()

    send.feedback = feedback
    yield send
    client.destroy()


def outcome(handle):
    future = handle.get_result_async()
    wait_until(future.done, what="result")
    return future.result().status, future.result().result


def expect_success(ask):
    status, result = outcome(ask())
    assert (status, result.code) == (GoalStatus.STATUS_SUCCEEDED, ResultCode.OK)
    return result


def test_it_singulates_and_tells_every_push(setting, ask):
    outcomes = Mailbox(setting[1], PushOutcome, "outcomes", RECORD)
    result = expect_success(ask)
    assert len(result.outcomes) == 2
    assert len(result.singulation_distance) == 3
    assert result.smallest_gap == pytest.approx(0.021, abs=1e-6)
    assert outcomes.wait(2).push.policy == "rollout_push"
    assert setting[1].asked[0] == ("rollout_push", "objective=clearance clearance_width=0.022")
    assert outcomes.messages[0].push.target_id == 1  # lasting id of perception's 7
    assert outcomes.messages[0].singulation_distance_after > outcomes.messages[0].singulation_distance_before
    assert [message.pushes_done for message in ask.feedback] == sorted(m.pushes_done for m in ask.feedback)


def test_a_camera_that_sends_nothing_is_no_fresh_view(setting, ask):
    setting[1].blind = True
    status, result = outcome(ask())
    assert (status, result.code) == (GoalStatus.STATUS_ABORTED, ResultCode.NO_FRESH_VIEW)
    assert "within 0.5 s" in result.message
    setting[1].blind = False
    expect_success(ask)


def test_a_cloud_that_got_lost_is_asked_for_again(setting, ask):
    setting[1].lost_clouds = 2
    result = expect_success(ask)
    assert len(result.outcomes) == 2
    assert setting[1].triggers == 5  # three for the first look, one after each push


def test_a_view_from_before_the_last_motion_is_not_taken(setting, ask):
    setting[1].stale = True
    status, result = outcome(ask())
    assert (status, result.code) == (GoalStatus.STATUS_ABORTED, ResultCode.NO_FRESH_VIEW)
    setting[1].stale = False
    expect_success(ask)


def test_the_arms_leave_the_view_at_the_start_and_after_a_push_that_failed(setting, ask):
    expect_success(ask)
    assert setting[1].cleared == 1
    setting[1].gap, setting[1].code = 0.001, ResultCode.COLLISION_STOP
    assert outcome(ask())[1].code == ResultCode.PUSH_FAILED
    assert setting[1].cleared == 1 + 1 + 2  # at the start, and after each of two failures
    setting[1].code = ResultCode.OK
    expect_success(ask)


def test_an_executor_that_takes_no_push_ends_the_goal(setting, ask):
    setting[1].takes_pushes = False
    status, result = outcome(ask())
    assert (status, result.code) == (GoalStatus.STATUS_ABORTED, ResultCode.REJECTED)
    assert "execute_push rejected the goal; its log says why" in result.message
    setting[1].takes_pushes = True
    expect_success(ask)


def test_arms_that_cannot_leave_the_view_are_no_view(setting, ask):
    setting[1].blocked = True
    status, result = outcome(ask())
    assert (status, result.code) == (GoalStatus.STATUS_ABORTED, ResultCode.NOT_READY)
    assert "UNREACHABLE: scripted" in result.message
    setting[1].blocked = False
    expect_success(ask)


def test_a_goal_without_a_gap_takes_the_parameters(setting, ask):
    result = outcome(ask(min_gap=0.0))[1]
    assert result.code == ResultCode.OK
    assert len(result.outcomes) == 2  # 1 mm, 11 mm, 21 mm: the default lies between the last two
    assert result.smallest_gap >= setting[0].settings.min_gap


def test_a_cancelled_push_that_did_not_stop_well_is_not_called_cancelled(setting, ask):
    setting[1].slow, setting[1].cancel_code = True, ResultCode.PATH_TOLERANCE
    handle = ask()
    wait_until(setting[1].pushing.is_set, what="a push")
    wait_until(handle.cancel_goal_async().done, what="answer to the cancel")
    result = outcome(handle)[1]
    assert setting[1].stood_still.is_set()
    assert [one.code for one in result.outcomes] == [ResultCode.PATH_TOLERANCE]
    setting[1].slow, setting[1].cancel_code = False, ResultCode.CANCELLED
    expect_success(ask)


def test_a_push_that_takes_too_long_is_stopped_and_looked_at_again(ros_context):
    quick = [Parameter(name, value=value) for name, value in (("ready_timeout", 0.5), ("execute_timeout", 1.0))]
    node, cell = SingulateNode(context=ros_context, parameter_overrides=quick), ScriptedCell(ros_context)
    cell.slow = True
    with spinning(node, cell, threads=8):
        assert node.start()
        client = PatientActionClient(cell, Singulate, "singulate")
        wait_until(client.server_is_ready, what="singulate")
        for slow, expected in ((True, ResultCode.PUSH_FAILED), (False, ResultCode.OK)):
            cell.slow = slow
            future = client.send_goal_async(Singulate.Goal(max_pushes=5, min_gap=0.02))
            wait_until(future.done, what="answer")
            result = outcome(future.result())[1]
            assert result.code == expected
            if slow:
                assert [one.code for one in result.outcomes] == [ResultCode.TIMEOUT] * 2
                assert "was stopped" in result.outcomes[0].message
        client.destroy()
        cell.server.destroy()


def test_a_fault_of_the_robot_ends_it_with_its_code(setting, ask):
    setting[1].code = ResultCode.SAFETY_STOP
    status, result = outcome(ask())
    assert (status, result.code) == (GoalStatus.STATUS_ABORTED, ResultCode.SAFETY_STOP)
    assert [one.code for one in result.outcomes] == [ResultCode.SAFETY_STOP]
    setting[1].code = ResultCode.OK
    expect_success(ask)


def test_cancelled_means_standing_still(setting, ask):
    setting[1].slow = True
    handle = ask()
    wait_until(setting[1].pushing.is_set, what="a push")
    wait_until(handle.cancel_goal_async().done, what="answer to the cancel")
    status, result = outcome(handle)
    assert (status, result.code) == (GoalStatus.STATUS_CANCELED, ResultCode.CANCELLED)
    assert setting[1].stood_still.is_set()
    setting[1].slow = False
    expect_success(ask)


def test_a_second_goal_is_refused_while_one_runs(setting, ask):
    setting[1].slow = True
    first = ask()
    wait_until(lambda: ask.feedback, what="first look")
    assert not ask().accepted
    setting[1].slow = False
    assert outcome(first)[1].code == ResultCode.OK
    setting[1].gap = 0.001
    expect_success(ask)


@pytest.mark.parametrize("gap", [-0.01, float("nan"), 5.0])
def test_a_senseless_goal_is_rejected(ask, gap):
    assert not ask(min_gap=gap).accepted
    expect_success(ask)


def test_an_unknown_contact_mode_names_the_known_ones(ask):
    status, result = outcome(ask(contact_mode=ContactModeMsg(value=9)))
    assert (status, result.code) == (GoalStatus.STATUS_ABORTED, ResultCode.UNKNOWN_CONTACT_MODE)
    assert "two_point" in result.message
    expect_success(ask)


def test_what_is_missing_is_named(ros_context):
    quick = [Parameter(name, value=0.2) for name in ("view_timeout", "ready_timeout")]
    node, client_node = (
        SingulateNode(context=ros_context, parameter_overrides=quick),
        Node("client", context=ros_context),
    )
    with spinning(node, client_node):
        assert node.start()
        client = PatientActionClient(client_node, Singulate, "singulate")
        wait_until(client.server_is_ready, what="singulate")
        future = client.send_goal_async(Singulate.Goal(max_pushes=1, min_gap=0.01))
        wait_until(future.done)
        status, result = outcome(future.result())
        client.destroy()
    assert (status, result.code) == (GoalStatus.STATUS_ABORTED, ResultCode.NOT_READY)
    assert "plan_push" in result.message
