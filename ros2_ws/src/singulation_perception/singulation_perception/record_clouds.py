"""Records clouds (and any other topics) into a rosbag2, on machines with or without ``ros2 bag``.

Ends after ``--count`` messages, after ``--seconds``, or by Ctrl-C; the bag is complete in every case.
"""

import argparse
import importlib
import signal
import sys
import threading
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from singulation_node.large_messages import prepare_for_large_messages  # before ROS: keeps memory

# isort: split
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.signals import SignalHandlerOptions

from singulation_core import ResultCode, SingulationError
from singulation_node.guard import guarded
from singulation_node.main import plain_arguments
from singulation_perception.bag_writing import BagRecorder

EXIT_FAILED, EXIT_NOTHING_TO_RECORD = 1, 3
_POLL = 0.05  # s
_DEPTH = 5  # clouds that may wait for the disk
_EMPTY_LOOKS = 6  # after which nothing is waiting any more


class RecordNode(Node):
    """Subscribes to topics once somebody publishes them and hands their messages to a recorder."""

    def __init__(self, recorder: BagRecorder, **options: Any) -> None:
        super().__init__("record_clouds", **options)
        self._recorder = recorder
        self.failure: SingulationError | None = None

    def subscribe(self, topics: Sequence[str], wait: float, stop: threading.Event) -> None:
        """Begin to record.

        Raises:
            SingulationError: ``TIMEOUT`` naming the topic that nobody publishes within ``wait`` [s].
        """
        deadline = time.monotonic() + wait
        for topic in topics:
            name = self.resolve_topic_name(topic)
            while not (published := self.get_publishers_info_by_topic(name)) and not stop.wait(_POLL):
                if time.monotonic() > deadline:
                    raise SingulationError(ResultCode.TIMEOUT, f"nobody publishes {name} within {wait:.0f} s")
            if published:
                kind = _message_class(published[0].topic_type)
                self.create_subscription(kind, topic, partial(self._record, name), _matching(published))

    @guarded
    def _record(self, topic: str, message: Any) -> None:
        try:
            self._recorder.write(topic, message, self.get_clock().now().nanoseconds)
        except SingulationError as error:
            self.failure = error


def _message_class(name: str) -> Any:
    package, kind, short = name.split("/")
    return getattr(importlib.import_module(f"{package}.{kind}"), short)


def _matching(publishers: Sequence[Any]) -> QoSProfile:
    """The strictest quality of service that all of them offer: nothing is lost that need not be."""
    offered = [one.qos_profile for one in publishers]
    reliable = all(one.reliability == ReliabilityPolicy.RELIABLE for one in offered)
    kept = all(one.durability == DurabilityPolicy.TRANSIENT_LOCAL for one in offered)
    return QoSProfile(
        depth=_DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if kept else DurabilityPolicy.VOLATILE,
    )


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="record_clouds",
        description="Records topics into a rosbag2 (mcap).",
        epilog="Exit codes: 0 recorded; 1 the folder exists or cannot be written; 2 wrong arguments; "
        "3 a topic is not published.",
    )
    add = parser.add_argument
    add("out", type=Path, help="folder of the bag; must not exist yet")
    add("--topics", nargs="+", default=["points"], metavar="TOPIC", help="what to record (default: points)")
    add("--count", type=int, default=0, metavar="N", help="end after so many messages (default: no limit)")
    add("--seconds", type=float, default=0.0, metavar="S", help="end after this time (default: no limit)")
    add("--wait", type=float, default=30.0, metavar="S", help="longest wait for the topics (default 30)")
    options = parser.parse_args(list(arguments))
    if not (options.count >= 0 and options.seconds >= 0.0 and options.wait >= 0.0):
        parser.error("--count, --seconds and --wait must not be negative")
    return options


def _run(node: RecordNode, options: argparse.Namespace, recorder: BagRecorder, stop: threading.Event) -> None:
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    try:
        node.subscribe(options.topics, options.wait, stop)
        ends = time.monotonic() + options.seconds if options.seconds > 0.0 else float("inf")
        count = options.count if options.count > 0 else float("inf")
        while not (stop.is_set() or recorder.count >= count or time.monotonic() > ends or node.failure):
            executor.spin_once(timeout_sec=_POLL)
        if recorder.count < count:
            _take_the_rest(executor, recorder)
    finally:
        executor.shutdown(timeout_sec=2.0)
        node.destroy_node()
    if node.failure is not None:
        raise node.failure


def _take_the_rest(executor: SingleThreadedExecutor, recorder: BagRecorder) -> None:
    """What has arrived but was not looked at yet, when the end came by a signal or by time.

    One empty look proves nothing: the executor may have been busy with an event of the middleware.
    """
    empty, before = 0, recorder.count
    while empty < _EMPTY_LOOKS:
        executor.spin_once(timeout_sec=_POLL)
        empty = empty + 1 if recorder.count == before else 0
        before = recorder.count


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    arguments = list(sys.argv if args is None else args)
    options = _options(plain_arguments(arguments))
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    prepare_for_large_messages()
    rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
    try:
        with BagRecorder(options.out) as recorder:
            _run(RecordNode(recorder), options, recorder, stop)
        print(f"{recorder.count} messages recorded in {options.out}")
    except SingulationError as error:
        print(f"error: {error}", file=sys.stderr)
        return EXIT_NOTHING_TO_RECORD if error.code == ResultCode.TIMEOUT else EXIT_FAILED
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
