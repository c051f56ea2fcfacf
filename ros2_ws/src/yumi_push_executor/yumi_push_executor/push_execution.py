"""One push at a time, from the request to its one ending; no ROS in here."""

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from singulation_core import Arrangement, Push, ResultCode, SingulationError
from yumi_push_executor.ending import Attempt, Ending
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.motion_runner import MotionRunner
from yumi_push_executor.push_gate import PushGate, Stamp
from yumi_push_executor.push_planner import PushPlanner
from yumi_push_executor.robot_view import RobotView
from yumi_push_executor.supervision import (
    Instant,
    Order,
    Outcome,
    Phase,
    Sample,
    Segment,
    Step,
    SupervisionLimits,
    Supervisor,
)


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

        def serve(attempt: Attempt, runner: MotionRunner) -> Outcome:
            push, stamp = read()
            attempt.before = self._gate.require_fresh(stamp, self._outside.ros_time())
            started = time.perf_counter()
            segments = self._planner.plan(push, attempt.before, self._sample())
            attempt.planning_time = time.perf_counter() - started
            return self._run(segments, attempt, runner, limits, on_step)

        return self._one_at_a_time(serve, limits, cancelled)

    def clear_view(self, limits: SupervisionLimits) -> Ending:
        """Bring arms that stand in the camera's view out of it, one after the other. Never raises."""

        def serve(attempt: Attempt, runner: MotionRunner) -> Outcome:
            attempt.before = self._gate.newest()
            outcome = Outcome(ResultCode.OK, "no arm is in the camera's view", standing=True)
            for arm in ARMS:
                way = self._planner.clear_view(arm, self._sample(), attempt.before)
                if way is None:
                    continue
                segment = Segment(Phase.CLEAR_VIEW, arm, trajectory=way)
                outcome = self._run((segment,), attempt, runner, limits, lambda _: None)
                if outcome.code is not ResultCode.OK:
                    break
            return outcome

        return self._one_at_a_time(serve, limits, lambda: False)

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

    def _one_at_a_time(
        self,
        serve: Callable[[Attempt, MotionRunner], Outcome],
        limits: SupervisionLimits,
        cancelled: Callable[[], bool],
    ) -> Ending:
        if not self._busy.acquire(blocking=False):
            return Ending.failed(ResultCode.BUSY, "another motion is being executed; wait for its end")
        self.idle.clear()
        attempt = Attempt()
        try:
            with self._view.lock:
                self._view.watch.limits = limits
            self._runner = MotionRunner(self._view, limits, self._outside.send, self._outside.clock, cancelled)
            outcome = serve(attempt, self._runner)
            return self._ending(attempt, outcome.code, outcome.text)
        except SingulationError as error:
            return self._ending(attempt, error.code, error.message)
        except Exception as error:
            return self._ending(attempt, ResultCode.INTERNAL, f"{type(error).__name__}: {error}", error)
        finally:
            self._runner = None
            self.idle.set()
            self._busy.release()

    def _run(
        self,
        segments: Sequence[Segment],
        attempt: Attempt,
        runner: MotionRunner,
        limits: SupervisionLimits,
        on_step: Callable[[Step], None],
    ) -> Outcome:
        attempt.arm, blocks = segments[0].arm, attempt.before or Arrangement(())
        self._outside.require_controllers(attempt.arm)
        planner = self._planner
        supervisor = Supervisor(
            segments,
            self._view.watch,
            limits,
            planner.speeds,
            planner.lift,
            lambda arm, _: planner.clear_view(arm, self._sample(), blocks),
        )
        try:
            return runner.run(supervisor, on_step)
        finally:
            if runner.moved:
                self._gate.moved(self._outside.ros_time())

    def _sample(self) -> Sample:
        """Where the arms are now."""
        with self._view.lock:
            fault, sample = self._view.watch.fault(self._outside.clock()), self._view.watch.latest
        if fault is not None:
            raise SingulationError(fault.code, fault.text)
        assert sample is not None  # else the watch had complained
        return sample

    def _ending(self, attempt: Attempt, code: ResultCode, text: str, defect: Exception | None = None) -> Ending:
        with self._view.lock:
            sample = self._view.watch.latest
        reached = np.full(3, np.nan)
        if sample is not None and attempt.arm:
            reached = self._planner.tip(attempt.arm, sample.positions[attempt.arm])
        return Ending(code, text, reached, attempt.before, defect, attempt.planning_time)
