"""Publishes recorded clouds on ``points``: a rosbag2 (sqlite3 or mcap), or PCD and PLY files.

One cloud is in memory at a time, however large the bag.
"""

import signal
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import Any

from singulation_node.large_messages import prepare_for_large_messages  # before ROS: keeps memory

# isort: split
import rclpy
from builtin_interfaces.msg import Time
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header
from std_srvs.srv import Trigger

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_node.guard import guarded, guarded_service, report_failure
from singulation_node.main import plain_arguments
from singulation_node.spinning import spin_until
from singulation_perception.cloud_messages import cloud_message
from singulation_perception.clouds import RecordedCloud
from singulation_perception.playback import Recording, Rhythm, find_recording
from singulation_perception.replay_arguments import ORIGINAL, ReplayOptions, parse_replay
from singulation_perception.step_keys import StepKeys

EXIT_FAILED, EXIT_NO_SUBSCRIBER = 1, 3
_FILE_FRAME = "phoxi_camera_sensor"
_CLOCK_PERIOD = 0.02  # s
_POLL = 0.05  # s; keys and subscribers are looked for this often
_LAST_ACKNOWLEDGED = 5.0  # s
_SETTLE = 0.3  # s; we know the subscriber a little before it knows us
_OFFERED = QoSProfile(depth=2, reliability=ReliabilityPolicy.RELIABLE)  # matches every subscriber


class ReplayNode(Node):
    """Publisher, clock and step service; the pace is set from outside."""

    def __init__(self, options: ReplayOptions, stop: threading.Event, **node_options: Any) -> None:
        super().__init__("replay_clouds", **node_options)
        self._options = options
        self._stop = stop
        self._rhythm = Rhythm(options.rate, options.step)
        self._points = self.create_publisher(PointCloud2, "points", _OFFERED)
        self._published = 0
        self._steps = threading.Semaphore(0)
        if options.step:
            self.create_service(Trigger, "~/step", self._step)
        if options.clock:
            self._clock_time = self.create_publisher(Clock, "/clock", 10)
            self.create_timer(_CLOCK_PERIOD, self._tick)

    def wait_for_subscriber(self) -> None:
        """Until somebody would receive the first cloud.

        Raises:
            SingulationError: ``TIMEOUT`` after ``options.wait``.
        """
        limit = self._options.wait
        deadline = time.monotonic() + limit
        while limit > 0.0 and not self._stop.is_set():
            if self._points.get_subscription_count() > 0:
                self._stop.wait(_SETTLE)
                return
            if time.monotonic() > deadline:
                raise SingulationError(
                    ResultCode.TIMEOUT, f"nobody subscribed to {self._points.topic_name} within {limit:.0f} s"
                )
            self._stop.wait(_POLL)

    def play(self, recording: Recording) -> None:
        """Publish the recording, once or until stopped.

        Raises:
            SingulationError: ``BAD_FILE`` where it turns out to be damaged.
        """
        with StepKeys(self._options.step) as keys:
            if self._options.step:
                how = "press a key (q ends) or call" if keys.available else "call"
                self._say(f"one cloud at a time: {how} {self.get_fully_qualified_name()}/step")
            while not self._stop.is_set():
                self._rhythm.restart()
                for number, cloud in enumerate(recording.open(), start=1):
                    self._await_turn(cloud, keys)
                    if self._stop.is_set():
                        break
                    self._publish(cloud)
                    self._say(f"cloud {number} of {recording.count}: {cloud.source}")
                if not self._options.loop:
                    self._finish()
                    return

    def _finish(self) -> None:
        """Leave the last cloud the time to arrive: what is under way is lost with its publisher."""
        self._points.wait_for_all_acked(Duration(seconds=_LAST_ACKNOWLEDGED))
        self._stop.wait(_SETTLE)

    def _await_turn(self, cloud: RecordedCloud, keys: StepKeys) -> None:
        if self._options.step:
            while not self._stop.is_set() and not self._steps.acquire(timeout=_POLL):
                key = keys.pressed()
                if key in ("q", "Q"):
                    self._stop.set()
                elif key:
                    break
            self._rhythm.restart()
        now = time.monotonic()
        self._stop.wait(max(0.0, self._rhythm.due(cloud.recorded, now) - now))

    def _publish(self, cloud: RecordedCloud) -> None:
        header = Header(stamp=self._stamp(cloud), frame_id=self._options.frame or cloud.frame or _FILE_FRAME)
        self._points.publish(cloud_message(cloud.data, cloud.layout, header))
        self._published += 1

    def _stamp(self, cloud: RecordedCloud) -> Time:
        if self._options.stamps == ORIGINAL:
            if cloud.stamp == 0:
                raise InvalidInputError(f"{cloud.source} has no stamp of its own; use --stamps now")
            return _time(cloud.stamp)
        return _time(cloud.recorded) if self._options.clock else self.get_clock().now().to_msg()

    @guarded
    def _tick(self) -> None:
        position = self._rhythm.recorded_at(time.monotonic())
        if position is not None:
            self._clock_time.publish(Clock(clock=_time(position)))

    @guarded_service
    def _step(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._steps.release()
        response.success = True
        response.message = f"cloud {self._published + 1} is on its way"
        return response

    def _say(self, text: str) -> None:
        self.get_logger().info(text)


def _time(nanoseconds: int) -> Time:
    return Time(sec=nanoseconds // 1_000_000_000, nanosec=nanoseconds % 1_000_000_000)


@contextmanager
def _spinning(node: Node) -> Iterator[None]:
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    done = threading.Event()
    failed = partial(report_failure, node, "executor")
    thread = threading.Thread(target=spin_until, args=(executor, done, failed), name="executor", daemon=True)
    thread.start()
    try:
        yield
    finally:
        done.set()
        executor.wake()
        thread.join(timeout=5.0)
        executor.shutdown(timeout_sec=1.0)


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    arguments = list(sys.argv if args is None else args)
    options = parse_replay(plain_arguments(arguments))
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    try:
        recording = find_recording(options.paths, options.topic, options.period)
        prepare_for_large_messages()
        rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
        node = ReplayNode(options, stop)
        with _spinning(node):
            node.wait_for_subscriber()
            node.play(recording)
        node.destroy_node()
    except SingulationError as error:
        print(f"error: {error}", file=sys.stderr)
        return EXIT_NO_SUBSCRIBER if error.code == ResultCode.TIMEOUT else EXIT_FAILED
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
