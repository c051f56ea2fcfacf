"""Lifecycle node: the state topics of ABB's public ROS 2 driver become ``driver_state``.

In: ``system_states`` (abb_robot_msgs/SystemState), ``runtime_states`` (abb_rapid_sm_addin_msgs/RuntimeState, with
``require_egm``), service ``get_io_signal`` (abb_robot_msgs/GetIOSignal, with ``grippers: signals``).
Out: ``driver_state`` (singulation_msgs/DriverState), one for each system state: a driver that falls silent is silent
here, too, and the executor sees it.
"""

import sys
import time
from collections.abc import Sequence
from typing import Any

from singulation_msgs.msg import DriverState
from std_msgs.msg import Header

from singulation_bringup.adapters.controller_state import ControllerState, egm_runs, verdict
from singulation_bringup.adapters.driver_messages import driver_type
from singulation_bringup.adapters.driver_state_settings import ASSUMED, SIGNALS, DriverStateSettings
from singulation_node.guard import guarded
from singulation_node.main import run_node
from singulation_node.managed_node import ManagedNode
from singulation_node.qos import STATE

_INTERFACES = "ros-industrial/abb_robot_driver_interfaces"
_SUCCESS = 1  # abb_robot_msgs/ServiceResponses


class DriverStateAdapter(ManagedNode[DriverStateSettings]):
    """See the module."""

    def __init__(self, **options: Any) -> None:
        super().__init__("driver_state_adapter", DriverStateSettings, **options)
        self._egm: tuple[float, bool | None] = (float("-inf"), None)
        self._calibrated = {"left": False, "right": False}
        self._asked: dict[str, Any] = {}

    def configure(self) -> None:
        """Find the driver's message types.

        Raises:
            SingulationError: ``NOT_READY``, naming what has to be built.
        """
        settings = self.settings
        self._system_type = driver_type("abb_robot_msgs", "msg", "SystemState", _INTERFACES)
        if settings.require_egm:
            self._runtime_type = driver_type("abb_rapid_sm_addin_msgs", "msg", "RuntimeState", _INTERFACES)
        if settings.grippers == SIGNALS:
            self._signal_type = driver_type("abb_robot_msgs", "srv", "GetIOSignal", _INTERFACES)
        self._states = self.create_publisher(DriverState, "driver_state", STATE)

    def activate(self) -> None:
        """Listen to the driver."""
        settings = self.settings
        self._calibrated = dict.fromkeys(("left", "right"), settings.grippers == ASSUMED)
        if settings.require_egm:
            self.create_subscription(self._runtime_type, "runtime_states", self._on_runtime, STATE)
        if settings.grippers == SIGNALS:
            self._signals = self.create_client(self._signal_type, "get_io_signal")
            self._asked = {}
            self.create_timer(settings.gripper_period, self._ask_grippers)
        self.create_subscription(self._system_type, "system_states", self._on_system, STATE)

    @guarded
    def _on_runtime(self, message: Any) -> None:
        machines = [(item.rapid_task, int(item.sm_state)) for item in message.state_machines]
        self._egm = (time.monotonic(), egm_runs(machines, self.settings.rapid_tasks))

    @guarded
    def _on_system(self, message: Any) -> None:
        settings = self.settings
        heard, running = self._egm
        egm = running if time.monotonic() - heard <= settings.runtime_age else None
        state = ControllerState(message.motors_on, message.auto_mode, message.rapid_running, egm)
        found = verdict(state, settings.require_egm)
        self.diagnostics.report("controller", found.motion_enabled, found.text or "takes motions", **self._calibrated)
        self._states.publish(
            DriverState(
                header=Header(stamp=message.header.stamp, frame_id=message.header.frame_id),
                mode=int(found.mode),
                motion_enabled=found.motion_enabled,
                left_gripper_calibrated=self._calibrated["left"],
                right_gripper_calibrated=self._calibrated["right"],
                message=found.text,
            )
        )

    @guarded
    def _ask_grippers(self) -> None:
        settings = self.settings
        if not self._signals.service_is_ready():
            self._calibrated = dict.fromkeys(self._calibrated, False)
            self._asked = {}
            self.diagnostics.warn("grippers", f"nobody offers {self._signals.srv_name}")
            return
        for side, signal in (("left", settings.left_gripper_signal), ("right", settings.right_gripper_signal)):
            earlier = self._asked.get(side)
            if earlier is not None:
                self._take_signal(side, signal, earlier)
            if earlier is None or earlier.done():
                self._asked[side] = self._signals.call_async(self._signal_type.Request(signal=signal))

    def _take_signal(self, side: str, signal: str, answer: Any) -> None:
        """An answer that did not come within a period counts as "not calibrated"."""
        if not answer.done():
            calibrated, text = False, f"{signal}: no answer within {self.settings.gripper_period} s"
        elif answer.result().result_code != _SUCCESS:
            calibrated, text = False, f"{signal}: {answer.result().message}"
        else:
            value = answer.result().value.strip()
            calibrated, text = value == "1", f"{signal} is {value}"
        self._calibrated[side] = calibrated
        self.diagnostics.report(f"{side} gripper", calibrated, text)


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    return run_node(DriverStateAdapter, args)


if __name__ == "__main__":
    sys.exit(main())
