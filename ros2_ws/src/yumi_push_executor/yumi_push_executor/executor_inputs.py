"""What the executor hears: joint states, driver state, arrangements. Malformed messages are refused and shown."""

from collections import Counter
from typing import Any

from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock, ClockType
from sensor_msgs.msg import JointState
from singulation_msgs.msg import Arrangement, DriverState

from singulation_core import InvalidInputError, SingulationError
from singulation_core.conversions import arrangement_from_msg, seconds_of
from singulation_node.guard import guarded
from singulation_node.qos import STATE
from yumi_push_executor.push_gate import PushGate
from yumi_push_executor.robot_view import TICK, RobotView
from yumi_push_executor.wire_messages import driver_status_from_msg

_LOG_PERIOD = 5.0  # s between log lines about refused messages


class ExecutorInputs:
    """Subscriptions of a node.

    Args:
        node: a managed node with ``instant`` and ``ros_time``.
        view: takes the robot's states.
        gate: takes the arrangements.
        table_frame: that arrangements have to be in.
    """

    def __init__(self, node: Any, view: RobotView, gate: PushGate, table_frame: str) -> None:
        self._node, self._view, self._gate, self._table_frame = node, view, gate, table_frame
        self.diagnostics = node.diagnostics
        self._refusals: Counter[str] = Counter()
        # Each in a group of its own: on a busy machine the frequent joint states would else keep the others waiting.
        states, driver, objects = (MutuallyExclusiveCallbackGroup() for _ in range(3))
        node.create_subscription(JointState, "joint_states", self._take_states, STATE, callback_group=states)
        node.create_subscription(DriverState, "driver_state", self._take_driver, STATE, callback_group=driver)
        node.create_subscription(Arrangement, "objects", self._take_objects, STATE, callback_group=objects)
        # In the group of the states: while a tick comes through, a state would have, too.
        node.create_timer(TICK, view.tick, callback_group=states, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def get_logger(self) -> Any:
        """Logger of the node, for ``guarded``."""
        return self._node.get_logger()

    @guarded
    def _take_states(self, message: JointState) -> None:
        delay = self._node.ros_time() - seconds_of(message.header.stamp)
        try:
            self._view.add_states(message.name, message.position, message.velocity, delay)
        except SingulationError as error:
            self._refused("joint_states", error)

    @guarded
    def _take_driver(self, message: DriverState) -> None:
        try:
            self._view.add_driver(driver_status_from_msg(message, self._node.instant()))
        except SingulationError as error:
            self._refused("driver_state", error)

    @guarded
    def _take_objects(self, message: Arrangement) -> None:
        try:
            if message.header.frame_id != self._table_frame:
                raise InvalidInputError(f"objects: frame {message.header.frame_id!r}, need {self._table_frame!r}")
            stamp = message.header.stamp
            self._gate.add((stamp.sec, stamp.nanosec), arrangement_from_msg(message))
        except SingulationError as error:
            self._refused("objects", error)
        else:
            self.diagnostics.report("objects", True, f"{len(message.objects)} objects")

    def _refused(self, topic: str, error: SingulationError) -> None:
        self._refusals[topic] += 1
        self.diagnostics.warn(f"refused {topic}", error.message, messages=self._refusals[topic])
        self.get_logger().warning(f"{topic}: {error}", throttle_duration_sec=_LOG_PERIOD)
