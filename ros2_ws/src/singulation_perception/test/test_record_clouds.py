import os
import signal
import subprocess
import sys

import numpy as np
import pytest
import rclpy
from rclpy.context import Context
from rclpy.qos import DurabilityPolicy, QoSProfile
from ros2_ws.src.singulation_perception.test.table_scene import message, scene
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import String

from singulation_node.testing import reserved_domain, spinning, wait_until
from singulation_perception.bag_reading import bag_topics, read_bag_clouds
from singulation_perception.decoding import decode_points

_START = 120  # s; a process starts on a machine that is busy with other tests


@pytest.fixture
def bench():
    """A camera node, and what starts record_clouds as a process in the same domain."""
    running = []
    context = Context()
    with reserved_domain() as domain:
        rclpy.init(context=context, domain_id=domain)
        camera = rclpy.create_node("camera", context=context)

        def record(*words):
            command = [sys.executable, "-m", "singulation_perception.record_clouds", *map(str, words)]
            environment = {**os.environ, "ROS_DOMAIN_ID": str(domain)}
            pipe = subprocess.PIPE
            running.append(subprocess.Popen(command, env=environment, stdout=pipe, stderr=pipe, text=True))
            return running[-1]

        with spinning(camera):
            yield camera, record
        context.try_shutdown()
        for process in running:
            process.kill()
            process.wait(timeout=10)


def ended(process):
    output, errors = process.communicate(timeout=_START)
    assert "Traceback" not in errors
    return process.returncode, output, errors


def wait_for_recorder(process, *publishers):
    """Until the recorder has subscribed to all of them; fails at once if it ends instead."""
    wait_until(lambda: process.poll() is not None or all(one.get_subscription_count() for one in publishers), _START)
    assert process.poll() is None, ended(process)


def delivered(*publishers):
    """Everything published so far has reached the recorder's process."""
    assert all(one.wait_for_all_acked(rclpy.duration.Duration(seconds=60)) for one in publishers)


def test_clouds_are_recorded_as_they_were_published(bench, tmp_path):
    camera, record = bench
    points = camera.create_publisher(PointCloud2, "points", QoSProfile(depth=5))
    process = record(tmp_path / "bag", "--count", 3)
    wait_for_recorder(process, points)
    cloud = scene()
    for number in range(3):
        points.publish(message(cloud, (number + 1) * 10**9))
    code, output, errors = ended(process)
    assert (code, output) == (0, f"3 messages recorded in {tmp_path / 'bag'}\n"), errors
    recorded = list(read_bag_clouds(tmp_path / "bag"))
    assert [one.stamp for one in recorded] == [10**9, 2 * 10**9, 3 * 10**9]
    np.testing.assert_array_equal(decode_points(recorded[0].data, recorded[0].layout), cloud)


def test_ctrl_c_leaves_a_complete_bag_of_all_topics(bench, tmp_path):
    camera, record = bench
    latched = camera.create_publisher(String, "name", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    latched.publish(String(data="said before anybody listened"))
    points = camera.create_publisher(PointCloud2, "points", QoSProfile(depth=5))
    process = record(tmp_path / "bag", "--topics", "name", "points")
    wait_for_recorder(process, points, latched)
    points.publish(message(scene(), 10**9))
    delivered(points, latched)
    process.send_signal(signal.SIGINT)
    assert ended(process)[0] == 0
    assert [topic.count for topic in bag_topics(tmp_path / "bag")] == [1, 1]


def test_a_topic_that_nobody_publishes_and_a_folder_that_exists(bench, tmp_path):
    _, record = bench
    code, _, errors = ended(record(tmp_path / "bag", "--wait", 0.3))
    assert code == 3
    assert "nobody publishes /points" in errors
    code, _, errors = ended(record(tmp_path))
    assert code == 1
    assert "exists already" in errors
    code, _, errors = ended(record(tmp_path / "other", "--count", -1))
    assert code == 2
    assert "must not be negative" in errors
