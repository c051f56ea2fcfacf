"""Starting, stopping and losing the node or its client in the middle of a push; and parameters that make no sense."""

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from fake_robot import HOME
from geometry_msgs.msg import Point32, Polygon
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from node_cell import NodeCell
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from singulation_msgs.action import ExecutePush
from singulation_msgs.msg import Arrangement, DriverState, PlanarObject
from std_srvs.srv import Trigger

from singulation_core import InvalidInputError, ResultCode
from singulation_node.action_client import PatientActionClient
from singulation_node.qos import STATE
from singulation_node.testing import Mailbox, call, spinning, wait_until
from yumi_push_executor.executor_settings import ExecutorSettings
from yumi_push_executor.supervision import Phase


@pytest.fixture
def cell(ros_context):
    made = NodeCell(ros_context)
    with spinning(*made.nodes, threads=6):
        made.start()
        yield made


def change(cell, transition):
    request = ChangeState.Request(transition=Transition(id=transition))
    return call(cell.client, ChangeState, "executor_node/change_state", request).success


def require_good_push(cell):
    cell.ready()
    cell.heal()
    status, result = cell.execute()
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_SUCCEEDED, ResultCode.OK), result.message
    counts = cell.executor.ledger.counts()
    assert counts["open"] == 0


def test_a_deactivated_node_stops_its_push_refuses_others_and_comes_back(cell):
    cell.executor.planner.duration = 2.0
    goal = cell.send()
    cell.reach(Phase.PUSH)
    assert change(cell, Transition.TRANSITION_DEACTIVATE)
    assert cell.stands()
    status, result = cell.result(goal)
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_ABORTED, ResultCode.HALTED)
    assert "deactivated" in result.message

    status, result = cell.execute()
    assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_ABORTED, ResultCode.NOT_READY)
    assert call(cell.client, Trigger, "halt", Trigger.Request()).success

    assert change(cell, Transition.TRANSITION_CLEANUP)
    wait_until(lambda: not cell.action.server_is_ready(), what="the action's end")
    assert change(cell, Transition.TRANSITION_CONFIGURE)
    assert change(cell, Transition.TRANSITION_ACTIVATE)
    require_good_push(cell)


def test_a_node_that_is_shut_down_stops_its_push_first(cell):
    """What SIGINT and SIGTERM do to a node that runs."""
    cell.executor.planner.duration = 2.0
    answer = cell.send().get_result_async()  # asked for while there is somebody to ask
    cell.reach(Phase.PUSH)
    assert change(cell, Transition.TRANSITION_ACTIVE_SHUTDOWN)
    assert cell.stands()
    wait_until(answer.done, what="result")
    assert (answer.result().status, answer.result().result.code) == (GoalStatus.STATUS_ABORTED, ResultCode.HALTED)


def test_a_push_goes_on_without_its_client_and_the_next_client_is_served(cell):
    lonely = Node("lonely", context=cell.client.context)
    cell.client.executor.add_node(lonely)
    action = PatientActionClient(lonely, ExecutePush, "execute_push")
    wait_until(action.server_is_ready, what="the action")
    future = action.send_goal_async(ExecutePush.Goal(push=cell.push()))
    wait_until(future.done, what="goal response")
    cell.client.executor.remove_node(lonely)
    action.destroy()
    lonely.destroy_node()
    wait_until(lambda: cell.outcomes.messages, what="outcome")
    assert cell.outcomes.messages[-1].code == ResultCode.OK
    require_good_push(cell)


def test_a_result_may_be_asked_for_late_and_twice(cell):
    goal = cell.send()
    wait_until(lambda: cell.outcomes.messages, what="outcome")
    for _ in range(2):
        assert cell.result(goal)[1].code == ResultCode.OK
    require_good_push(cell)


