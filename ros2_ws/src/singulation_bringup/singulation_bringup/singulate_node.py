"""Coordinator: the ``singulate`` action looks, plans, pushes and looks again until the blocks are separated."""

import threading
from dataclasses import dataclass
from typing import Any

from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from singulation_msgs.action import Singulate
from singulation_msgs.msg import PushOutcome
from std_msgs.msg import Header

from singulation_bringup.policy_choice import DEFAULT_MIN_GAP, DEFAULT_POLICY, FALLBACK_POLICIES
from singulation_bringup.ros_cell import CellTimeouts, RosCell
from singulation_bringup.singulation_loop import SingulationGoal, SingulationLoop
from singulation_bringup.singulation_progress import Outcome, Progress, SingulationResult
from singulation_bringup.timed_cell import TimedCell
from singulation_core import ResultCode, SingulationError, conversions
from singulation_node.guard import guarded, report_failure
from singulation_node.main import run_node
from singulation_node.managed_node import ManagedNode
from singulation_node.parameters import parameter
from singulation_node.qos import RECORD
from singulation_planner import POLICIES

_RESULT_TIMEOUT = 900  # s that a result is kept for a client that asks late


@dataclass(frozen=True)
class SingulateSettings:
    """Parameters of ``singulate_node``."""

    trigger_service: str = parameter("trigger_frame", 'camera trigger (std_srvs/Trigger), "" if the camera runs freely')
    view_delay: float = parameter(0.0, "a cloud is fresh this long after the last motion [s]", low=0.0, high=10.0)
    min_gap: float = parameter(
        DEFAULT_MIN_GAP, "gap that counts as separated if a goal says 0 [m]", low=0.0001, high=1.0
    )
    policy: str = parameter(
        DEFAULT_POLICY, "how pushes are chosen if a goal names no policy", choices=tuple(sorted(POLICIES))
    )
    fallback_policies: tuple[str, ...] = parameter(
        FALLBACK_POLICIES, "policies asked in turn when the planned push cannot be performed"
    )
    ready_timeout: float = parameter(10.0, "wait for planner, executor, camera [s]", low=0.1, high=600.0)
    view_timeout: float = parameter(10.0, "wait for a fresh arrangement [s]", low=0.1, high=600.0)
    view_attempts: int = parameter(3, "triggers for one look at most, as a cloud may be lost", low=1, high=10)
    plan_timeout: float = parameter(30.0, "wait for the planner's answer [s]", low=0.1, high=600.0)
    execute_timeout: float = parameter(120.0, "wait for the end of one push [s]", low=1.0, high=3600.0)
    stop_timeout: float = parameter(10.0, "wait for standstill after a cancel [s]", low=0.1, high=60.0)


