"""The cell of ``singulation_loop`` over ROS: looks through ``objects``, plans by service, pushes by action."""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.time import Time
from singulation_msgs.action import ExecutePush
from singulation_msgs.msg import Arrangement as ArrangementMsg
from singulation_msgs.srv import PlanPush
from std_srvs.srv import Trigger

from singulation_bringup.asking_node import accepted
from singulation_bringup.policy_choice import options_towards
from singulation_core import Arrangement, ContactMode, Push, ResultCode, SingulationError, conversions
from singulation_node.action_client import PatientActionClient
from singulation_node.guard import guarded
from singulation_node.qos import STATE


@dataclass(frozen=True, slots=True)
class CellTimeouts:
    """How long each step may take [s]; none waits for ever.

    Args:
        ready: until planner, executor and camera trigger are there.
        view: from the trigger to the arrangement.
        plan: for one answer of the planner.
        execute: for one push, from goal to result.
        stop: from a cancel request to standstill.
        view_attempts: the camera is triggered so often for one look, each time with ``view`` to wait.
    """

    ready: float = 10.0
    view: float = 10.0
    plan: float = 30.0
    execute: float = 120.0
    stop: float = 10.0
    view_attempts: int = 1


class RosCell:
    """Camera, planner and robot behind topics, services and actions; use it from one thread that is not a callback's
    of a mutually exclusive group.

    Args:
        node: spins elsewhere.
        timeouts: of each step.
        trigger: name of the camera's trigger service, "" if the camera runs freely.
        view_delay: a cloud counts as fresh if stamped at least this long after the last motion ended [s].
    """

    def __init__(self, node: Any, timeouts: CellTimeouts, trigger: str, view_delay: float) -> None:
        self._node, self._timeouts, self._view_delay = node, timeouts, view_delay
        group = ReentrantCallbackGroup()
        self._arrived = threading.Condition()
        self._latest: Any | None = None
        self._headers: dict[int, Any] = {}
        self._fresh_from = node.get_clock().now()
        self._cancel_requested: Callable[[], bool] = lambda: False
        node.create_subscription(ArrangementMsg, "objects", self._on_objects, STATE, callback_group=group)
        self._planner = node.create_client(PlanPush, "plan_push", callback_group=group)
        self._camera = node.create_client(Trigger, trigger, callback_group=group) if trigger else None
        self._clear_view = node.create_client(Trigger, "clear_view", callback_group=group)
        self._arms_in_view = True  # for all that is known
        self._executor = PatientActionClient(node, ExecutePush, "execute_push", callback_group=group)

    def destroy(self) -> None:
        """Give the action client back; the rest is the node's."""
        self._executor.destroy()

    def begin(self, cancel_requested: Callable[[], bool]) -> None:
        """A new goal: the client's wish to cancel is asked through this function.

        Raises:
            SingulationError: ``NOT_READY``, naming what is missing.
        """
        self._cancel_requested, self._arms_in_view = cancel_requested, True
        self._fresh_from = self._node.get_clock().now()
        waiting = [
            ("service plan_push", self._planner.wait_for_service),
            ("action execute_push", self._executor.wait_for_server),
            ("service clear_view", self._clear_view.wait_for_service),
        ]
        if self._camera is not None:
            waiting.append(("camera trigger " + self._camera.srv_name, self._camera.wait_for_service))
        for name, wait in waiting:
            if not wait(timeout_sec=self._timeouts.ready):
                raise SingulationError(ResultCode.NOT_READY, f"{name} did not appear within {self._timeouts.ready} s")

    def check_cancelled(self) -> None:
        """Raise ``CANCELLED`` if the client asked for it."""
        if self._cancel_requested():
            raise SingulationError(ResultCode.CANCELLED, "cancelled by the client")

    def look(self) -> Arrangement:
        """A view stamped after the last motion, with the arms out of it.

        Raises:
            SingulationError: ``NO_FRESH_VIEW`` or ``CANCELLED``; ``NOT_READY`` if the arms cannot leave the view.
        """
        if self._arms_in_view:
            self._leave_view()
        message = self._fresh_view()
        seen = conversions.arrangement_from_msg(message)
        self._headers = {id(seen): message}
        return seen

    def plan(self, seen: Arrangement, policy: str, mode: ContactMode, min_gap: float) -> Push:
        """The planner's answer.

        Raises:
            SingulationError: with the planner's code.
        """
        options = options_towards(policy, min_gap)
        request = PlanPush.Request(
            arrangement=self._headers[id(seen)],
            policy=policy,
            contact_mode=conversions.contact_mode_to_msg(mode),
            policy_options=" ".join(f"{name}={value}" for name, value in options.items()),
        )
        answer = self._await(self._planner.call_async(request), self._timeouts.plan, "plan_push")
        _require_ok(answer)
        return conversions.push_from_msg(answer.push)

    def execute(self, push: Push) -> None:
        """Push, wait for the end, and call only later clouds fresh.

        Raises:
            SingulationError: with the executor's code; ``CANCELLED`` once everything stands still.
        """
        message = next(iter(self._headers.values()))
        goal = ExecutePush.Goal(push=conversions.push_to_msg(push, message.header))
        self._arms_in_view = True
        try:
            self._see_through(self._accepted(goal))
            self._arms_in_view = False  # a push that was done ends beside the view
        finally:
            self._fresh_from = self._node.get_clock().now()

    @guarded
    def _on_objects(self, message: Any) -> None:
        with self._arrived:
            self._latest = message
            self._arrived.notify_all()

    def get_logger(self) -> Any:
        """Logger of the node, for ``guarded``."""
        return self._node.get_logger()

    def _leave_view(self) -> None:
        answer = self._await(self._clear_view.call_async(Trigger.Request()), self._timeouts.execute, "clear_view")
        self._fresh_from = self._node.get_clock().now()
        if not answer.success:
            raise SingulationError(
                ResultCode.NOT_READY, f"the arms could not leave the camera's view: {answer.message}"
            )
        self._arms_in_view = False

    def _fresh_view(self) -> Any:
        """Trigger and wait; clouds travel best effort, and one that is lost is asked for again."""
        for left in reversed(range(self._timeouts.view_attempts)):
            self._trigger()
            try:
                return self._wait_for_fresh_view()
            except SingulationError as error:
                if error.code is not ResultCode.NO_FRESH_VIEW or left == 0:
                    raise
                self._node.get_logger().warning(f"{error}; looking again")
        raise SingulationError(ResultCode.INTERNAL, "view_attempts is below 1")

    def _trigger(self) -> None:
        if self._camera is None:
            return
        answer = self._await(self._camera.call_async(Trigger.Request()), self._timeouts.view, "the camera trigger")
        if not answer.success:
            raise SingulationError(ResultCode.NO_FRESH_VIEW, f"the camera did not trigger: {answer.message}")

    def _wait_for_fresh_view(self) -> Any:
        deadline = time.monotonic() + self._timeouts.view
        with self._arrived:
            while not self._has_fresh_view():
                self.check_cancelled()
                if time.monotonic() > deadline:
                    raise SingulationError(ResultCode.NO_FRESH_VIEW, self._no_view())
                self._arrived.wait(_CANCEL_CHECK)
            return self._latest

    def _no_view(self) -> str:
        last = "none" if self._latest is None else f"{conversions.seconds_of(self._latest.header.stamp):.3f} s"
        wanted = 1e-9 * self._fresh_from.nanoseconds + self._view_delay
        return f"no arrangement stamped after {wanted:.3f} s came within {self._timeouts.view} s; the last one: {last}"

    def _has_fresh_view(self) -> bool:
        if self._latest is None:
            return False
        stamp = Time.from_msg(self._latest.header.stamp, clock_type=self._fresh_from.clock_type)
        return bool((stamp - self._fresh_from).nanoseconds >= 1e9 * self._view_delay)

    def _accepted(self, goal: Any) -> Any:
        """Handle of a goal that the executor took. A cancel waits for it: a push must not begin behind our back.

        Raises:
            SingulationError: ``REJECTED``, or ``PUSH_FAILED`` without an answer; it is cancelled if taken later.
        """
        sent, done = self._executor.send_goal_async(goal), threading.Event()
        sent.add_done_callback(lambda _: done.set())
        if not done.wait(self._timeouts.plan):
            sent.add_done_callback(_cancel_late)
            raise SingulationError(
                ResultCode.PUSH_FAILED, f"execute_push did not answer a goal within {self._timeouts.plan} s"
            )
        return accepted(sent, "execute_push")

    def _see_through(self, handle: Any) -> None:
        """Wait for the end of a push; nothing is left moving behind.

        Raises:
            SingulationError: with the executor's code; ``TIMEOUT`` if it took too long and was stopped; ``PUSH_FAILED``
                if it does not answer any more, and nobody knows whether it stands.
        """
        future = handle.get_result_async()
        late = False
        try:
            self._await(future, self._timeouts.execute, "the push")
        except SingulationError as error:
            late = error.code is ResultCode.TIMEOUT
            self._stop(handle, future)
        result = future.result().result
        if late and result.code == ResultCode.CANCELLED:
            text = f"the push took more than {self._timeouts.execute} s and was stopped: {result.message}"
            raise SingulationError(ResultCode.TIMEOUT, text)
        _require_ok(result)
        if future.result().status != GoalStatus.STATUS_SUCCEEDED:
            raise SingulationError(ResultCode.INTERNAL, f"execute_push ended in status {future.result().status}")

    def _stop(self, handle: Any, future: Any) -> None:
        """Ask the executor to stop and wait until it has ended, one way or another."""
        stopped = threading.Event()
        future.add_done_callback(lambda _: stopped.set())
        handle.cancel_goal_async()
        if not stopped.wait(self._timeouts.stop):
            raise SingulationError(
                ResultCode.PUSH_FAILED,
                f"the executor was asked to stop and did not answer within {self._timeouts.stop} s; look at the robot",
            )

    def _await(self, future: Any, timeout: float, what: str) -> Any:
        """Result of a future; the node spins in other threads.

        Raises:
            SingulationError: ``CANCELLED`` or ``TIMEOUT``.
        """
        done = threading.Event()
        future.add_done_callback(lambda _: done.set())
        for _ in range(max(1, round(timeout / _CANCEL_CHECK))):
            if done.wait(_CANCEL_CHECK):
                return future.result()
            self.check_cancelled()
        raise SingulationError(ResultCode.TIMEOUT, f"{what} did not answer within {timeout} s")


_CANCEL_CHECK = 0.05  # s


def _cancel_late(sent: Any) -> None:
    """A goal that was taken after it had been given up."""
    if sent.result().accepted:
        sent.result().cancel_goal_async()


def _require_ok(answer: Any) -> None:
    if answer.code != ResultCode.OK:
        raise SingulationError(ResultCode(answer.code), answer.message)
