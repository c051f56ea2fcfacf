"""Lifecycle node: a push becomes a supervised motion of a YuMi.

In: ``execute_push`` (action), ``push`` (only with the parameter ``auto_execute``), ``objects``, ``joint_states``,
``driver_state``. Out: ``<arm>_arm_controller/joint_trajectory``, ``<arm>_gripper_controller/commands``,
``last_outcome`` (singulation_msgs/PushOutcome, latched), ``/diagnostics``. The service ``halt`` holds both arms at any
time; it is no emergency stop. The service ``clear_view`` brings arms that were stopped in the camera's view out of it.

Every goal is accepted and gets a result with a code; one that comes while another is executed is aborted with BUSY.
A goal whose client is gone is finished all the same. Nothing that was stopped goes on by itself.
"""

import sys
import threading
import time
from collections.abc import Sequence
from typing import Any

from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from singulation_msgs.action import ExecutePush
from singulation_msgs.msg import PushOutcome, PushTrajectory
from std_srvs.srv import Trigger

from singulation_core import InvalidInputError, Push, ResultCode, SingulationError
from singulation_core.conversions import push_from_msg
from singulation_node.action_client import PatientActionClient
from singulation_node.guard import guarded, guarded_service, report_failure
from singulation_node.main import run_node
from singulation_node.managed_node import ManagedNode
from singulation_node.qos import LATCHED, STATE
from singulation_node.warming import warm
from yumi_push_executor.controllers import Controllers
from yumi_push_executor.ending import Ending
from yumi_push_executor.executor_diagnostics import report_executor
from yumi_push_executor.executor_inputs import ExecutorInputs
from yumi_push_executor.executor_settings import ExecutorSettings
from yumi_push_executor.goal_ledger import GoalLedger
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.outcome_messages import Feedback, outcome_of, result_of
from yumi_push_executor.push_execution import Outside, PushExecution
from yumi_push_executor.push_gate import PushGate, Stamp
from yumi_push_executor.push_planner import PushPlanner
from yumi_push_executor.robot_view import RobotView
from yumi_push_executor.supervision import Instant, hold_arm

_REPORT_PERIOD = 1.0  # s
_SETTLE = 0.5  # s beyond stop_timeout that a halt or a deactivation waits for
_SEND = 0.2  # s that rclpy may take to send a result after its callback has returned


