"""An action client whose answers cannot come too early.

rclpy's client sends a request first and notes afterwards that it waits for the answer. Where another thread spins, the
answer can come in between: it is ignored, and a goal that was accepted runs while its sender waits for nothing.
"""

import threading
from typing import Any

from rclpy.action import ActionClient


class PatientActionClient(ActionClient):
    """Takes no answer while a request is being sent."""

    def __init__(self, node: Any, kind: Any, name: str, **options: Any) -> None:
        self._sending = threading.RLock()  # first of all: the node may spin already
        super().__init__(node, kind, name, **options)

    def send_goal_async(self, goal: Any, feedback_callback: Any = None, goal_uuid: Any = None) -> Any:
        """See ``ActionClient``."""
        with self._sending:
            return super().send_goal_async(goal, feedback_callback, goal_uuid)

    def take_data(self) -> Any:
        """See ``rclpy.waitable.Waitable``."""
        with self._sending:
            return super().take_data()

    def _get_result_async(self, goal_handle: Any) -> Any:
        with self._sending:
            return super()._get_result_async(goal_handle)

    def _cancel_goal_async(self, goal_handle: Any) -> Any:
        with self._sending:
            return super()._cancel_goal_async(goal_handle)