class SingulateNode(ManagedNode[SingulateSettings]):
    """One goal at a time; a second one is refused while the first runs. Publishes every PushOutcome on ``outcomes``."""

    def __init__(self, **options: Any) -> None:
        super().__init__("singulate_node", SingulateSettings, **options)
        self._busy = threading.Lock()
        self._goals = {"accepted": 0, "rejected": 0, "ended": 0}
        self._cell: RosCell | None = None
        self._server: Any = None

    def configure(self) -> None:
        """Publishers exist from here on."""
        self._outcomes = self.create_publisher(PushOutcome, "outcomes", RECORD)

    def activate(self) -> None:
        """Connect to camera, planner and executor, and take goals."""
        settings = self.settings
        timeouts = CellTimeouts(
            settings.ready_timeout,
            settings.view_timeout,
            settings.plan_timeout,
            settings.execute_timeout,
            settings.stop_timeout,
            settings.view_attempts,
        )
        self._cell = RosCell(self, timeouts, settings.trigger_service, settings.view_delay)
        self._server = ActionServer(
            self,
            Singulate,
            "singulate",
            execute_callback=self._execute,
            goal_callback=self._on_goal,
            cancel_callback=self._on_cancel,
            callback_group=ReentrantCallbackGroup(),
            result_timeout=_RESULT_TIMEOUT,
        )

    def deactivate(self) -> None:
        """Take no more goals; a running one ends as cancelled."""
        if self._server is not None:
            self._server.destroy()
        # is_active is False already: the running goal sees it and ends.
        if self._busy.acquire(timeout=2.0 * self.settings.stop_timeout):
            self._busy.release()
        if self._cell is not None:
            self._cell.destroy()
        self._server = self._cell = None

    def _on_goal(self, request: Any) -> Any:
        problem = _problem(request)
        if problem is None and (not self.is_active or self._busy.locked()):
            problem = "busy with another goal" if self.is_active else "not active"
        if problem is None:
            self._goals["accepted"] += 1
            return GoalResponse.ACCEPT
        self._goals["rejected"] += 1
        self.get_logger().warning(f"goal rejected: {problem}")
        self._report_goals(f"last goal rejected: {problem}")
        return GoalResponse.REJECT

    def _on_cancel(self, handle: Any) -> Any:
        return CancelResponse.ACCEPT

    def _execute(self, handle: Any) -> Any:
        """Exactly one outcome for every accepted goal, whatever happens."""
        if not self._busy.acquire(blocking=False):
            result = SingulationResult(ResultCode.BUSY, "busy with another goal", Progress())
        else:
            try:
                result = self._singulate(handle)
            except SingulationError as error:
                result = SingulationResult(error.code, error.message, Progress())
            except Exception as error:
                report_failure(self, "singulate", error)
                result = SingulationResult(ResultCode.INTERNAL, f"{type(error).__name__}: {error}", Progress())
            finally:
                self._busy.release()
        self._goals["ended"] += 1
        self._report_goals(f"{result.code.name}: {result.message}")
        self.get_logger().info(f"singulate ended: {result.code.name}: {result.message}")
        return _finish(handle, result)

    def _singulate(self, handle: Any) -> SingulationResult:
        request, cell = handle.request, self._cell
        if cell is None:
            raise SingulationError(ResultCode.NOT_READY, "not active")
        goal = SingulationGoal(
            int(request.max_pushes),
            float(request.min_gap) or self.settings.min_gap,
            request.policy or self.settings.policy,
            conversions.contact_mode_from_msg(request.contact_mode),
            self.settings.fallback_policies,
        )
        cell.begin(lambda: handle.is_cancel_requested or not self.is_active)
        published = 0

        @guarded
        def report(node: SingulateNode, progress: Progress) -> None:
            nonlocal published
            for outcome in progress.outcomes[published:]:
                node._outcomes.publish(outcome_to_msg(outcome, node.get_clock().now().to_msg()))
                published += 1
            handle.publish_feedback(_feedback(progress))

        timed = TimedCell(cell)
        try:
            return SingulationLoop(timed, goal, lambda progress: report(self, progress)).run()
        finally:
            self._report_stages(timed)

    def _report_stages(self, timed: TimedCell) -> None:
        """Said at once, so that whoever waits for the result has it too."""
        counts = {f"{name} count": stage.count for name, stage in timed.stages.items()}
        seconds = {f"{name} [s]": stage.seconds for name, stage in timed.stages.items()}
        self.diagnostics.report("stages", True, "wall time of the last goal", **counts, **seconds)
        self.diagnostics.publish()

    def _report_goals(self, text: str) -> None:
        self.diagnostics.report("goals", True, text, **self._goals)


def outcome_to_msg(outcome: Outcome, stamp: Any) -> Any:
    """singulation_msgs/PushOutcome."""
    before = conversions.arrangement_to_msg(outcome.before)
    return PushOutcome(
        header=Header(stamp=stamp, frame_id=outcome.before.frame),
        push=conversions.push_to_msg(outcome.push, before.header),
        code=int(outcome.code),
        message=outcome.message,
        before=before,
        after=conversions.arrangement_to_msg(outcome.after),
        singulation_distance_before=outcome.distance_before,
        singulation_distance_after=outcome.distance_after,
    )


def _problem(request: Any) -> str | None:
    if not (0.0 <= request.min_gap <= 1.0):
        return f"min_gap is {request.min_gap} m, need 0 <= min_gap <= 1"
    return None


def _feedback(progress: Progress) -> Any:
    return Singulate.Feedback(
        pushes_done=len(progress.outcomes),
        singulation_distance=progress.distances[-1],
        smallest_gap=progress.gaps[-1],
    )


def _finish(handle: Any, result: SingulationResult) -> Any:
    if result.code is ResultCode.OK:
        handle.succeed()
    elif result.code is ResultCode.CANCELLED and handle.is_cancel_requested:
        handle.canceled()
    else:
        handle.abort()
    progress = result.progress
    stamp = conversions.stamp_of(0.0)
    return Singulate.Result(
        code=int(result.code),
        message=result.message,
        outcomes=[outcome_to_msg(outcome, stamp) for outcome in progress.outcomes],
        singulation_distance=progress.distances,
        smallest_gap=progress.gaps[-1] if progress.gaps else float("nan"),
    )


def main(args: list[str] | None = None) -> int:
    """Entry point of ``singulate_node``."""
    return run_node(SingulateNode, args, threads=6)
