"""One push at a time, from the request to its one ending; no ROS in here."""

import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from singulation_core import Arrangement, Push, ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.motion_runner import MotionRunner
from yumi_push_executor.push_gate import PushGate, Stamp
from yumi_push_executor.push_planner import PushPlanner
from yumi_push_executor.robot_view import RobotView
from yumi_push_executor.supervision import Instant, Order, Outcome, Segment, Step, SupervisionLimits, Supervisor


@dataclass(frozen=True, eq=False, slots=True)
class Ending:
    """How a push ended.

    Args:
        code: one of the result codes.
        text: why.
        reached: (3,) where the tip of the arm that pushed is now, in the table frame [m]; NaN if no arm was chosen.
        before: the arrangement that was kept clear of, None if it did not come to that.
        defect: what was thrown, if the code is ``INTERNAL``.
        planning_time: of the motion [s], NaN if none was planned.
    """

    code: ResultCode
    text: str
    reached: FloatArray
    before: Arrangement | None = None
    defect: Exception | None = None
    planning_time: float = math.nan

    @classmethod
    def failed(cls, code: ResultCode, text: str) -> "Ending":
        """It did not come to anything."""
        return cls(code, text, np.full(3, np.nan))


@dataclass(frozen=True, slots=True)
class Outside:
    """What a push needs from the node.

    Args:
        send: hands an order to its controller.
        clock: the present, on the clock of the states and the steady clock.
        ros_time: the present on the clock of the stamps [s].
        require_controllers: raises if nobody listens to an arm's orders.
    """

    send: Callable[[Order], None]
    clock: Callable[[], Instant]
    ros_time: Callable[[], float]
    require_controllers: Callable[[str], None]


class PushExecution:
    """Executes pushes one at a time.

    Args:
        view: of the robot.
        gate: says which pushes are fresh.
        planner: of motions.
        outside: the node.
    """

    def __init__(self, view: RobotView, gate: PushGate, planner: PushPlanner, outside: Outside) -> None:
        self._view, self._gate, self._planner, self._outside = view, gate, planner, outside
        self._busy = threading.Lock()
        self._runner: MotionRunner | None = None
        self.idle = threading.Event()
        self.idle.set()

    def execute(
        self,
        read: Callable[[], tuple[Push, Stamp]],
        limits: SupervisionLimits,
        cancelled: Callable[[], bool],
        on_step: Callable[[Step], None],
    ) -> Ending:
        """Plan and run one push. Never raises: whatever happens ends in a code.

        Args:
            read: the push and the stamp of the arrangement it was planned on; may refuse.
            limits: of the supervision.
            cancelled: whether the client has cancelled.
            on_step: hears of every step.
        """
        if not self._busy.acquire(blocking=False):
            return Ending.failed(ResultCode.BUSY, "another push is being executed; wait for its result")
        self.idle.clear()
        attempt = _Attempt()
        try:
            self._runner = MotionRunner(self._view, limits, self._outside.send, self._outside.clock, cancelled)
            outcome = self._serve(attempt, read, limits, self._runner, on_step)
            return self._ending(attempt, outcome.code, outcome.text)
        except SingulationError as error:
            return self._ending(attempt, error.code, error.message)
        except Exception as error:
            return self._ending(attempt, ResultCode.INTERNAL, f"{type(error).__name__}: {error}", error)
        finally:
            self._runner = None
            self.idle.set()
            self._busy.release()

    def halt(self, reason: str) -> bool:
        """Stop a push that is being executed; whether there was one."""
        runner = self._runner
        if runner is None:
            return False
        runner.halt(reason)
        return True

    def abandon(self) -> None:
        """Do not wait for standstill any longer."""
        runner = self._runner
        if runner is not None:
            runner.abandon()

    def _serve(
        self,
        attempt: "_Attempt",
        read: Callable[[], tuple[Push, Stamp]],
        limits: SupervisionLimits,
        runner: MotionRunner,
        on_step: Callable[[Step], None],
    ) -> Outcome:
        with self._view.lock:
            self._view.watch.limits = limits
        push, stamp = read()
        attempt.before = self._gate.require_fresh(stamp, self._outside.ros_time())
        started = time.perf_counter()
        segments = self._plan(push, attempt.before)
        attempt.planning_time = time.perf_counter() - started
        attempt.arm = segments[0].arm
        self._outside.require_controllers(attempt.arm)
        supervisor = Supervisor(segments, self._view.watch, limits, self._planner.speeds, self._planner.lift)
        try:
            return runner.run(supervisor, on_step)
        finally:
            if runner.moved:
                self._gate.moved(self._outside.ros_time())

    def _plan(self, push: Push, arrangement: Arrangement) -> tuple[Segment, ...]:
        with self._view.lock:
            fault, sample = self._view.watch.fault(self._outside.clock()), self._view.watch.latest
        if fault is not None or sample is None:
            raise (
                SingulationError(fault.code, fault.text)
                if fault
                else SingulationError(ResultCode.NOT_READY, "no joint state has come yet")
            )
        return self._planner.plan(push, arrangement, sample)

    def _ending(self, attempt: "_Attempt", code: ResultCode, text: str, defect: Exception | None = None) -> Ending:
        with self._view.lock:
            sample = self._view.watch.latest
        reached = np.full(3, np.nan)
        if sample is not None and attempt.arm:
            reached = self._planner.tip(attempt.arm, sample.positions[attempt.arm])
        return Ending(code, text, reached, attempt.before, defect, attempt.planning_time)


@dataclass(slots=True)
class _Attempt:
    """What became known on the way, for the ending."""

    arm: str = ""
    planning_time: float = math.nan
    before: Arrangement | None = None
