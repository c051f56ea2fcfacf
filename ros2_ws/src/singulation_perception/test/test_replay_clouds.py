import os
import pty
import signal
import subprocess
import sys
import termios
import threading
from contextlib import contextmanager

import numpy as np
import pytest
import rclpy
from ros2_ws.src.singulation_perception.test.bag_making import cloud_bag, text, write_bag
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_node.testing import Mailbox, call, reserved_domain, spinning, wait_until
from singulation_perception.cloud_messages import points_from_msg
from singulation_perception.playback import find_recording
from singulation_perception.replay_arguments import parse_replay
from singulation_perception.replay_clouds import ReplayNode

SECOND = 10**9


def nanoseconds(stamp):
    return stamp.sec * SECOND + stamp.nanosec


class Bench:
    """A replay node, somebody who listens, and a thread that plays."""

    def __init__(self, context, bag, *words):
        self.stop = threading.Event()
        options = parse_replay([str(bag), *words])
        self.recording = find_recording(options.paths, options.topic, options.period)
        self.node = ReplayNode(options, self.stop, context=context)
        self.listener = rclpy.create_node("listener", context=context)
        self.points = Mailbox(self.listener, PointCloud2, "points")
        self.errors = []

    def _play(self):
        try:
            self.node.wait_for_subscriber()
            self.node.play(self.recording)
        except SingulationError as error:
            self.errors.append(error)

    @contextmanager
    def playing(self):
        with spinning(self.node, self.listener):
            thread = threading.Thread(target=self._play)
            thread.start()
            try:
                yield self
            finally:
                self.stop.set()
                thread.join(timeout=20)
                assert not thread.is_alive()


def test_every_cloud_arrives_once_and_in_order(ros_context, tmp_path):
    bag, points = cloud_bag(tmp_path / "bag", count=5)
    with Bench(ros_context, bag, "--rate", "20").playing() as bench:
        bench.points.wait(5)
    assert len(bench.points.messages) == 5
    np.testing.assert_array_equal([points_from_msg(one) for one in bench.points.messages], points)
    assert {one.header.frame_id for one in bench.points.messages} == {"phoxi_camera_sensor"}
    stamps = [nanoseconds(one.header.stamp) for one in bench.points.messages]
    assert stamps == sorted(stamps)
    assert stamps[0] > 1_600_000_000 * SECOND
    assert not bench.errors


def test_original_stamps_and_another_frame(ros_context, tmp_path):
    bag, _ = cloud_bag(tmp_path / "bag", storage="sqlite3")
    with Bench(ros_context, bag, "--rate", "20", "--stamps", "original", "--frame", "lens").playing() as bench:
        bench.points.wait(3)
    assert [nanoseconds(one.header.stamp) for one in bench.points.messages] == [
        number * SECOND - SECOND // 50 for number in (100, 101, 102)
    ]
    assert bench.points.messages[0].header.frame_id == "lens"


def test_the_rhythm_of_the_recording_is_kept(ros_context, tmp_path):
    bag, _ = cloud_bag(tmp_path / "bag", count=4)
    with Bench(ros_context, bag, "--rate", "5").playing() as bench:
        bench.points.wait(4)
    stamps = np.array([nanoseconds(one.header.stamp) for one in bench.points.messages]) / SECOND
    assert stamps[-1] - stamps[0] > 0.55  # three seconds at five times the speed


def test_a_loop_goes_on_until_it_is_stopped(ros_context, tmp_path):
    bag, points = cloud_bag(tmp_path / "bag", count=2)
    with Bench(ros_context, bag, "--rate", "50", "--loop").playing() as bench:
        bench.points.wait(5)
    np.testing.assert_array_equal(points_from_msg(bench.points.messages[4]), points[0])


def test_one_cloud_for_each_call(ros_context, tmp_path):
    bag, _ = cloud_bag(tmp_path / "bag")
    with Bench(ros_context, bag, "--step").playing() as bench:
        for count in (1, 2, 3):
            answer = call(bench.listener, Trigger, "replay_clouds/step", Trigger.Request())
            assert answer.success
            assert answer.message == f"cloud {count} is on its way"
            bench.points.wait(count)
            assert len(bench.points.messages) == count


