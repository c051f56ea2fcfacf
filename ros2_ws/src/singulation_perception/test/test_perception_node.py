import gc
import sys
import threading
import time

import numpy as np
import psutil
import pytest
import rclpy
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.srv import DescribeParameters
from rclpy.context import Context
from rclpy.parameter import Parameter
from rclpy.qos import ReliabilityPolicy
from ros2_ws.src.singulation_perception.test.node_bench import SECOND, Bench
from ros2_ws.src.singulation_perception.test.table_scene import BLOCKS, HEIGHT, message, scene

from singulation_node.testing import call, reserved_domain, spinning, wait_until
from singulation_perception import perception_node


@pytest.mark.parametrize("reliability", [ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT])
def test_objects_carry_the_stamp_of_the_cloud_and_stand_where_the_blocks_are(ros_context, reliability):
    bench = Bench(ros_context, reliability=reliability)
    with spinning(bench.node, bench.camera):
        bench.start()
        found = bench.good()
    assert found.header.stamp.sec * SECOND + found.header.stamp.nanosec == bench.stamp
    assert found.header.frame_id == "table"
    centres = sorted((one.centroid.x, one.centroid.y) for one in found.objects)
    np.testing.assert_allclose(centres, sorted(BLOCKS), atol=0.002)
    assert [one.height for one in found.objects] == pytest.approx([HEIGHT] * 3, abs=0.001)


def test_while_a_cloud_is_in_work_only_the_newest_waits(bench, monkeypatch):
    begun, gate, original = threading.Event(), threading.Event(), perception_node.segment_cloud

    def slow(*arguments):
        begun.set()
        assert gate.wait(timeout=20)
        return original(*arguments)

    monkeypatch.setattr(perception_node, "segment_cloud", slow)
    bench.points.publish(message(scene(), bench.next_stamp()))
    assert begun.wait(timeout=20)
    for count in range(2, 7):
        bench.points.publish(message(scene(), bench.next_stamp()))
        wait_until(lambda count=count: bench.ledger.received == count)
    assert bench.ledger.superseded == 4
    gate.set()
    newest = bench.objects.wait(2)
    assert newest.header.stamp.sec * SECOND + newest.header.stamp.nanosec == bench.stamp
    wait_until(lambda: bench.ledger.pending == 0)
    assert (bench.ledger.received, bench.ledger.published, bench.ledger.superseded) == (6, 2, 4)


def test_an_exception_inside_the_library_rejects_one_cloud(bench, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(perception_node, "segment_cloud", lambda *_: 1 / 0)
        assert bench.see() == (0, ["INTERNAL"])
    assert "ZeroDivisionError" in bench.ledger.last_error
    bench.good()


def test_a_cloud_beyond_max_points_is_refused_until_the_limit_is_raised(bench):
    assert bench.node.set_parameters([Parameter("max_points", value=100)])[0].successful
    assert bench.see() == (0, ["CLOUD_TOO_LARGE"])
    assert bench.node.set_parameters([Parameter("max_points", value=1_000_000)])[0].successful
    bench.good()


def test_age_is_checked_when_wanted(bench):
    assert bench.node.set_parameters([Parameter("check_age", value=True), Parameter("max_age", value=60.0)])[
        0
    ].successful
    assert bench.see() == (0, ["STALE_INPUT"])
    bench.stamp = time.time_ns() - 2 * SECOND
    bench.good()


def test_a_smaller_workspace_takes_effect_with_the_next_cloud(bench):
    assert len(bench.good().objects) == 3
    assert bench.node.set_parameters([Parameter("workspace", value=[-0.14, -0.03, -0.14, 0.14])])[0].successful
    assert len(bench.good().objects) == 1
    refused = bench.node.set_parameters([Parameter("workspace", value=[0.1, -0.1, -0.1, 0.1])])[0]
    assert not refused.successful
    assert "x_min < x_max" in refused.reason
    assert len(bench.good().objects) == 1


def test_parameters_are_described_with_their_ranges(bench):
    names = ["tolerance", "camera_pose_source", "min_size"]
    request = DescribeParameters.Request(names=names)
    answer = call(bench.camera, DescribeParameters, "perception_node/describe_parameters", request)
    tolerance, source, size = answer.descriptors
    assert "[m]" in tolerance.description
    assert tolerance.floating_point_range[0].from_value > 0.0
    assert "plane_fit" in source.additional_constraints
    assert size.type == ParameterType.PARAMETER_INTEGER


def test_an_inactive_node_takes_no_clouds_and_goes_on_after_activation(bench):
    def change(transition):
        request = ChangeState.Request(transition=Transition(id=transition))
        assert call(bench.camera, ChangeState, "perception_node/change_state", request).success

    bench.good()
    change(Transition.TRANSITION_DEACTIVATE)
    wait_until(lambda: bench.points.get_subscription_count() == 0)
    change(Transition.TRANSITION_CLEANUP)
    change(Transition.TRANSITION_CONFIGURE)
    change(Transition.TRANSITION_ACTIVATE)
    wait_until(lambda: bench.points.get_subscription_count() > 0)
    wait_until(lambda: bench.node.count_publishers("objects") > 0)
    bench.good()


def test_deactivation_accounts_for_the_waiting_cloud(bench, monkeypatch):
    begun, gate, original = threading.Event(), threading.Event(), perception_node.segment_cloud

    def slow(*arguments):
        begun.set()
        assert gate.wait(timeout=20)
        return original(*arguments)

    monkeypatch.setattr(perception_node, "segment_cloud", slow)
    bench.points.publish(message(scene(), bench.next_stamp()))
    assert begun.wait(timeout=20)
    bench.points.publish(message(scene(), bench.next_stamp()))
    wait_until(lambda: bench.ledger.received == 2)
    threading.Timer(0.2, gate.set).start()
    bench.node.trigger_deactivate()
    assert (bench.ledger.published, bench.ledger.superseded, bench.ledger.pending) == (1, 1, 0)


def test_tf_without_tf2_ros_fails_to_configure_and_parameters_work_afterwards(ros_context, monkeypatch):
    monkeypatch.setitem(sys.modules, "tf2_ros", None)
    bench = Bench(ros_context, Parameter("camera_pose_source", value="tf"))
    with spinning(bench.node, bench.camera):
        assert not bench.node.start()
        state = call(bench.camera, GetState, "perception_node/get_state", GetState.Request()).current_state
        assert state.id == State.PRIMARY_STATE_UNCONFIGURED
        bench.node.set_parameters([Parameter("camera_pose_source", value="parameters")])
        bench.start()
        bench.good()


def test_switching_to_tf_while_running_rejects_clouds_but_not_the_node(bench, monkeypatch):
    monkeypatch.setitem(sys.modules, "tf2_ros", None)
    bench.node.set_parameters([Parameter("camera_pose_source", value="tf")])
    assert bench.see() == (0, ["NO_TRANSFORM"])
    bench.node.set_parameters(
        [Parameter("camera_pose_source", value="plane_fit"), Parameter("crop_to_workspace", value=False)]
    )
    assert len(bench.good().objects) == 3


def sockets():
    return len(psutil.Process().net_connections("udp"))


def test_a_destroyed_node_leaves_its_place_in_the_domain():
    gc.collect()
    before = sockets()
    with reserved_domain() as domain:
        context = Context()
        rclpy.init(context=context, domain_id=domain)
        bench = Bench(context)
        with spinning(bench.node, bench.camera):
            bench.start()
            assert bench.good().objects
        context.try_shutdown()
    del bench, context
    wait_until(lambda: gc.collect() >= 0 and sockets() <= before, what="the end of the DDS participant")
