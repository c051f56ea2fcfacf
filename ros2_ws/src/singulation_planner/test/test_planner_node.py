import time

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.parameter import Parameter
from singulation_msgs import msg as messages
from singulation_msgs.srv import PlanPush
from visualization_msgs.msg import MarkerArray

from singulation_core import ContactMode, ResultCode
from singulation_core.conversions import arrangement_from_msg, arrangement_to_msg, push_from_msg
from singulation_node.testing import Mailbox, call, spinning, wait_until
from singulation_planner import plan_push
from singulation_planner.planner_node import PlannerNode
from singulation_planner.testing import clutter, squares


@pytest.fixture
def node(ros_context):
    made = PlannerNode(context=ros_context)
    with spinning(made):
        assert made.start()
        yield made


def fresh(node, arrangement, age=0.0):
    stamp = node.get_clock().now().nanoseconds - int(1e9 * age)
    message = arrangement_to_msg(arrangement)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
    return message


def ask(node, arrangement, policy="", mode=ContactMode.SINGLE_POINT):
    request = PlanPush.Request(arrangement=arrangement, policy=policy)
    request.contact_mode.value = int(mode)
    return call(node, PlanPush, "plan_push", request)


def sender(node):
    publisher = node.create_publisher(messages.Arrangement, "objects", 10)
    wait_until(lambda: publisher.get_subscription_count() == 1, what="subscription")
    return publisher


def test_each_arrangement_is_answered_by_the_push_of_the_library(node):
    pushes, objects = Mailbox(node, messages.PushTrajectory, "push"), sender(node)
    message = fresh(node, clutter(5, 1))
    objects.publish(message)
    got = pushes.wait()
    planned = plan_push(arrangement_from_msg(message), workspace=node.settings.workspace_polygon())
    assert got.header == message.header
    assert got.policy == "cluster_push"
    assert got.target_id == planned.target_id
    np.testing.assert_allclose(push_from_msg(got).end, planned.end, atol=1e-6)
    assert np.isnan(got.expected_gain)


def test_the_service_plans_with_the_asked_policy_and_mode(node):
    answer = ask(node, fresh(node, clutter(6, 2)), "cluster_push", ContactMode.TWO_POINT)
    assert answer.code == ResultCode.OK, answer.message
    assert answer.push.contact_mode.value == ContactMode.TWO_POINT
    assert answer.push.contact_width > 0.0
    assert 0.0 < answer.planning_time < 10.0


@pytest.mark.parametrize(("age", "what"), [(60.0, "60."), (-5.0, "-4.")])
def test_arrangements_of_another_time_are_refused(node, age, what):
    answer = ask(node, fresh(node, clutter(3, 1), age))
    assert answer.code == ResultCode.STALE_INPUT
    assert what in answer.message
    assert ask(node, fresh(node, clutter(3, 1))).code == ResultCode.OK


def test_an_arrangement_without_a_stamp_is_refused(node):
    answer = ask(node, arrangement_to_msg(clutter(3, 1)))
    assert answer.code == ResultCode.STALE_INPUT
    assert ask(node, fresh(node, clutter(3, 1))).code == ResultCode.OK


def broken_outline(message):
    message.objects[0].outline.points[0].x = float("nan")


def mixed_ids(message):
    message.objects[1].id = message.objects[0].id


def other_frame(message):
    message.header.frame_id = "yumi_body"


def reversed_outline(message):
    message.objects[0].outline.points = message.objects[0].outline.points[::-1]


@pytest.mark.parametrize("damage", [broken_outline, mixed_ids, other_frame, reversed_outline])
def test_malformed_arrangements_are_refused_and_the_next_one_is_planned(node, damage):
    pushes, diagnostics = Mailbox(node, messages.PushTrajectory, "push"), Mailbox(node, DiagnosticArray, "/diagnostics")
    objects = sender(node)
    message = fresh(node, clutter(4, 3))
    damage(message)
    answer = ask(node, message)
    assert answer.code == ResultCode.INVALID_INPUT
    assert answer.message
    objects.publish(message)
    wait_until(lambda: node.outcomes["INVALID_INPUT"] == 2, what="refusal of the published arrangement")
    wait_until(lambda: _planning(diagnostics, DiagnosticStatus.ERROR, "INVALID_INPUT"), what="diagnostics")
    assert not pushes.messages
    objects.publish(fresh(node, clutter(4, 3)))
    pushes.wait()
    shown = wait_until(lambda: _planning(diagnostics, DiagnosticStatus.OK, "OK"), what="diagnostics")
    values = {pair.key: pair.value for pair in shown.values}
    assert 0.0 < float(values["planning_time"]) < 10.0
    assert values["policy"] == "cluster_push"
    assert values["count INVALID_INPUT"] == "2"


def _planning(mailbox, level, text):
    found = [one for message in mailbox.messages for one in message.status if one.name == "planner_node: planning"]
    return found[-1] if found and found[-1].level == level and found[-1].message.startswith(text) else None


