"""One motion from its first order to its one outcome, as a step function without clock, threads or ROS."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from enum import Enum, auto

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.supervision.driver_watch import driver_fault, gripper_fault, may_lift
from yumi_push_executor.supervision.faults import Fault, Stop
from yumi_push_executor.supervision.guards import Guards
from yumi_push_executor.supervision.holding import hold_arm
from yumi_push_executor.supervision.inputs import DriverStatus, Instant, Sample
from yumi_push_executor.supervision.limits import SupervisionLimits
from yumi_push_executor.supervision.orders import Order, Outcome, Step
from yumi_push_executor.supervision.segment import Phase, Segment, check_segments
from yumi_push_executor.supervision.segment_run import SegmentRun
from yumi_push_executor.supervision.settling import Settling
from yumi_push_executor.supervision.state_watch import StateWatch
from yumi_push_executor.supervision.trajectory import Trajectory

PlanRetreat = Callable[[str, FloatArray], Trajectory | None]
"""Trajectory for an arm at (7,) rad; None if it stands well already; may refuse."""


class _Stage(Enum):
    MOVING = auto()
    STOPPING = auto()
    WAITING = auto()  # for the driver to allow a retreat
    LIFTING = auto()
    CLEARING = auto()  # on the way out of the camera's view
    ENDED = auto()


class Supervisor:
    """Executes one motion. ``start`` once, then ``step`` for every new sample and at least every ``blind_time``.

    Args:
        segments: of the motion, in order.
        watch: the stream of states; the caller adds each sample to it before it hands the sample to ``step``.
        limits: of the supervision.
        speeds: (7,) fastest joint speeds per arm [rad/s].
        plan_lift: plans the retreat upwards after a fault.
        plan_clear: plans the way out of the camera's view after that; None leaves the arm where it is, so that nothing
            behind it is seen.
    """

    def __init__(
        self,
        segments: Sequence[Segment],
        watch: StateWatch,
        limits: SupervisionLimits,
        speeds: dict[str, FloatArray],
        plan_lift: PlanRetreat,
        plan_clear: PlanRetreat | None = None,
    ) -> None:
        self._segments = tuple(segments)
        self._needs_hand = any(segment.opening is not None for segment in self._segments)
        self._watch = watch
        self._limits = limits
        self._speeds = speeds
        self._plan_lift, self._plan_clear = plan_lift, plan_clear
        self._stage = _Stage.MOVING
        self._run: SegmentRun | None = None
        self._request: Fault | None = None
        self._fault: Fault | None = None
        self._notes: list[str] = []
        self._settling: Settling | None = None
        self._since = Instant(0.0, 0.0)  # start of the stage WAITING
        self._guards = Guards(watch, limits)
        self._orders: list[Order] = []
        self._outcome: Outcome | None = None

    def start(self, driver: DriverStatus | None, now: Instant) -> Step:
        """Check everything, then order the first segment.

        Raises:
            SingulationError: nothing was ordered; the code says why.
        """
        if not self._segments:
            raise InvalidInputError("motion: it has no segments")
        arm = self._segments[0].arm
        fault = self._watch.fault(now) or driver_fault(driver, self._limits, now)
        if fault is None and self._needs_hand:
            fault = gripper_fault(driver, arm)
        if fault is not None:
            raise SingulationError(fault.code, fault.text)
        sample = self._watch.latest
        assert sample is not None  # else the watch had complained
        if self._needs_hand and arm not in sample.openings:
            raise SingulationError(ResultCode.NOT_READY, f"no joint state of the {arm} gripper has come yet")
        check_segments(self._segments, sample, self._watch.ranges, self._speeds, self._limits)
        self._run = SegmentRun(self._segments, self._watch, self._limits)
        self._guards.stepped(now)
        self._orders = self._run.order_next(now)
        return self._report()

    def cancel(self) -> None:
        """Stop on the path and stay there; the client asked for it."""
        self._request = self._request or Fault(ResultCode.CANCELLED, "cancelled by the client", Stop.ALONG_PATH)

    def halt(self, reason: str) -> None:
        """Stop on the path and stay there, both arms."""
        self._request = Fault(ResultCode.HALTED, reason, Stop.ALONG_PATH, both_arms=True)

    def step(self, fresh: Sequence[Sample], driver: DriverStatus | None, now: Instant) -> Step:
        """Go on.

        Args:
            fresh: good samples that came since the last step, oldest first.
            driver: its newest state.
            now: the present.
        """
        self._orders = []
        if self._stage in (_Stage.MOVING, _Stage.LIFTING, _Stage.CLEARING):
            self._move(fresh, driver, now)
        elif self._stage is _Stage.STOPPING:
            self._settle(now)
        elif self._stage is _Stage.WAITING:
            self._wait(driver, now)
        self._guards.stepped(now)
        return self._report()

    def _move(self, fresh: Sequence[Sample], driver: DriverStatus | None, now: Instant) -> None:
        run = self._running
        moving = self._stage is _Stage.MOVING
        fault = self._request or self._guards.fault(
            driver, now, run.segment.arm, hand=moving and self._needs_hand, retreat=not moving
        )
        for sample in fresh:
            if fault is not None:
                break
            fault = run.judge(sample)
            if fault is None and run.finishes(sample):
                self._orders += run.order_next(now)
                break  # later samples were taken before the next segment was ordered
        if fault is not None:
            self._stop(fault, now)
        elif run.done:
            self._finish_run(now)

    def _stop(self, fault: Fault, now: Instant) -> None:
        if self._fault is None:
            self._fault = fault
        else:
            self._notes.append(f"the retreat was stopped: {fault.text}")
            self._fault = replace(self._fault, lift=False)
        self._orders += self._running.stop_orders(fault, now.time)
        self._settling = Settling(now, not fault.frozen, fault.quiet, self._watch, self._limits)
        self._stage = _Stage.STOPPING

    def _settle(self, now: Instant) -> None:
        settling, fault = self._settling, self._fault
        assert settling is not None and fault is not None  # the stage STOPPING begins with both
        if settling.stands():
            if fault.code in (ResultCode.SAFETY_STOP, ResultCode.COLLISION_STOP):
                # The arm coasted or backed off: whatever held a command must not go back to it when motors return.
                self._orders += [hold_arm(arm, self._watch, self._limits) for arm in ARMS]
            self._stage, self._since = _Stage.WAITING, now
        elif settling.overdue(now):
            self._notes.append(f"standstill was not seen within {self._limits.stop_timeout} s")
            self._end(standing=False)

    def _wait(self, driver: DriverStatus | None, now: Instant) -> None:
        """Standing still after a fault: retreat if that is wanted, possible and allowed."""
        fault = self._fault
        assert fault is not None
        if not fault.lift or self._request is not None:
            self._end(standing=True)
        elif may_lift(driver, self._limits, now) and self._watch.fault(now) is None:
            self._lift(now)
        elif fault.code is not ResultCode.COLLISION_STOP or now.time - self._since.time > self._limits.lift_wait:
            self._notes.append("the driver does not allow a retreat")
            self._end(standing=True)

    def _lift(self, now: Instant) -> None:
        if not self._retreat(self._plan_lift, _Stage.LIFTING, "no retreat", now):
            self._clear(now)

    def _clear(self, now: Instant) -> None:
        if self._plan_clear is None or not self._retreat(self._plan_clear, _Stage.CLEARING, "it stays in view", now):
            self._end(standing=True)

    def _finish_run(self, now: Instant) -> None:
        """The last segment of a motion or of a retreat has ended well."""
        if self._stage is _Stage.LIFTING:
            self._notes.append("retreated upwards")
            self._clear(now)
            return
        if self._stage is _Stage.CLEARING:
            self._notes.append("left the camera's view")
        self._end(standing=True)

    def _retreat(self, plan: PlanRetreat, stage: _Stage, without: str, now: Instant) -> bool:
        """Whether a part of the retreat has been ordered."""
        arm, sample = self._running.segment.arm, self._watch.latest
        assert sample is not None
        try:
            trajectory = plan(arm, sample.positions[arm])
        except SingulationError as error:
            self._notes.append(f"{without}: {error.message}")
            return False
        if trajectory is None:
            return False
        self._run = SegmentRun((Segment(Phase.STOPPING, arm, trajectory),), self._watch, self._limits)
        self._orders += self._run.order_next(now)
        self._stage = stage
        return True

    def _end(self, standing: bool) -> None:
        self._stage = _Stage.ENDED
        if self._fault is None:
            self._outcome = Outcome(ResultCode.OK, "done", standing)
            return
        code = self._fault.code
        if code is ResultCode.CANCELLED and not standing:
            code = ResultCode.TIMEOUT  # CANCELLED is a promise that everything stands
        self._outcome = Outcome(code, "; ".join([self._fault.text, *self._notes]), standing)

    @property
    def _running(self) -> SegmentRun:
        assert self._run is not None  # start() has been called
        return self._run

    def _report(self) -> Step:
        moving = self._stage is _Stage.MOVING or self._fault is None
        phase = self._running.phase if moving else Phase.STOPPING
        return Step(tuple(self._orders), phase, self._running.fraction if moving else 0.0, self._outcome)
