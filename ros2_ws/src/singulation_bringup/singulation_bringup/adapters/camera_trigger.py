"""Lifecycle node: the trigger of Photoneo's driver behind ``trigger_frame`` (std_srvs/Trigger).

A frame that the driver cannot take, and a driver that does not answer in time, are answers with ``success: false``.
"""

import sys
import threading
from collections.abc import Sequence
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from std_srvs.srv import Trigger

from singulation_bringup.adapters.camera_trigger_settings import CameraTriggerSettings
from singulation_bringup.adapters.driver_messages import driver_type
from singulation_core import ResultCode, SingulationError
from singulation_node.guard import guarded_service
from singulation_node.main import run_node
from singulation_node.managed_node import ManagedNode


class CameraTrigger(ManagedNode[CameraTriggerSettings]):
    """See the module."""

    def __init__(self, **options: Any) -> None:
        super().__init__("camera_trigger", CameraTriggerSettings, **options)

    def configure(self) -> None:
        """Find the driver's service type.

        Raises:
            SingulationError: ``NOT_READY``, naming what has to be built.
        """
        self._type = driver_type("phoxi_camera_msgs", "srv", "TriggerFrame", "photoneo/PhoXi-ROS-API")

    def activate(self) -> None:
        """Offer the trigger."""
        # The answer of the driver is waited for inside a callback, so it needs a group of its own.
        self._driver = self.create_client(
            self._type, self.settings.driver_service, callback_group=MutuallyExclusiveCallbackGroup()
        )
        self.create_service(Trigger, "trigger_frame", self._trigger, callback_group=MutuallyExclusiveCallbackGroup())

    @guarded_service
    def _trigger(self, request: Any, response: Any) -> Any:
        settings = self.settings
        if not self._driver.wait_for_service(timeout_sec=settings.timeout):
            raise SingulationError(
                ResultCode.NOT_READY, f"nobody offers {self._driver.srv_name}; is the driver active?"
            )
        done = threading.Event()
        future = self._driver.call_async(self._type.Request(wait_grabbing_end=settings.wait_grabbing_end))
        future.add_done_callback(lambda _: done.set())
        if not done.wait(settings.timeout):
            self._driver.remove_pending_request(future)
            raise SingulationError(
                ResultCode.TIMEOUT, f"{self._driver.srv_name} did not answer within {settings.timeout} s"
            )
        answer = future.result()
        response.success, response.message = bool(answer.success), str(answer.message)
        self.diagnostics.report("frame", response.success, response.message or "taken")
        return response


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    return run_node(CameraTrigger, args)


if __name__ == "__main__":
    sys.exit(main())
