"""One motion from its first order to its one outcome, as a step function without clock, threads or ROS."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from enum import Enum, auto

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.supervision.driver_watch import driver_fault, gripper_fault, may_lift
from yumi_push_executor.supervision.faults import Fault, Stop
from yumi_push_executor.supervision.holding import hold_arm
from yumi_push_executor.supervision.inputs import DriverStatus, Instant, Sample
from yumi_push_executor.supervision.limits import SupervisionLimits
from yumi_push_executor.supervision.orders import Order, Outcome, Step
from yumi_push_executor.supervision.segment import Phase, Segment, check_segments
from yumi_push_executor.supervision.segment_run import SegmentRun
from yumi_push_executor.supervision.settling import Settling
from yumi_push_executor.supervision.state_watch import StateWatch
from yumi_push_executor.supervision.trajectory import Trajectory

PlanLift = Callable[[str, FloatArray], Trajectory | None]
"""Trajectory of a retreat upwards for an arm at (7,) rad; None if it is high enough already; may refuse."""

_FASTEST = 100.0  # simulated seconds per second of a simulation that is believed


class _Stage(Enum):
    MOVING = auto()
    STOPPING = auto()
    WAITING = auto()  # for the driver to allow a retreat
    LIFTING = auto()
    ENDED = auto()


class Supervisor:
    """Executes one motion. ``start`` once, then ``step`` for every new sample and at least every ``blind_time``.

    Args:
        segments: of the motion, in order.
        watch: the stream of states; the caller adds each sample to it before it hands the sample to ``step``.
        limits: of the supervision.
        speeds: (7,) fastest joint speeds per arm [rad/s].
        plan_lift: plans the retreat after a fault.
    """

    def __init__(
        self,
        segments: Sequence[Segment],
        watch: StateWatch,
        limits: SupervisionLimits,
        speeds: dict[str, FloatArray],
        plan_lift: PlanLift,
    ) -> None:
        self._segments = tuple(segments)
        self._watch = watch
        self._limits = limits
        self._speeds = speeds
        self._plan_lift = plan_lift
        self._stage = _Stage.MOVING
        self._run: SegmentRun | None = None
        self._request: Fault | None = None
        self._fault: Fault | None = None
        self._notes: list[str] = []
        self._settling: Settling | None = None
        self._since = Instant(0.0, 0.0)  # start of the stage WAITING
        self._last = Instant(0.0, 0.0)
        self._hiccup = False  # this process did not run for a while before the present step
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
        fault = self._watch.fault(now) or driver_fault(driver, self._limits, now) or gripper_fault(driver, arm)
        if fault is not None:
            raise SingulationError(fault.code, fault.text)
        sample = self._watch.latest
        assert sample is not None  # else the watch had complained
        if arm not in sample.openings:
            raise SingulationError(ResultCode.NOT_READY, f"no joint state of the {arm} gripper has come yet")
        check_segments(self._segments, sample, self._watch.ranges, self._speeds, self._limits)
        self._run = SegmentRun(self._segments, self._watch, self._limits)
        self._last = now
        self._orders = self._run.order_next(now.time)
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
        if self._stage is _Stage.MOVING or self._stage is _Stage.LIFTING:
            self._move(fresh, driver, now)
        elif self._stage is _Stage.STOPPING:
            self._settle(now)
        elif self._stage is _Stage.WAITING:
            self._wait(driver, now)
        self._last = now
        return self._report()

    def _move(self, fresh: Sequence[Sample], driver: DriverStatus | None, now: Instant) -> None:
        run = self._running
        fault = self._request or self._common_fault(driver, now)
        for sample in fresh:
            if fault is not None:
                break
            fault = run.judge(sample)
            if fault is None and run.finishes(sample):
                self._orders += run.order_next(now.time)
                break  # later samples were taken before the next segment was ordered
        if fault is not None:
            self._stop(fault, now)
        elif run.done:
            if self._stage is _Stage.LIFTING:
                self._notes.append("retreated upwards")
            self._end(standing=True)

    def _common_fault(self, driver: DriverStatus | None, now: Instant) -> Fault | None:
        """What is wrong whatever is being done."""
        return (
            self._motion_fault(driver, now)
            or self._blind_fault(now)
            or self._state_fault(now)
            or gripper_fault(driver, self._running.segment.arm)
        )

    def _state_fault(self, now: Instant) -> Fault | None:
        """States that seem old after a pause of this process may be waiting to be read: judge at the next step."""
        hiccup = min(now.time - self._last.time, now.wall - self._last.wall) > 0.5 * self._limits.state_age
        self._hiccup = hiccup and not self._hiccup
        return None if self._hiccup else self._watch.fault(now)

    def _motion_fault(self, driver: DriverStatus | None, now: Instant) -> Fault | None:
        if self._stage is _Stage.LIFTING and may_lift(driver, self._limits, now):
            return None
        return driver_fault(driver, self._limits, now)

    def _blind_fault(self, now: Instant) -> Fault | None:
        passed, wall = now.time - self._last.time, now.wall - self._last.wall
        if not (-self._limits.state_delay <= passed <= _FASTEST * wall + 1.0):
            text = f"the clock jumped by {passed:.1f} s within {wall:.2f} s of the steady clock"
            return Fault(ResultCode.TIMEOUT, text, Stop.ALONG_PATH)
        gap = min(passed, wall)
        if not (gap <= self._limits.blind_time):
            text = f"the supervision did not run for {gap:.2f} s, limit {self._limits.blind_time} s"
            return Fault(ResultCode.TIMEOUT, text, lift=True)
        return None

    def _stop(self, fault: Fault, now: Instant) -> None:
        if self._fault is None:
            self._fault = fault
        else:
            self._notes.append(f"the retreat was stopped: {fault.text}")
            self._fault = replace(self._fault, lift=False)
        self._orders += self._running.stop_orders(fault, now.time)
        self._settling = Settling(now, not fault.frozen, self._watch, self._limits)
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
        arm, sample = self._running.segment.arm, self._watch.latest
        assert sample is not None
        try:
            trajectory = self._plan_lift(arm, sample.positions[arm])
        except SingulationError as error:
            self._notes.append(f"no retreat: {error.message}")
            trajectory = None
        if trajectory is None:
            self._end(standing=True)
            return
        self._run = SegmentRun((Segment(Phase.STOPPING, arm, trajectory),), self._watch, self._limits)
        self._orders += self._run.order_next(now.time)
        self._stage = _Stage.LIFTING

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
