"""What perception_node says beside the objects: markers, labels, diagnostics, log."""

import os
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray
from ros2_ws.src.singulation_perception.test.node_bench import Bench
from ros2_ws.src.singulation_perception.test.table_scene import HEIGHT, message, scene
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import Marker, MarkerArray

from singulation_node.large_messages import PROFILE_VARIABLE
from singulation_node.testing import Mailbox, spinning, wait_until
from singulation_perception import perception_node

_OTHER_PROCESS = 200  # s; another process starts, on a machine that is busy with other tests


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


def said_lost(said):
    return any("are lost on their way" in one.message for array in said.messages for one in array.status)


def test_the_middleware_says_that_clouds_were_lost(bench):
    said = Mailbox(bench.camera, DiagnosticArray, "/diagnostics")

    def warned():
        bench.node._note_loss(SimpleNamespace(total_count=3))
        return said_lost(said)

    wait_until(warned)
    assert bench.ledger.lost == 3
    bench.good()


def test_a_camera_whose_clouds_do_not_get_through_is_noticed(ros_context):
    """A process without the transport profile sends clouds of 38 MB to a node in another process."""
    bench = Bench(ros_context)
    said = Mailbox(bench.camera, DiagnosticArray, "/diagnostics")
    program = """
import time
from array import array
import rclpy
from sensor_msgs.msg import PointCloud2
rclpy.init()
points = rclpy.create_node("other").create_publisher(PointCloud2, "points", 1)
cloud = PointCloud2(data=array("B", bytes(38_000_000)))
while points.get_subscription_count() == 0:
    time.sleep(0.01)
while True:
    points.publish(cloud)
    time.sleep(0.05)
"""
    with spinning(bench.node, bench.camera):
        bench.start()
        environment = {**os.environ, "ROS_DOMAIN_ID": str(ros_context.get_domain_id())}
        environment.pop(PROFILE_VARIABLE, None)
        other = subprocess.Popen([sys.executable, "-c", program], env=environment)
        try:
            wait_until(lambda: other.poll() is not None or bench.ledger.lost > 0, _OTHER_PROCESS, "a lost cloud")
            wait_until(lambda: other.poll() is not None or said_lost(said), what="the warning")
            assert other.poll() is None, "the other process has ended by itself"
        finally:
            other.kill()
            other.wait(timeout=10)
        bench.good()
