"""A node that hears and asks other nodes: its callbacks run in the background while its program waits."""

import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import partial
from typing import Any, Self, TypeVar

import rclpy
from rclpy.context import Context
from rclpy.executors import MultiThreadedExecutor

from singulation_core import ResultCode, SingulationError
from singulation_node.action_client import PatientActionClient
from singulation_node.guard import report_failure
from singulation_node.spinning import spin_until

Value = TypeVar("Value")

POLL = 0.02  # s between two looks at what is waited for


class AskingNode(ABC):
    """For use in a ``with`` block; what waiting may be ended by is up to the program.

    Args:
        name: of the node.
        context: initialised.
        threads: for callbacks.
        options: of ``rclpy.create_node``.
    """

    def __init__(self, name: str, context: Context, threads: int, **options: Any) -> None:
        self.node = rclpy.create_node(name, context=context, **options)
        self._executor = MultiThreadedExecutor(num_threads=threads, context=context)
        self._executor.add_node(self.node)
        self._clients: dict[str, Any] = {}
        self._stop = threading.Event()
        self._thread = threading.Thread(
            target=spin_until,
            args=(self._executor, self._stop, partial(report_failure, self.node, "executor")),
            name="executor",
            daemon=True,
        )

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._executor.wake()
        self._thread.join(timeout=5.0)
        self._executor.shutdown(timeout_sec=2.0)
        self.node.destroy_node()

    @abstractmethod
    def pause(self, seconds: float) -> None:
        """Let time pass.

        Raises:
            SingulationError: waiting is in vain.
        """

    def wait(self, condition: Callable[[], Value | None], timeout: float, what: str) -> Value:
        """The first true value of the condition.

        Raises:
            SingulationError: ``TIMEOUT`` saying what did not come, or why waiting is in vain.
        """
        deadline = time.monotonic() + timeout
        while not (value := condition()):
            if time.monotonic() > deadline:
                raise SingulationError(ResultCode.TIMEOUT, f"{what}: nothing within {timeout:g} s")
            self.pause(POLL)
        return value

    def hear(self, kind: Any, topic: str, callback: Callable[[Any], None], qos: Any) -> None:
        """Call back for every message of a topic; what the callback throws is logged."""

        def safe(message: Any) -> None:
            try:
                callback(message)
            except Exception as error:  # a message of a stranger must not end the program
                self.node.get_logger().warning(f"{topic}: {type(error).__name__}: {error}", throttle_duration_sec=5.0)

        self.node.create_subscription(kind, topic, safe, qos)

    def call(self, kind: Any, name: str, request: Any, *, ready: float, answer: float) -> Any:
        """Answer of a service.

        Args:
            kind: service type.
            name: of the service.
            request: to send.
            ready: longest wait for the service [s].
            answer: longest wait for its answer [s].

        Raises:
            SingulationError: as ``wait``.
        """
        if name not in self._clients:
            self._clients[name] = self.node.create_client(kind, name)
        client = self._clients[name]
        self.wait(client.service_is_ready, ready, f"service {client.srv_name}")
        future = client.call_async(request)
        self.wait(future.done, answer, f"answer of {client.srv_name}")
        return future.result()

    def send_goal(
        self, kind: Any, name: str, goal: Any, *, ready: float, feedback: Callable[[Any], None] | None = None
    ) -> Any:
        """Future of the handle of a goal.

        Args:
            kind: action type.
            name: of the action.
            goal: to send.
            ready: longest wait for the action [s].
            feedback: told what comes while the goal runs.

        Raises:
            SingulationError: as ``wait``.
        """
        client = PatientActionClient(self.node, kind, name)
        self.wait(client.server_is_ready, ready, f"action {name}")
        told = None if feedback is None else lambda message: feedback(message.feedback)
        return client.send_goal_async(goal, feedback_callback=told)


def accepted(sent: Any, name: str) -> Any:
    """Handle of a goal that was answered.

    Raises:
        SingulationError: ``REJECTED``: the node that has the action does not want it.
    """
    handle = sent.result()
    if not handle.accepted:
        raise SingulationError(ResultCode.REJECTED, f"{name} rejected the goal; its log says why")
    return handle
