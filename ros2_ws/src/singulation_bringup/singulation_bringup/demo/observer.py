"""The demo's own ears: hears what the nodes say, records it, asks them for services and actions."""

import threading
import time
from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.context import Context
from rclpy.executors import MultiThreadedExecutor

from singulation_core import ResultCode, SingulationError
from singulation_node.action_client import PatientActionClient
from singulation_node.guard import guarded, report_failure
from singulation_node.qos import SENSOR_IN, STATE
from singulation_node.spinning import spin_until

Value = TypeVar("Value")

_POLL = 0.02  # s


class Observer:
    """A node of the demo process in a domain of its own; for use in a ``with`` block.

    Args:
        domain: ROS domain id.
        check: called while waiting; raises when waiting is in vain.
    """

    def __init__(self, domain: int, check: Callable[[], None]) -> None:
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain)
        self.node = rclpy.create_node("demo", context=self._context)
        self._check = check
        self._executor = MultiThreadedExecutor(num_threads=3, context=self._context)
        self._executor.add_node(self.node)
        self._stop = threading.Event()
        self._thread = threading.Thread(
            target=spin_until,
            args=(self._executor, self._stop, partial(report_failure, self.node, "executor")),
            daemon=True,
        )
        self._clients: dict[str, Any] = {}
        self._statuses: dict[str, dict[str, str]] = {}
        self.hear(DiagnosticArray, "/diagnostics", self._on_diagnostics, STATE)

    def __enter__(self) -> "Observer":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._executor.wake()
        self._thread.join(timeout=5.0)
        self._executor.shutdown(timeout_sec=2.0)
        self.node.destroy_node()
        self._context.try_shutdown()

    def hear(self, kind: Any, topic: str, callback: Callable[[Any], None], qos: Any = STATE) -> None:
        """Call back for every message of a topic."""

        @guarded
        def safe(node: Any, message: Any) -> None:
            callback(message)

        self.node.create_subscription(kind, topic, lambda message: safe(self.node, message), qos)

    def hear_cloud(self, kind: Any, topic: str, callback: Callable[[Any], None]) -> None:
        """As ``hear``, for clouds."""
        self.hear(kind, topic, callback, SENSOR_IN)

    def status(self, name: str) -> dict[str, str]:
        """Latest diagnostics of ``node: component`` as key and value, with ``message``; empty before the first."""
        return self._statuses.get(name, {})

    def wait(self, condition: Callable[[], Value | None], timeout: float, what: str) -> Value:
        """The first true value of the condition.

        Raises:
            SingulationError: ``TIMEOUT``, or what ``check`` raises.
        """
        deadline = time.monotonic() + timeout
        while not (value := condition()):
            self._check()
            if time.monotonic() > deadline:
                raise SingulationError(ResultCode.TIMEOUT, f"{what}: nothing within {timeout:.0f} s")
            time.sleep(_POLL)
        return value

    def call(self, kind: Any, name: str, request: Any, timeout: float = 60.0) -> Any:
        """Answer of a service.

        Raises:
            SingulationError: ``TIMEOUT``.
        """
        if name not in self._clients:
            self._clients[name] = self.node.create_client(kind, name)
        client = self._clients[name]
        self.wait(client.service_is_ready, timeout, f"service {name}")
        future = client.call_async(request)
        self.wait(future.done, timeout, f"answer of {name}")
        return future.result()

    def action(
        self, kind: Any, name: str, goal: Any, on_feedback: Callable[[Any], None], timeout: float
    ) -> Callable[[], Any]:
        """Send a goal; returns a function that gives the result, or None while it runs.

        Raises:
            SingulationError: ``TIMEOUT`` if there is no server, ``REJECTED`` if it does not want the goal.
        """
        client = PatientActionClient(self.node, kind, name)
        self.wait(client.server_is_ready, timeout, f"action {name}")
        sent = client.send_goal_async(goal, feedback_callback=lambda message: on_feedback(message.feedback))
        self.wait(sent.done, timeout, f"answer of {name}")
        handle = sent.result()
        if not handle.accepted:
            raise SingulationError(ResultCode.REJECTED, f"{name} rejected the goal; its log says why")
        future = handle.get_result_async()
        return lambda: future.result().result if future.done() else None

    def _on_diagnostics(self, message: Any) -> None:
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            self._statuses[status.name] = {**values, "message": status.message}
