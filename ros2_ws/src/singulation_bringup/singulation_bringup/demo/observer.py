"""The demo's own ears: hears what the nodes say, records it, asks them for services and actions."""

import time
from collections.abc import Callable
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.context import Context

from singulation_bringup.asking_node import AskingNode, accepted
from singulation_node.qos import SENSOR_IN, STATE


class Observer(AskingNode):
    """A node of the demo process in a domain of its own; for use in a ``with`` block.

    Args:
        domain: ROS domain id.
        check: called while waiting; raises when waiting is in vain.
    """

    def __init__(self, domain: int, check: Callable[[], None]) -> None:
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain)
        super().__init__("demo", self._context, threads=3)
        self._check = check
        self._statuses: dict[str, dict[str, str]] = {}
        self.hear(DiagnosticArray, "/diagnostics", self._on_diagnostics)

    def __exit__(self, *_: object) -> None:
        super().__exit__()
        self._context.try_shutdown()

    def pause(self, seconds: float) -> None:
        """Let time pass.

        Raises:
            SingulationError: what ``check`` raises.
        """
        self._check()
        time.sleep(seconds)

    def hear(self, kind: Any, topic: str, callback: Callable[[Any], None], qos: Any = STATE) -> None:
        """Call back for every message of a topic; what the callback throws is logged."""
        super().hear(kind, topic, callback, qos)

    def hear_cloud(self, kind: Any, topic: str, callback: Callable[[Any], None]) -> None:
        """As ``hear``, for clouds."""
        self.hear(kind, topic, callback, SENSOR_IN)

    def status(self, name: str) -> dict[str, str]:
        """Latest diagnostics of ``node: component`` as key and value, with ``message``; empty before the first."""
        return self._statuses.get(name, {})

    def action(self, kind: Any, name: str, goal: Any, timeout: float) -> Callable[[], Any]:
        """Send a goal; returns a function that gives the result, or None while it runs.

        Raises:
            SingulationError: ``TIMEOUT`` if there is no server, ``REJECTED`` if it does not want the goal.
        """
        sent = self.send_goal(kind, name, goal, ready=timeout)
        self.wait(sent.done, timeout, f"answer of {name}")
        future = accepted(sent, name).get_result_async()
        return lambda: future.result().result if future.done() else None

    def _on_diagnostics(self, message: Any) -> None:
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            self._statuses[status.name] = {**values, "message": status.message}