def test_a_key_sends_one_cloud_and_q_ends(tmp_path):
    bag, _ = cloud_bag(tmp_path / "bag")
    keyboard, terminal = pty.openpty()
    command = [sys.executable, "-m", "singulation_perception.replay_clouds", str(bag), "--step", "--wait", "0"]
    with reserved_domain() as domain:
        environment = {**os.environ, "ROS_DOMAIN_ID": str(domain)}
        process = subprocess.Popen(command, env=environment, stdin=terminal, stderr=subprocess.PIPE, text=True)
        try:
            wait_until(lambda: "press a key (q ends)" in process.stderr.readline())
            for number in (1, 2):
                os.write(keyboard, b" ")
                assert f"cloud {number} of 3" in process.stderr.readline()
            os.write(keyboard, b"q")
            errors = process.communicate(timeout=60)[1]
            assert termios.tcgetattr(terminal)[3] & termios.ICANON, "the terminal was not put back"
        finally:
            process.kill()
            process.wait(timeout=10)
            os.close(terminal)
            os.close(keyboard)
    assert (process.returncode, errors) == (0, "")


def test_the_clock_shows_the_time_of_the_recording(ros_context, tmp_path):
    bag, _ = cloud_bag(tmp_path / "bag")
    bench = Bench(ros_context, bag, "--rate", "10", "--clock")
    clock = Mailbox(bench.listener, Clock, "/clock")
    with bench.playing():
        bench.points.wait(3)
        clock.wait(3)
    times = [nanoseconds(one.clock) for one in clock.messages]
    assert times == sorted(times)
    assert 100 * SECOND <= times[0] < 110 * SECOND
    assert nanoseconds(bench.points.messages[2].header.stamp) == 102 * SECOND


def test_files_have_no_stamp_of_their_own(ros_context, tmp_path):
    path = tmp_path / "cloud.ply"
    path.write_text(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "end_header\n0 0 1\n"
    )
    with Bench(ros_context, path, "--stamps", "original").playing() as bench:
        wait_until(lambda: bench.errors)
    assert isinstance(bench.errors[0], InvalidInputError)
    assert "--stamps now" in bench.errors[0].message


def test_what_lies_before_the_damage_is_published(ros_context, tmp_path):
    bag, _ = cloud_bag(tmp_path / "bag", count=4, shape=(300, 400))
    storage = bag / "bag.mcap"
    content = bytearray(storage.read_bytes())
    content[len(content) // 2 : len(content) // 2 + 2_000_000] = b"\xff" * len(content[len(content) // 2 :][:2_000_000])
    summary = storage.read_bytes()[-3000:]
    content[-3000:] = summary
    storage.write_bytes(content)
    with Bench(ros_context, bag, "--rate", "20").playing() as bench:
        wait_until(lambda: bench.errors)
    assert bench.errors[0].code == ResultCode.BAD_FILE
    assert "damaged after" in bench.errors[0].message
    assert 1 <= len(bench.points.messages) < 4


def test_without_a_subscriber_nothing_is_played(ros_context, tmp_path):
    bag, _ = cloud_bag(tmp_path / "bag")
    node = ReplayNode(parse_replay([str(bag), "--wait", "0.3"]), threading.Event(), context=ros_context)
    with spinning(node), pytest.raises(SingulationError, match="nobody subscribed to /points") as caught:
        node.wait_for_subscriber()
    assert caught.value.code == ResultCode.TIMEOUT


@pytest.fixture
def replay():
    """Starts replay_clouds as a process in a domain of its own."""
    running = []
    with reserved_domain() as domain:

        def start(*words):
            command = [sys.executable, "-m", "singulation_perception.replay_clouds", *map(str, words)]
            environment = {**os.environ, "ROS_DOMAIN_ID": str(domain)}
            running.append(subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True))
            return running[-1]

        yield start
        for process in running:
            process.kill()
            process.wait(timeout=10)


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["none"], 1, "no such file or folder"),
        (["chatter"], 1, "/chatter (std_msgs/msg/String, 1 messages)"),
        (["broken.pcd"], 1, "no DATA line"),
        (["bag", "--rate", "0"], 2, "above 0"),
        (["bag", "--wait", "0.2"], 3, "nobody subscribed to /points within"),
    ],
)
def test_exit_codes_and_one_clear_line(replay, tmp_path, words, code, said):
    cloud_bag(tmp_path / "bag")
    write_bag(tmp_path / "chatter", [("/chatter", text(), 1)])
    (tmp_path / "broken.pcd").write_text("broken")
    wait = [] if "--wait" in words else ["--wait", "0"]
    process = replay(tmp_path / words[0], *words[1:], *wait)
    errors = process.communicate(timeout=60)[1]
    assert process.returncode == code, errors
    assert said in errors
    assert "Traceback" not in errors


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_cleanly(replay, tmp_path, number):
    bag, _ = cloud_bag(tmp_path / "bag")
    process = replay(bag, "--loop", "--wait", "0")
    wait_until(lambda: "cloud 1 of 3" in process.stderr.readline())
    process.send_signal(number)
    errors = process.communicate(timeout=60)[1]
    assert process.returncode == 0
    assert "Traceback" not in errors