def test_codes_of_the_planner_come_through(node):
    assert ask(node, fresh(node, squares([(0.0, 0.0)]))).code == ResultCode.NOTHING_TO_DO
    assert ask(node, fresh(node, squares([(0.0, 0.0), (0.005, 0.0)]))).code == ResultCode.OVERLAPPING_OBJECTS
    assert ask(node, fresh(node, squares([(0.0, 0.0), (0.5, 0.0)]))).code == ResultCode.OUTSIDE_WORKSPACE
    unknown = ask(node, fresh(node, clutter(3, 1)), "no_such_policy")
    assert unknown.code == ResultCode.UNKNOWN_POLICY
    assert "cluster_push" in unknown.message
    assert ask(node, fresh(node, clutter(3, 1)), mode=7).code == ResultCode.UNKNOWN_CONTACT_MODE
    assert ask(node, fresh(node, clutter(3, 1))).code == ResultCode.OK


def test_only_on_request_when_told_so(node):
    pushes, objects = Mailbox(node, messages.PushTrajectory, "push"), sender(node)
    node.set_parameters([Parameter("plan_on_arrival", value=False)])
    objects.publish(fresh(node, clutter(4, 3)))
    assert ask(node, fresh(node, clutter(4, 3))).code == ResultCode.OK
    node.set_parameters([Parameter("plan_on_arrival", value=True)])
    objects.publish(fresh(node, clutter(4, 3)))
    assert len(pushes.messages) <= 1
    pushes.wait()
    assert node.outcomes["OK"] == 2


def test_markers_show_objects_push_and_jaws_only_when_somebody_looks(node):
    assert ask(node, fresh(node, clutter(6, 2))).code == ResultCode.OK
    markers = Mailbox(node, MarkerArray, "planner/markers")
    wait_until(lambda: node.count_subscribers("planner/markers") == 1)
    wait_until(lambda: ask(node, fresh(node, clutter(6, 2)), mode=ContactMode.TWO_POINT) and markers.messages)
    shown = markers.wait().markers
    names = [marker.ns for marker in shown[1:]]
    assert [names.count(name) for name in ("outline", "bounding_circle", "id", "push", "contact")] == [6, 6, 6, 1, 2]
    assert all(marker.header.frame_id == "table" for marker in shown)


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("policy", "no_such_policy", "cluster_push"),
        ("policy_options", "case_one=sometimes", "both"),
        ("policy_options", "case_one", "name=value"),
        ("workspace", [0.1, -0.1, 0.0, 1.0], "x_min"),
        ("workspace", [0.0, 0.0, 1.0, 0.0, 1.0], "pairs"),
        ("workspace", [0.0, 0.0, 0.0, 1.0, 1.0, 0.0], "clockwise"),
        ("push_distance_factor", float("nan"), "push_distance_factor"),
        ("tip_radius", -1.0, "tip_radius"),
    ],
)
def test_bad_parameters_are_refused_and_nothing_changes(node, name, value, reason):
    before = node.settings
    result = node.set_parameters([Parameter(name, value=value)])[0]
    assert not result.successful
    assert reason in result.reason
    assert node.settings == before
    assert ask(node, fresh(node, clutter(3, 1))).code == ResultCode.OK


def test_options_and_workspace_corners_are_used(node):
    triangle = [-0.2, -0.2, 0.3, -0.2, -0.2, 0.3]
    changes = [Parameter("policy_options", value="case_one=never path=line"), Parameter("workspace", value=triangle)]
    assert all(result.successful for result in node.set_parameters(changes))
    message = fresh(node, clutter(10, 4))
    answer = ask(node, message)
    options = {"case_one": "never", "path": "line"}
    corners = np.reshape(triangle, (3, 2))
    planned = plan_push(arrangement_from_msg(message), workspace=corners, **options)
    np.testing.assert_allclose(push_from_msg(answer.push).end, planned.end, atol=1e-6)


def test_separated_objects_are_left_alone_when_told_so(node):
    pair = squares([(0.0, 0.0), (0.05, 0.0)])
    assert ask(node, fresh(node, pair)).code == ResultCode.OK
    node.set_parameters([Parameter("leave_separated", value=True)])
    assert ask(node, fresh(node, pair)).code == ResultCode.NOTHING_TO_DO
    node.set_parameters([Parameter("min_gap", value=0.04)])
    assert ask(node, fresh(node, pair)).code == ResultCode.OK


def test_markers_that_fail_do_not_cost_the_push(node, monkeypatch):
    def broken(*_):
        raise RuntimeError("no paint")

    monkeypatch.setattr("singulation_planner.planner_node.planner_markers", broken)
    Mailbox(node, MarkerArray, "planner/markers")
    wait_until(lambda: node._markers.get_subscription_count() == 1, what="subscription")
    assert ask(node, fresh(node, clutter(4, 3))).code == ResultCode.OK


def test_a_burst_is_answered_or_superseded_never_queued(node):
    objects = sender(node)
    for _ in range(50):
        objects.publish(fresh(node, clutter(3, 1)))
    deadline = time.monotonic() + 20.0
    assert ask(node, fresh(node, clutter(3, 1))).code == ResultCode.OK
    assert time.monotonic() < deadline
