"""The main function of every node: start, spin, end cleanly on SIGINT and SIGTERM."""

import signal
import sys
import threading
from collections.abc import Sequence
from functools import partial
from types import FrameType
from typing import Any, Protocol

import rclpy
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.signals import SignalHandlerOptions
from rclpy.utilities import remove_ros_args

from singulation_core import SingulationError
from singulation_node.guard import report_failure
from singulation_node.managed_node import ManagedNode
from singulation_node.spinning import spin_until

_SHUTDOWN = 15.0  # s that a node may take to stop what it is doing


class NodeFactory(Protocol):
    """What makes the node, once ROS is initialised: usually its class."""

    def __call__(self) -> Any: ...


def run_node(factory: NodeFactory, args: Sequence[str] | None = None, threads: int = 4) -> int:
    """Run one node until SIGINT or SIGTERM.

    ``--autostart`` on the command line (or the parameter ``autostart``) makes a lifecycle node configure and activate
    itself; otherwise it waits for its manager.

    Args:
        factory: makes the node.
        args: command line; None: that of the process.
        threads: for callbacks. With one of them they run in the thread that waits for them, which saves a node whose
            callbacks exclude each other anyway the way to another thread and the contention with it.

    Returns:
        Exit code: 0 after a signal, 1 if the node could not be made or started.
    """
    arguments = list(sys.argv if args is None else args)
    autostart = "--autostart" in arguments
    starting, stop = threading.Event(), threading.Event()
    rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
    try:
        executor = SingleThreadedExecutor() if threads == 1 else MultiThreadedExecutor(num_threads=threads)
        _stop_on_signals(starting, stop, executor)
        node = factory()
        try:
            executor.add_node(node)
            managed = isinstance(node, ManagedNode)
            if managed:
                node.own_process = True
            wanted = managed and (autostart or node.autostart)
            configured = not wanted or _configure(node, starting, stop)
            if not configured or (wanted and node.trigger_activate() != TransitionCallbackReturn.SUCCESS):
                return 1
            spin_until(executor, stop, partial(report_failure, node, "executor"))
            if managed and node.is_active:
                _shut_down_while_spinning(executor, node)
        finally:
            executor.remove_node(node)
            node.destroy_node()
            executor.shutdown(timeout_sec=2.0)
    except SingulationError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:  # a signal before the node was ready
        return 0
    finally:
        rclpy.try_shutdown()
    return 0


def plain_arguments(args: Sequence[str] | None = None) -> list[str]:
    """Command-line arguments without the program name, ROS arguments and ``--autostart``."""
    arguments = remove_ros_args(list(sys.argv if args is None else args))
    return [item for item in arguments[1:] if item != "--autostart"]


def _configure(node: Any, starting: threading.Event, stop: threading.Event) -> bool:
    """Configuring may take long (it compiles), so a signal interrupts it; everything else on the way is quick."""
    starting.set()
    try:
        if stop.is_set():
            raise KeyboardInterrupt
        return bool(node.trigger_configure() == TransitionCallbackReturn.SUCCESS)
    finally:
        starting.clear()


def _stop_on_signals(starting: threading.Event, stop: threading.Event, executor: Any) -> None:
    """Signals end the spinning; while the node is being configured, they end that at once."""

    def handle(number: int, frame: FrameType | None) -> None:
        stop.set()
        executor.wake()
        if starting.is_set():
            starting.clear()
            raise KeyboardInterrupt

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, handle)


def _shut_down_while_spinning(executor: Any, node: Any) -> None:
    """A node that stops a robot still needs its callbacks while it does so."""
    finished = threading.Event()

    def shut_down() -> None:
        try:
            node.trigger_shutdown()
        finally:
            finished.set()
            executor.wake()

    threading.Thread(target=shut_down, daemon=True).start()
    limit = threading.Timer(_SHUTDOWN, finished.set)
    limit.daemon = True
    limit.start()
    spin_until(executor, finished, partial(report_failure, node, "executor"))
    limit.cancel()
