"""Lifecycle node: ABB's SmartGrippers behind the names of the suite.

In: ``<arm>_gripper_controller/commands`` (std_msgs/Float64MultiArray, jaw opening [m]).
Out: ``joint_states`` (sensor_msgs/JointState) with one finger joint per hand [m].
Through the services of abb_rws_client: ``set_sg_command``, ``run_sg_routine``, ``get_io_signal``.

An order that the driver refuses or does not answer is reported and not repeated: the executor sees that the jaws do not
move and ends with GRIPPER_STUCK.
"""

import sys
import time
from collections.abc import Sequence
from functools import partial
from typing import Any

from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, Header

from singulation_bringup.adapters.driver_messages import driver_type
from singulation_bringup.adapters.hand_orders import SIDES, HandOrder, HandOrders, finger_millimetres
from singulation_bringup.adapters.smart_gripper_settings import SmartGripperSettings
from singulation_core import InvalidInputError
from singulation_node.guard import guarded
from singulation_node.main import run_node
from singulation_node.managed_node import ManagedNode
from singulation_node.qos import COMMAND, STATE

_INTERFACES = "ros-industrial/abb_robot_driver_interfaces"
_SUCCESS, _MOVE_TO = 1, 5  # abb_robot_msgs/ServiceResponses, abb_rapid_sm_addin_msgs/SetSGCommand


class SmartGripperAdapter(ManagedNode[SmartGripperSettings]):
    """See the module."""

    def __init__(self, **options: Any) -> None:
        super().__init__("smart_gripper_adapter", SmartGripperSettings, **options)
        self._questions: dict[str, Any] = {}

    def configure(self) -> None:
        """Find the driver's types.

        Raises:
            SingulationError: ``NOT_READY``, naming what has to be built.
        """
        self._order_type = driver_type("abb_rapid_sm_addin_msgs", "srv", "SetSGCommand", _INTERFACES)
        self._run_type = driver_type("abb_robot_msgs", "srv", "TriggerWithResultCode", _INTERFACES)
        self._signal_type = driver_type("abb_robot_msgs", "srv", "GetIOSignal", _INTERFACES)
        self._orders = HandOrders(self.settings.answer_timeout, time.monotonic)
        self._states = self.create_publisher(JointState, "joint_states", STATE)

    def activate(self) -> None:
        """Take orders and report positions."""
        self._set = self.create_client(self._order_type, "set_sg_command")
        self._run = self.create_client(self._run_type, "run_sg_routine")
        self._signal = self.create_client(self._signal_type, "get_io_signal")
        self._questions = {}
        for side in SIDES:
            topic = f"{side}_gripper_controller/commands"
            self.create_subscription(Float64MultiArray, topic, partial(self._on_order, side), COMMAND)
        self.create_timer(self.settings.poll_period, self._poll)

    @guarded
    def _on_order(self, side: str, message: Any) -> None:
        try:
            if len(message.data) != 1:
                raise InvalidInputError(f"gripper: {len(message.data)} values, need one opening")
            self._orders.add(HandOrder(side, finger_millimetres(float(message.data[0]))))
        except InvalidInputError as error:
            self.diagnostics.report(f"{side} order", False, error.message)
            self.get_logger().warning(f"{side} hand: {error}")
        else:
            self._advance()

    @guarded
    def _advance(self) -> None:
        order = self._orders.begin()
        if order is None:
            return
        task = self.settings.rapid_tasks[SIDES.index(order.side)]
        request = self._order_type.Request(task=task, command=_MOVE_TO, target_position=order.position)
        self._set.call_async(request).add_done_callback(lambda answer: self._told(order, answer))

    @guarded
    def _told(self, order: HandOrder, answer: Any) -> None:
        if answer.result().result_code != _SUCCESS:
            self._finish(order, f"set_sg_command: {answer.result().message}")
            return
        running = self._run.call_async(self._run_type.Request())
        running.add_done_callback(lambda ran: self._ran(order, ran))

    @guarded
    def _ran(self, order: HandOrder, answer: Any) -> None:
        failed = answer.result().result_code != _SUCCESS
        self._finish(order, f"run_sg_routine: {answer.result().message}" if failed else "")

    def _finish(self, order: HandOrder, problem: str) -> None:
        if self._orders.end(order):
            self._tell(order, problem)
        self._advance()

    def _tell(self, order: HandOrder, problem: str) -> None:
        text = problem or f"fingers to {order.position:.1f} mm"
        self.diagnostics.report(f"{order.side} order", not problem, text)
        if problem:
            self.get_logger().warning(f"{order.side} hand, {order.position:.1f} mm: {problem}")

    @guarded
    def _poll(self) -> None:
        late = self._orders.overdue()
        if late is not None:
            self._tell(late, f"no answer of the driver within {self.settings.answer_timeout} s")
            self._advance()
        if not self._signal.service_is_ready():
            self.diagnostics.report("positions", False, f"nobody offers {self._signal.srv_name}")
            return
        for side in SIDES:
            self._ask(side)

    def _ask(self, side: str) -> None:
        """One question per hand at a time; one that stays without answer is given up."""
        asked, question = self._questions.get(side, (0.0, None))
        if question is not None and not question.done():
            if time.monotonic() - asked < self.settings.answer_timeout:
                return
            self._signal.remove_pending_request(question)
            self.diagnostics.report("positions", False, f"no answer about the {side} hand")
        name = self.settings.left_position_signal if side == "left" else self.settings.right_position_signal
        question = self._signal.call_async(self._signal_type.Request(signal=name))
        self._questions[side] = (time.monotonic(), question)
        question.add_done_callback(lambda answer: self._report(side, name, answer))

    @guarded
    def _report(self, side: str, name: str, answer: Any) -> None:
        response, settings = answer.result(), self.settings
        if response.result_code != _SUCCESS:
            self.diagnostics.report("positions", False, f"{name}: {response.message}")
            return
        position = float(response.value) / settings.counts_per_metre
        joint = settings.left_finger_joint if side == "left" else settings.right_finger_joint
        header = Header(stamp=self.get_clock().now().to_msg())
        self._states.publish(JointState(header=header, name=[joint], position=[position]))
        self.diagnostics.report("positions", True, "ok")


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    return run_node(SmartGripperAdapter, args)


if __name__ == "__main__":
    sys.exit(main())
