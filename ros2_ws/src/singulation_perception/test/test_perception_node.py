import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.srv import DescribeParameters
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from ros2_ws.src.singulation_perception.test.table_scene import (
    BLOCKS,
    CAMERA_POSITION,
    CAMERA_QUATERNION,
    HEIGHT,
    message,
    scene,
)
from sensor_msgs.msg import PointCloud2, PointField
from singulation_msgs.msg import Arrangement
from visualization_msgs.msg import Marker, MarkerArray

from singulation_node.large_messages import PROFILE_VARIABLE
from singulation_node.testing import Mailbox, call, spinning, wait_until
from singulation_perception import perception_node
from singulation_perception.perception_node import PerceptionNode

CAMERA = [
    Parameter("camera_position", value=list(CAMERA_POSITION)),
    Parameter("camera_quaternion", value=list(CAMERA_QUATERNION)),
]
SECOND = 10**9


class Bench:
    """A perception node, a camera that publishes to it, and what comes out."""

    def __init__(self, context, *parameters, reliability=ReliabilityPolicy.RELIABLE):
        import rclpy

        self.node = PerceptionNode(context=context, parameter_overrides=[*CAMERA, *parameters])
        self.camera = rclpy.create_node("camera", context=context)
        self.points = self.camera.create_publisher(PointCloud2, "points", QoSProfile(depth=1, reliability=reliability))
        self.objects = Mailbox(self.camera, Arrangement, "objects")
        self.stamp = time.time_ns() - 1000 * SECOND

    def next_stamp(self):
        self.stamp += SECOND
        return self.stamp

    def start(self):
        assert self.node.start()
        wait_until(lambda: self.points.get_subscription_count() > 0)
        wait_until(lambda: self.node.count_subscribers("objects") > 0)

    def see(self, cloud=None):
        """Publish a cloud and wait until the node is through with it; its outcome as (published, rejected)."""
        before = self.ledger
        self.points.publish(message(scene(), self.next_stamp()) if cloud is None else cloud)
        wait_until(lambda: self.ledger.received > before.received and self.ledger.pending == 0, what="the outcome")
        after = self.ledger
        rejected = [name for name, count in after.rejected.items() if count > before.rejected.get(name, 0)]
        return after.published - before.published, rejected

    def good(self):
        """A good cloud gives its objects."""
        count = len(self.objects.messages)
        assert self.see() == (1, [])
        return self.objects.wait(count + 1)

    @property
    def ledger(self):
        return self.node.ledger.state(time.monotonic())


@pytest.fixture
def bench(ros_context):
    made = Bench(ros_context)
    with spinning(made.node, made.camera):
        made.start()
        yield made


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


def changed(**values):
    def change(cloud):
        for name, value in values.items():
            setattr(cloud, name, value)
        return cloud

    return change


def points_changed(function):
    def change(cloud):
        points = np.frombuffer(cloud.data, "<f4").reshape(cloud.height, cloud.width, 3)
        stamp = cloud.header.stamp.sec * SECOND + cloud.header.stamp.nanosec
        return message(function(points.copy()), stamp)

    return change


def random_points(points):
    return np.random.default_rng(1).uniform(0.2, 1.0, points.shape).astype(np.float32)


def stamped(sec):
    def change(cloud):
        cloud.header.stamp.sec = sec
        return cloud

    return change