def test_a_controller_that_is_not_there_is_noticed_before_anything_moves(ros_context):
    cell = NodeCell(ros_context)
    nobody = [sub for sub in cell.driver.subscriptions if sub.topic_name == "/left_arm_controller/joint_trajectory"]
    cell.driver.destroy_subscription(nobody[0])
    with spinning(*cell.nodes, threads=6):
        assert cell.executor.start()
        wait_until(lambda: cell.executor._view.driver and cell.executor._view.watch.latest, what="states")
        wait_until(lambda: len(cell.executor._controllers.problems()) == 1, what="controllers")
        status, result = cell.execute()
        assert (status, ResultCode(result.code)) == (GoalStatus.STATUS_ABORTED, ResultCode.NOT_READY)
        assert "no controller listens on /left_arm_controller/joint_trajectory" in result.message
        np.testing.assert_allclose(cell.driver.arms["left"].q, HOME["left"], atol=1e-3)
        cell.driver._listen("left")
        require_good_push(cell)


def test_somebody_else_who_gives_orders_is_shown(cell):
    from trajectory_msgs.msg import JointTrajectory

    cell.client.create_publisher(JointTrajectory, "right_arm_controller/joint_trajectory", 1)
    expected = ["1 other publishers on /right_arm_controller/joint_trajectory"]
    wait_until(lambda: cell.executor._controllers.problems() == expected, what="the problem")


def test_limits_can_be_changed_while_it_runs_and_nonsense_is_rejected(cell):
    results = cell.executor.set_parameters([Parameter("goal_tolerance", value=0.4)])
    assert "goal_tolerance 0.4 rad exceeds path_tolerance" in results[0].reason
    assert cell.executor.settings.goal_tolerance == ExecutorSettings().goal_tolerance
    assert cell.executor.set_parameters([Parameter("path_tolerance", value=1e-3 * 1.5)])[0].successful is False
    assert cell.executor.set_parameters([Parameter("start_distance", value=0.001)])[0].successful
    require_good_push(cell)


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"left_arm_joints": ("a", "b")}, "left arm has 2"),
        ({"left_finger_joint": "yumi_robl_joint_1"}, "yumi_robl_joint_1"),
        ({"table_quaternion": (0.0, 0.0, 0.0, 0.5)}, "quaternion"),
        ({"table_position": (0.0, 0.0)}, "need x, y, z"),
        ({"goal_tolerance": 0.5}, "goal_tolerance"),
        ({"state_age": float("nan")}, "state_age"),
        ({"workspace": (1.0, 2.0)}, "need 4"),
    ],
)
def test_settings_that_contradict_each_other_are_refused(changes, text):
    with pytest.raises(InvalidInputError, match=text):
        ExecutorSettings(**changes)


def test_malformed_messages_are_shown_and_the_next_good_ones_count(cell):
    shown = Mailbox(cell.client, DiagnosticArray, "/diagnostics")

    def said(name):
        statuses = [status for message in shown.messages for status in message.status]
        return next((status for status in reversed(statuses) if status.name == f"executor_node: {name}"), None)

    square = [Point32(x=float(x), y=float(y)) for x, y in ((0, 0), (1, 0), (1, 1))]
    clockwise = PlanarObject(id=4, outline=Polygon(points=square[::-1]))
    header = cell.push().header
    cell.objects.publish(Arrangement(header=header, objects=[clockwise]))
    states = cell.client.create_publisher(JointState, "joint_states", STATE)
    drivers = cell.client.create_publisher(DriverState, "driver_state", STATE)
    wait_until(lambda: states.get_subscription_count() and drivers.get_subscription_count(), what="subscriptions")
    states.publish(JointState(header=header, name=["a", "b"], position=[1.0]))
    drivers.publish(DriverState(mode=99))
    expected = {
        "refused objects": "object 4: clockwise",
        "refused joint_states": "2 names, 1 positions",
        "refused driver_state": "mode 99",
    }
    for name, text in expected.items():
        status = wait_until(lambda name=name: said(name), what=name)
        assert text in status.message
    require_good_push(cell)
    good = ("joint states", "driver", "controllers", "goals", "last push", "state")
    wait_until(lambda: all(said(name) and said(name).level == DiagnosticStatus.OK for name in good), what="good states")
    wait_until(lambda: ("OK", "1") in [(pair.key, pair.value) for pair in said("goals").values], what="the count")
