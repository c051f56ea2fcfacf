"""Lifecycle node: ``objects`` (singulation_msgs/Arrangement) in, ``push`` (PushTrajectory) out, service ``plan_push``.

Every arrangement ends in exactly one of: a push, or a code and its reason in the diagnostics. An arrangement that is
too old, from the future or without a time is refused: objects may have moved since.
"""

import math
import sys
import time
from collections import Counter
from collections.abc import Sequence
from typing import Any

from rclpy.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from singulation_msgs import msg as messages
from singulation_msgs.srv import PlanPush
from visualization_msgs.msg import MarkerArray

from singulation_core import Arrangement, ContactMode, InvalidInputError, Push, ResultCode, SingulationError
from singulation_core.conversions import (
    arrangement_from_msg,
    arrangement_to_msg,
    contact_mode_from_msg,
    push_to_msg,
    seconds_of,
)
from singulation_node.guard import guarded, guarded_service
from singulation_node.main import run_node
from singulation_node.managed_node import ManagedNode
from singulation_node.qos import STATE
from singulation_node.warming import warm
from singulation_planner import plan_push, warm_up
from singulation_planner.planner_markers import planner_markers
from singulation_planner.planner_settings import PlannerSettings

_LOG_PERIOD = 5.0  # s between log lines about arrangements without a push
# While a slow policy plans, newer arrangements replace each other instead of queueing up.
_NEWEST = QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=1, reliability=ReliabilityPolicy.RELIABLE)


class PlannerNode(ManagedNode[PlannerSettings]):
    """Plans pushes; see the module."""

    def __init__(self, **options: Any) -> None:
        super().__init__("planner_node", PlannerSettings, **options)
        self.outcomes: Counter[str] = Counter()

    def configure(self) -> None:
        """Load the compiled kernels and announce the results."""
        warm(self, warm_up, "up to half a minute", "singulation_planner.warming")
        self._pushes = self.create_publisher(messages.PushTrajectory, "push", STATE)
        self._markers = self.create_publisher(MarkerArray, "planner/markers", STATE)

    def activate(self) -> None:
        """Begin to take arrangements and requests."""
        self.create_subscription(messages.Arrangement, "objects", self._arrived, _NEWEST)
        self.create_service(PlanPush, "plan_push", self._serve)
        self.diagnostics.report("planning", True, "nothing planned yet")

    @guarded
    def _arrived(self, message: Any) -> None:
        settings = self.settings
        if not settings.plan_on_arrival:
            return
        try:
            push, _ = self._plan(message, settings, settings.policy, ContactMode[settings.contact_mode.upper()])
        except SingulationError as error:
            self.get_logger().warning(f"no push: {error}", throttle_duration_sec=_LOG_PERIOD)
        else:
            self._pushes.publish(push_to_msg(push, message.header))

    @guarded_service
    def _serve(self, request: Any, response: Any) -> Any:
        settings = self.settings
        mode = contact_mode_from_msg(request.contact_mode)
        policy = request.policy or settings.policy
        push, seconds = self._plan(request.arrangement, settings, policy, mode, request.policy_options)
        response.code, response.message = int(ResultCode.OK), ""
        response.push = push_to_msg(push, request.arrangement.header)
        if push.expected is not None:
            response.expected = arrangement_to_msg(push.expected, request.arrangement.header.stamp)
        response.planning_time = seconds
        return response

    def _plan(
        self, message: Any, settings: PlannerSettings, policy: str, mode: ContactMode, asked: str = ""
    ) -> tuple[Push, float]:
        """The push and the time that planning took [s]; every outcome is counted and shown."""
        push, arrangement, seconds = None, None, math.nan
        try:
            self._check_header(message.header, settings)
            arrangement = arrangement_from_msg(message)
            options = settings.options(policy, asked)
            started = time.perf_counter()
            push = plan_push(arrangement, policy, mode, **settings.arguments, **options)
            seconds = time.perf_counter() - started
        except SingulationError as error:
            self._count(error.code, error.message, policy)
            raise
        finally:
            self._show(arrangement, push, settings, message.header)
        self._count(ResultCode.OK, f"object {push.target_id} of {len(arrangement)}", policy, seconds)
        return push, seconds

    @guarded
    def _show(self, arrangement: Arrangement | None, push: Push | None, settings: PlannerSettings, header: Any) -> None:
        if arrangement is not None and self._markers.get_subscription_count() > 0:
            self._markers.publish(planner_markers(arrangement, push, settings.arguments["pusher"], header))

    def _check_header(self, header: Any, settings: PlannerSettings) -> None:
        if header.frame_id != settings.frame:
            raise InvalidInputError(f"arrangement in frame {header.frame_id!r}, need {settings.frame!r}")
        stamp = seconds_of(header.stamp)
        if stamp == 0.0:
            raise SingulationError(ResultCode.STALE_INPUT, "arrangement without a stamp, its age is unknown")
        age = 1e-9 * self.get_clock().now().nanoseconds - stamp
        if not (-settings.max_future <= age <= settings.max_age):
            raise SingulationError(
                ResultCode.STALE_INPUT,
                f"arrangement is {age:.3f} s old, need {-settings.max_future} to {settings.max_age} s",
            )

    def _count(self, code: ResultCode, text: str, policy: str, seconds: float = math.nan) -> None:
        self.outcomes[code.name] += 1
        report = self.diagnostics.report
        good = code in (ResultCode.OK, ResultCode.NOTHING_TO_DO)
        values = {f"count {name}": count for name, count in sorted(self.outcomes.items())}
        report("planning", good, f"{code.name}: {text}", policy=policy, planning_time=seconds, **values)


def main(args: Sequence[str] | None = None) -> int:
    """Entry point."""
    return run_node(PlannerNode, args, threads=1)


if __name__ == "__main__":
    sys.exit(main())
