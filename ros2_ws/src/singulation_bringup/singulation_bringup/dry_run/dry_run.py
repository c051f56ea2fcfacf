"""Lifecycle node in the executor's place that plans the motion of every ``push`` and shows it, and orders nothing.

In: ``push``, ``objects``, ``joint_states``. Out: the motion in numbers on the terminal, ``dry_run/markers``,
``/diagnostics``. There is no topic on which it could move a robot: it has no publisher to a controller, and its enclave
(security/) may have none.
"""

import sys
from collections.abc import Sequence
from typing import Any

from sensor_msgs.msg import JointState
from singulation_msgs.msg import Arrangement, PushTrajectory
from visualization_msgs.msg import MarkerArray

from singulation_bringup.dry_run.dry_run_markers import motion_markers, no_markers, table_header
from singulation_bringup.dry_run.motion_report import motion_report, report_text
from singulation_core import InvalidInputError, SingulationError
from singulation_core.conversions import arrangement_from_msg, push_from_msg, seconds_of
from singulation_node.guard import guarded
from singulation_node.main import run_node
from singulation_node.managed_node import ManagedNode
from singulation_node.qos import LATCHED, STATE
from yumi_push_executor import plan_motion
from yumi_push_executor.executor_settings import ExecutorSettings
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.push_gate import PushGate
from yumi_push_executor.wire import StateReader


class DryRun(ManagedNode[ExecutorSettings]):
    """Takes the parameters of ``executor_node``; see the module."""

    def __init__(self, **options: Any) -> None:
        super().__init__("dry_run", ExecutorSettings, **options)
        self._positions: Any = None
        self._planned = self._arrangements = 0

    @property
    def has_seen_all(self) -> bool:
        """Whether blocks and robot are known, so that a motion is what the executor would do."""
        return self._positions is not None and self._arrangements > 0

    def configure(self) -> None:
        """Announce the markers."""
        settings = self.settings
        self._reader = StateReader(settings.joint_names, settings.state_age)
        self._gate = PushGate(settings.max_push_age, settings.max_push_skew, settings.need_objects)
        self._markers = self.create_publisher(MarkerArray, "dry_run/markers", LATCHED)

    def activate(self) -> None:
        """Begin to plan."""
        self.create_subscription(JointState, "joint_states", self._take_states, STATE)
        self.create_subscription(Arrangement, "objects", self._take_objects, STATE)
        self.create_subscription(PushTrajectory, "push", self._take_push, STATE)
        self.get_logger().info("dry run: motions are planned and shown, nothing is sent to the robot")

    @guarded
    def _take_states(self, message: Any) -> None:
        stamp = seconds_of(message.header.stamp)
        sample = self._reader.read(message.name, message.position, message.velocity, taken=stamp, arrived=stamp)
        if sample is not None:
            self._positions = sample.positions

    @guarded
    def _take_objects(self, message: Any) -> None:
        stamp = message.header.stamp
        self._gate.add((stamp.sec, stamp.nanosec), arrangement_from_msg(message))
        self._arrangements += 1

    @guarded
    def _take_push(self, message: Any) -> None:
        settings = self.settings
        header = table_header(settings.table_frame, message.header.stamp)
        try:
            motion, phases = self._plan(message, settings)
        except SingulationError as error:
            self._markers.publish(no_markers(header))
            self.diagnostics.report("motion", False, str(error), planned=self._planned)
            self.get_logger().warning(f"no motion: {error}")
            return
        self._planned += 1
        self._markers.publish(motion_markers(phases, f"{motion.arm} arm, {motion.duration:.1f} s", header))
        text = f"{motion.arm} arm, {motion.duration:.1f} s{self._assumption()}"
        self.diagnostics.report("motion", True, text, planned=self._planned)
        self.get_logger().info(f"NOT SENT: {report_text(motion, phases)}{self._assumption()}")

    def _plan(self, message: Any, settings: ExecutorSettings) -> Any:
        """As the executor does it.

        Raises:
            SingulationError: no motion; the code says why.
        """
        if message.header.frame_id != settings.table_frame:
            raise InvalidInputError(f"push: frame {message.header.frame_id!r}, need {settings.table_frame!r}")
        stamp = (message.header.stamp.sec, message.header.stamp.nanosec)
        now = self.get_clock().now().nanoseconds * 1e-9
        motion = plan_motion(
            push_from_msg(message),
            self._gate.require_fresh(stamp, now),
            cell=settings.cell,
            joints=self._positions,
            parameters=settings.motion,
            arms=ARMS if settings.arms == "both" else (settings.arms,),
        )
        return motion, motion_report(motion, settings.cell.body_from_table)

    def _assumption(self) -> str:
        return "" if self._positions is not None else " (no joint states: planned from the clear-view postures)"


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    return run_node(DryRun, args)


if __name__ == "__main__":
    sys.exit(main())
