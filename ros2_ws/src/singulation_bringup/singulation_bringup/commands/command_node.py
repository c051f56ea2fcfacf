"""The ears of a command: a node that spins in the background while the command asks and waits."""

import signal
import threading
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, TypeVar

import rclpy
from rclpy.context import Context
from rclpy.executors import MultiThreadedExecutor
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import Trigger

from singulation_core import ResultCode, SingulationError
from singulation_node.guard import report_failure
from singulation_node.spinning import spin_until

Value = TypeVar("Value")

_POLL = 0.02  # s


class CommandNode:
    """For use in a ``with`` block.

    Args:
        name: of the node.
        arguments: command line with its ROS arguments; None if there are none.
        context: initialised by somebody else; None makes one and reacts to Ctrl-C.
    """

    def __init__(self, name: str, arguments: Sequence[str] | None = None, context: Context | None = None) -> None:
        self._owned = context is None
        self._context = context or Context()
        self._interrupted = threading.Event()
        if self._owned:
            rclpy.init(
                args=list(arguments or []), context=self._context, signal_handler_options=SignalHandlerOptions.NO
            )
            for number in (signal.SIGINT, signal.SIGTERM):
                signal.signal(number, lambda *_: self.interrupt())
        self.node = rclpy.create_node(name, context=self._context, start_parameter_services=False)
        self._executor = MultiThreadedExecutor(num_threads=2, context=self._context)
        self._executor.add_node(self.node)
        self._clients: dict[str, Any] = {}
        self._stop = threading.Event()
        self._thread = threading.Thread(
            target=spin_until,
            args=(self._executor, self._stop, partial(report_failure, self.node, "executor")),
            name="executor",
            daemon=True,
        )

    def __enter__(self) -> "CommandNode":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._executor.wake()
        self._thread.join(timeout=5.0)
        self._executor.shutdown(timeout_sec=2.0)
        self.node.destroy_node()
        if self._owned:
            self._context.try_shutdown()

    def hear(self, kind: Any, topic: str, callback: Callable[[Any], None], qos: Any) -> None:
        """Call back for every message of a topic; what the callback throws is logged."""

        def safe(message: Any) -> None:
            try:
                callback(message)
            except Exception as error:  # a message of a stranger must not end the command
                self.node.get_logger().warning(f"{topic}: {type(error).__name__}: {error}", throttle_duration_sec=5.0)

        self.node.create_subscription(kind, topic, safe, qos)

    def interrupt(self) -> None:
        """What Ctrl-C does: whoever waits stops waiting."""
        self._interrupted.set()

    def pause(self, seconds: float) -> None:
        """Let time pass.

        Raises:
            SingulationError: ``CANCELLED`` on Ctrl-C.
        """
        if self._interrupted.wait(seconds):
            raise SingulationError(ResultCode.CANCELLED, "interrupted")

    def wait(self, condition: Callable[[], Value | None], timeout: float, what: str) -> Value:
        """The first true value of the condition.

        Raises:
            SingulationError: ``TIMEOUT`` saying what did not come; ``CANCELLED`` on Ctrl-C.
        """
        deadline = time.monotonic() + timeout
        while not (value := condition()):
            if time.monotonic() > deadline:
                raise SingulationError(ResultCode.TIMEOUT, f"{what}: nothing within {timeout:g} s")
            self.pause(_POLL)
        return value

    def settle(self, condition: Callable[[], Value | None], timeout: float) -> bool:
        """Whether the condition comes true in time, whatever Ctrl-C says: for what has to end in order."""
        deadline = time.monotonic() + timeout
        while not condition():
            if time.monotonic() > deadline:
                return False
            self._stop.wait(_POLL)
        return True

    def call(self, kind: Any, name: str, request: Any, *, ready: float, answer: float) -> Any:
        """Answer of a service.

        Args:
            kind: service type.
            name: of the service.
            request: to send.
            ready: longest wait for the service [s].
            answer: longest wait for its answer [s].

        Raises:
            SingulationError: ``TIMEOUT`` or ``CANCELLED``.
        """
        if name not in self._clients:
            self._clients[name] = self.node.create_client(kind, name)
        client = self._clients[name]
        self.wait(client.service_is_ready, ready, f"service {client.srv_name}")
        future = client.call_async(request)
        self.wait(future.done, answer, f"answer of {client.srv_name}")
        return future.result()

    def trigger(self, name: str, *, ready: float, answer: float, refusal: ResultCode = ResultCode.REJECTED) -> str:
        """What a service of std_srvs/Trigger answers.

        Args:
            name: of the service.
            ready: longest wait for the service [s].
            answer: longest wait for its answer [s].
            refusal: code of the error if it says that it did not work.

        Raises:
            SingulationError: ``TIMEOUT``, ``CANCELLED`` or ``refusal``.
        """
        response = self.call(Trigger, name, Trigger.Request(), ready=ready, answer=answer)
        if not response.success:
            raise SingulationError(refusal, f"{name}: {response.message}")
        return str(response.message)