BAD = {
    "empty": (lambda cloud: PointCloud2(header=cloud.header, fields=cloud.fields), "NO_POINTS"),
    "zero width": (changed(width=0), "BAD_LAYOUT"),
    "short data": (lambda cloud: changed(data=cloud.data[:-1])(cloud), "BAD_LAYOUT"),
    "long data": (lambda cloud: changed(data=cloud.data + cloud.data[:1])(cloud), "BAD_LAYOUT"),
    "no z": (lambda cloud: changed(fields=cloud.fields[:2])(cloud), "BAD_LAYOUT"),
    "big-endian by mistake": (changed(is_bigendian=True), None),
    "all missing as NaN": (points_changed(lambda points: points * np.float32(np.nan)), "NO_POINTS"),
    "all missing as zeros": (points_changed(lambda points: points * np.float32(0)), "NO_POINTS"),
    "all infinite": (points_changed(lambda points: points + np.float32(np.inf)), "NO_POINTS"),
    "all identical": (points_changed(lambda points: points * np.float32(0) + np.float32(0.5)), None),
    "millimetres": (points_changed(lambda points: points * np.float32(1000)), "NOT_METRES"),
    "no plane": (points_changed(random_points), None),
    "floor of the bin": (points_changed(lambda points: points + np.float32((0, 0, 0.05))), None),
    "stamp zero": (stamped(0), None),
    "from the future": (stamped(2**31 - 2), "STALE_INPUT"),
    "backwards": (stamped(1), "STALE_INPUT"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_cloud_is_rejected_with_a_code_publishes_nothing_and_the_next_good_one_works(bench, name):
    change, code = BAD[name]
    bench.good()
    published, rejected = bench.see(change(message(scene(), bench.next_stamp())))
    assert published == 0
    assert len(rejected) == 1
    assert code is None or rejected == [code]
    assert bench.good().objects
    assert len(bench.objects.messages) == 2
    assert bench.ledger.received == 3


def test_a_bare_table_is_an_arrangement_without_objects(bench):
    assert bench.see(message(scene(blocks=()), bench.next_stamp())) == (1, [])
    assert len(bench.objects.wait(1).objects) == 0
    assert len(bench.good().objects) == 3


def test_the_same_cloud_twice_counts_once(bench):
    cloud = message(scene(), bench.next_stamp())
    assert bench.see(cloud) == (1, [])
    assert bench.see(cloud) == (0, ["STALE_INPUT"])
    bench.good()


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


def test_without_listeners_no_markers_and_no_labels_are_made(bench, monkeypatch):
    def never(*_):
        raise AssertionError("made for nobody")

    monkeypatch.setattr(perception_node, "encode_coloured", never)
    monkeypatch.setattr(perception_node, "arrangement_markers", never)
    bench.good()


def test_markers_and_labels_for_those_who_listen(bench):
    markers = Mailbox(bench.camera, MarkerArray, "perception/markers")
    labels = Mailbox(bench.camera, PointCloud2, "perception/labels")
    wait_until(lambda: bench.node.count_subscribers("perception/markers") > 0)
    wait_until(lambda: bench.node.count_subscribers("perception/labels") > 0)
    bench.good()
    shown = markers.wait().markers
    assert shown[0].action == Marker.DELETEALL
    assert sorted(one.text for one in shown if one.type == Marker.TEXT_VIEW_FACING) == ["0", "1", "2"]
    outline = next(one for one in shown if one.type == Marker.LINE_STRIP)
    assert outline.points[0] == outline.points[-1]
    assert outline.points[0].z == pytest.approx(HEIGHT, abs=0.001)
    coloured = labels.wait()
    assert (coloured.width, coloured.height) == (150, 150)
    assert coloured.header.frame_id == "camera"
    colours = np.frombuffer(coloured.data, "<u4").reshape(-1, 4)[:, 3]
    assert len(np.unique(colours)) == 4


def test_the_first_cloud_is_described_in_the_log_and_the_table_in_the_diagnostics(bench, monkeypatch):
    said, lines = Mailbox(bench.camera, DiagnosticArray, "/diagnostics"), []
    monkeypatch.setattr(bench.node.get_logger(), "info", lines.append)
    bench.see(message(scene(offset=0.004), bench.next_stamp()))
    bench.good()
    wait_until(lambda: len(lines) > 0)
    assert len(lines) == 1
    assert "150 x 150 points in frame 'camera'" in lines[0]
    assert "3 objects; object 0 at (" in lines[0]

    def tables():
        return [one for a in said.messages for one in a.status if one.name == "perception_node: table"]

    wait_until(tables)
    values = {pair.key: pair.value for pair in tables()[-1].values}
    assert abs(float(values["offset [mm]"])) < 0.5
    assert values["objects"] == "3"


def test_what_fails_after_publishing_is_not_a_second_outcome(bench, monkeypatch):
    monkeypatch.setattr(perception_node, "report_table", lambda *_: 1 / 0)
    bench.good()
    assert bench.ledger.pending == 0
    assert not bench.ledger.rejected


def test_diagnostics_tell_what_became_of_the_clouds(bench):
    said = Mailbox(bench.camera, DiagnosticArray, "/diagnostics")

    def status(name):
        found = [one for array in said.messages for one in array.status if one.name == f"perception_node: {name}"]
        return found[-1] if found else None

    bench.good()
    bench.see(PointCloud2(header=message(scene(), bench.next_stamp()).header))
    wait_until(lambda: status("clouds") and status("clouds").level == b"\x02")
    values = {pair.key: pair.value for pair in status("clouds").values}
    assert (values["received"], values["published"], values["rejected NO_POINTS"]) == ("2", "1", "1")
    assert float(values["segment [ms]"]) > 0.0
    assert "NO_POINTS (100)" in status("clouds").message
    assert {pair.key: pair.value for pair in status("input").values}["publishers"] == "1"
    bench.good()
    wait_until(lambda: status("clouds").level == b"\x00")
    bench.camera.destroy_publisher(bench.points)
    wait_until(lambda: "nobody publishes" in status("input").message)


def test_a_camera_whose_clouds_do_not_get_through_is_noticed(ros_context):
    """A process without the transport profile sends clouds of 38 MB to a node in another process."""
    bench = Bench(ros_context)
    said = Mailbox(bench.camera, DiagnosticArray, "/diagnostics")
    program = """
import sys, time, rclpy
from sensor_msgs.msg import PointCloud2
rclpy.init()
points = rclpy.create_node("other").create_publisher(PointCloud2, "points", 1)
while points.get_subscription_count() == 0:
    time.sleep(0.01)
for _ in range(1000):
    points.publish(PointCloud2(data=bytes(38_000_000)))
    time.sleep(0.2)
"""
    with spinning(bench.node, bench.camera):
        bench.start()
        environment = {**os.environ, "ROS_DOMAIN_ID": str(ros_context.get_domain_id())}
        environment.pop(PROFILE_VARIABLE, None)
        other = subprocess.Popen([sys.executable, "-c", program], env=environment)
        try:
            wait_until(
                lambda: any("are lost on their way" in one.message for a in said.messages for one in a.status), 60
            )
        finally:
            other.kill()
            other.wait(timeout=10)
        assert bench.ledger.lost > 0
        bench.good()


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


integers = st.one_of(st.integers(0, 200), st.integers(0, 2**32 - 1))
any_cloud = st.builds(
    PointCloud2,
    height=integers,
    width=integers,
    point_step=integers,
    row_step=integers,
    is_bigendian=st.booleans(),
    is_dense=st.booleans(),
    data=st.binary(max_size=600).map(lambda data: __import__("array").array("B", data)),
    fields=st.lists(
        st.builds(
            PointField,
            name=st.sampled_from(["x", "y", "z", "intensity"]),
            offset=integers,
            datatype=st.integers(0, 255),
            count=integers,
        ),
        max_size=5,
    ),
)


@settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(cloud=any_cloud)
def test_any_message_has_exactly_one_outcome(bench, cloud):
    cloud.header.stamp = message(scene(blocks=()), bench.next_stamp()).header.stamp
    before = bench.ledger
    bench.node.ledger.received(time.monotonic())
    bench.node._process(cloud)
    after = bench.ledger
    assert after.pending == 0
    assert after.received == before.received + 1
    assert after.rejected.get("INTERNAL", 0) == 0