class ExecutorNode(ManagedNode[ExecutorSettings]):
    """See the module."""

    def __init__(self, **options: Any) -> None:
        super().__init__("executor_node", ExecutorSettings, **options)
        self.ledger = GoalLedger()
        self._simulated = False
        self._execution: PushExecution | None = None

    def configure(self) -> None:
        """Load the robot model, listen to the robot, offer the action and ``halt``."""
        settings = self.settings
        self._simulated = bool(self.get_parameter("use_sim_time").value)
        planner = self._warm_planner()
        self._view = RobotView(settings.joint_names, planner.ranges, settings.limits, self.instant)
        self._gate = PushGate(settings.max_push_age, settings.max_push_skew, settings.need_objects)
        self._controllers = Controllers(self, settings.joint_names)
        outside = Outside(self._controllers.send, self.instant, self.ros_time, self._controllers.require)
        self._execution = PushExecution(self._view, self._gate, planner, outside)
        self._last_outcome = self.create_publisher(PushOutcome, "last_outcome", LATCHED)
        self._inputs = ExecutorInputs(self, self._view, self._gate, settings.table_frame)
        self.create_service(Trigger, "halt", self._halt, callback_group=ReentrantCallbackGroup())
        self.create_service(Trigger, "clear_view", self._clear_view, callback_group=ReentrantCallbackGroup())
        self.create_timer(_REPORT_PERIOD, self._report, callback_group=MutuallyExclusiveCallbackGroup())
        self._open_action(settings.result_timeout)

    def activate(self) -> None:
        """Begin to take pushes."""
        self.create_subscription(PushTrajectory, "push", self._take_push, STATE)

    def deactivate(self) -> None:
        """Stop what moves."""
        execution = self._execution
        if execution is None or not execution.halt("the node was deactivated"):
            return
        if not execution.idle.wait(self.settings.stop_timeout + _SETTLE):
            execution.abandon()
            execution.idle.wait(_SETTLE)

    def cleanup(self) -> None:
        """Close the action, once its last result is on its way."""
        self.ledger.wait_for_none_open(_SETTLE)
        threading.Event().wait(_SEND)
        self._server.destroy()
        self._client.destroy()
        self._execution = None

    def make_planner(self) -> PushPlanner:
        """The planner of motions."""
        return PushPlanner(self.settings)

    def instant(self) -> Instant:
        """The present: motions are timed by the clock of the states, which is the steady clock unless it is simulated.

        The system's clock may step; neither the steady clock nor a simulation's does.
        """
        wall = time.monotonic()
        return Instant(self.ros_time() if self._simulated else wall, wall, self._view.listened)

    def ros_time(self) -> float:
        """The clock of the stamps [s]."""
        return float(self.get_clock().now().nanoseconds) * 1e-9

    def _warm_planner(self) -> PushPlanner:
        planner = self.make_planner()
        warm(self, planner.warm_up, "some seconds")
        return planner

    def _open_action(self, result_timeout: float) -> None:
        self._server = ActionServer(
            self,
            ExecutePush,
            "execute_push",
            self._execute,
            callback_group=ReentrantCallbackGroup(),
            goal_callback=lambda request: GoalResponse.ACCEPT,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
            result_timeout=round(result_timeout),
        )
        self._client = PatientActionClient(self, ExecutePush, "execute_push", callback_group=ReentrantCallbackGroup())

    def _execute(self, goal: Any) -> Any:
        """One goal, one result. Runs in a thread of the executor."""
        self.ledger.receive()
        try:
            ending = self._ending_of(goal)
        except Exception as error:  # a defect between here and the library; a raise would send an empty result
            report_failure(self, "execute_push", error)
            ending = Ending.failed(ResultCode.INTERNAL, f"{type(error).__name__}: {error}")
        if ending.defect is not None:
            report_failure(self, "execute_push", ending.defect)
        self._conclude(goal, ending)
        self.ledger.end(ending.code)
        return result_of(ending)

    @guarded
    def _conclude(self, goal: Any, ending: Ending) -> None:
        """Say how it ended, everywhere but in the result itself, which has to get through whatever happens here."""
        _close(goal, ending.code)
        self._log(ending)
        if ending.code is not ResultCode.BUSY:
            self._last_outcome.publish(outcome_of(ending, goal.request.push, self.get_clock().now().to_msg()))

    def _ending_of(self, goal: Any) -> Ending:
        execution = self._execution
        if execution is None or not self.is_active:
            return Ending.failed(ResultCode.NOT_READY, "the node is not active")
        message, feedback = goal.request.push, Feedback(self, goal)
        return execution.execute(
            lambda: self._read(message), self.settings.limits, lambda: bool(goal.is_cancel_requested), feedback.tell
        )

    def _read(self, message: PushTrajectory) -> tuple[Push, Stamp]:
        frame = message.header.frame_id
        if frame != self.settings.table_frame:
            raise InvalidInputError(f"push: frame {frame!r}, need {self.settings.table_frame!r}")
        return push_from_msg(message), (message.header.stamp.sec, message.header.stamp.nanosec)

    @guarded
    def _take_push(self, message: PushTrajectory) -> None:
        """Ask the own action for it, so that there is one way to execute a push."""
        if not self.settings.auto_execute:
            return
        if self._client.server_is_ready():
            self._client.send_goal_async(ExecutePush.Goal(push=message))
        else:
            self.get_logger().warning("a push came before the action was ready; it is not executed")

    @guarded_service
    def _halt(self, request: Any, response: Any) -> Any:
        execution = self._execution
        if execution is not None and execution.halt("the halt service was called"):
            stopped = execution.idle.wait(self.settings.stop_timeout + _SETTLE)
            response.success = stopped
            response.message = "the push was stopped" if stopped else "ordered to stop; standstill not seen yet"
            return response
        with self._view.lock:
            orders = [hold_arm(arm, self._view.watch, self.settings.limits) for arm in ARMS]
        for order in orders:
            self._controllers.send(order)
        response.success = True
        response.message = "nothing was being executed; both arms are held where they are"
        return response

    @guarded_service
    def _clear_view(self, request: Any, response: Any) -> Any:
        execution = self._execution
        if execution is None or not self.is_active:
            raise SingulationError(ResultCode.NOT_READY, "the node is not active")
        ending = execution.clear_view(self.settings.limits)
        if ending.defect is not None:
            report_failure(self, "clear_view", ending.defect)
        response.success, response.message = ending.code is ResultCode.OK, f"{ending.code.name}: {ending.text}"
        return response

    @guarded
    def _report(self) -> None:
        report_executor(self.diagnostics, self._view, self.instant(), self.ledger, self._controllers)

    def _log(self, ending: Ending) -> None:
        text = f"push ended with {ending.code.name}: {ending.text} (planned in {1e3 * ending.planning_time:.0f} ms)"
        self.diagnostics.report(
            "last push", ending.code is ResultCode.OK, ending.text, code=ending.code.name, planning=ending.planning_time
        )
        if ending.code is ResultCode.OK:
            self.get_logger().info(text)
        else:
            self.get_logger().warning(text)


def _close(goal: Any, code: ResultCode) -> None:
    """The action's own status for a code."""
    if code is ResultCode.OK:
        goal.succeed()
    elif code is ResultCode.CANCELLED:
        goal.canceled()
    else:
        goal.abort()


def main(args: Sequence[str] | None = None) -> int:
    """Run the node."""
    return run_node(ExecutorNode, args, threads=6)


if __name__ == "__main__":
    sys.exit(main())
