"""Runs the segments of a motion one after the other and watches each."""

from collections.abc import Sequence

import numpy as np

from singulation_core import ResultCode
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.supervision.faults import Fault, Stop
from yumi_push_executor.supervision.gripper_watch import GripperWatch, drift_fault
from yumi_push_executor.supervision.holding import hold_arm
from yumi_push_executor.supervision.inputs import Instant, Sample
from yumi_push_executor.supervision.limits import SupervisionLimits
from yumi_push_executor.supervision.orders import ArmOrder, JawOrder, Order
from yumi_push_executor.supervision.segment import Phase, Segment
from yumi_push_executor.supervision.state_watch import StateWatch
from yumi_push_executor.supervision.stops import stop_along
from yumi_push_executor.supervision.tracking import FollowingWatch


class SegmentRun:
    """Orders a segment, follows it, orders the next.

    Args:
        segments: at least one.
        watch: the stream of states; it has a sample.
        limits: of the supervision.
    """

    def __init__(self, segments: Sequence[Segment], watch: StateWatch, limits: SupervisionLimits) -> None:
        self._segments = tuple(segments)
        self._watch = watch
        self._limits = limits
        self._index = -1
        self._following: FollowingWatch | None = None
        self._jaws: GripperWatch | None = None
        self._rest = dict(self._latest.positions)
        self._openings: dict[str, float] = {}  # ordered and reached, per arm
        self._fraction = 0.0

    @property
    def done(self) -> bool:
        """Whether the last segment has been finished."""
        return self._index >= len(self._segments)

    @property
    def segment(self) -> Segment:
        """The one that runs, or the last one."""
        return self._segments[min(max(self._index, 0), len(self._segments) - 1)]

    @property
    def phase(self) -> Phase:
        """What the present segment is for."""
        return self.segment.phase

    @property
    def fraction(self) -> float:
        """How much of the present segment is done, 0..1."""
        return self._fraction

    def order_next(self, now: Instant) -> list[Order]:
        """Go to the next segment."""
        self._index += 1
        self._following, self._jaws, self._fraction = None, None, 0.0
        if self.done:
            self._fraction = 1.0
            return []
        segment = self.segment
        if segment.trajectory is not None:
            self._following = FollowingWatch(segment.arm, segment.trajectory, now, self._limits)
            return [ArmOrder(segment.arm, segment.trajectory)]
        assert segment.opening is not None  # a segment has one of the two
        start = self._latest.openings.get(segment.arm, segment.opening)
        self._jaws = GripperWatch(segment.arm, segment.opening, start, now.time, self._limits)
        return [JawOrder(segment.arm, segment.opening)]

    def judge(self, sample: Sample) -> Fault | None:
        """What is wrong with one sample, if anything."""
        return self._standing_fault(sample) or self._jaw_fault(sample) or self._arm_fault(sample)

    def finishes(self, sample: Sample) -> bool:
        """Whether the present segment has ended well with this sample."""
        segment = self.segment
        if self._following is not None:
            positions = sample.positions[segment.arm]
            if self._following.finished(sample.taken, positions, self._watch.speed(segment.arm)):
                self._rest[segment.arm] = self._following.trajectory.end
                return True
        elif self._jaws is not None and segment.opening is not None and self._jaws.finished(sample.taken):
            self._openings[segment.arm] = segment.opening
            return True
        return False

    def stop_orders(self, fault: Fault, time: float) -> list[Order]:
        """Orders that bring everything to rest."""
        arms = ARMS if fault.both_arms else (self.segment.arm,)
        orders: list[Order] = []
        for arm in arms:
            if arm == self.segment.arm and self._following is not None:
                orders.append(self._stop(self._following, fault.stop, time))
            elif fault.both_arms:
                orders.append(hold_arm(arm, self._watch, self._limits))
        if self._jaws is not None:
            opening = self._latest.openings.get(self.segment.arm)
            orders += [] if opening is None else [JawOrder(self.segment.arm, opening)]
        return orders

    @property
    def _latest(self) -> Sample:
        latest = self._watch.latest
        assert latest is not None  # nothing starts without a sample, and good ones are not forgotten
        return latest

    def _stop(self, following: FollowingWatch, how: Stop, time: float) -> ArmOrder:
        if how is Stop.ALONG_PATH and following.begun:
            elapsed = following.matched(time)
            return ArmOrder(self.segment.arm, stop_along(following.trajectory, elapsed, self._limits))
        commanded, _ = following.trajectory.sample(following.elapsed(time))
        return hold_arm(self.segment.arm, self._watch, self._limits, commanded[0])

    def _arm_fault(self, sample: Sample) -> Fault | None:
        if self._following is None:
            return None
        positions = sample.positions[self.segment.arm]
        duration = max(self._following.trajectory.duration, 1e-6)
        self._fraction = min(max(self._following.elapsed(sample.taken) / duration, 0.0), 1.0)
        fault = self._following.check(sample.taken, sample.arrived, positions)
        if fault is not None or self._following.finished(sample.taken, positions, self._watch.speed(self.segment.arm)):
            return fault
        return self._following.overtime(sample.taken, positions)

    def _jaw_fault(self, sample: Sample) -> Fault | None:
        arm = self.segment.arm
        wanted = self._jaws is not None or arm in self._openings
        if not wanted:
            return None
        opening = sample.openings.get(arm, float("nan"))
        if not (opening < float("inf")):
            text = f"joint states: the {arm} gripper's opening is {opening} m"
            return Fault(ResultCode.STATE_LOST, text, Stop.ALONG_PATH)
        if self._jaws is not None:
            self._fraction = self._jaws.fraction(opening)
            return self._jaws.check(sample.taken, opening)
        return drift_fault(arm, self._openings[arm], opening, self._limits)

    def _standing_fault(self, sample: Sample) -> Fault | None:
        """An arm that has no order must stand: the plan has reckoned with where it is."""
        for arm in ARMS:
            if self._following is not None and arm == self.segment.arm:
                continue
            away = np.abs(sample.positions[arm] - self._rest[arm])
            worst = int(away.argmax())
            if not (away[worst] <= self._limits.path_tolerance):
                text = f"{arm} joint {worst + 1} moved by {away[worst]:.3f} rad though the arm was ordered to stand"
                return Fault(ResultCode.PATH_TOLERANCE, text, both_arms=True)
        return None
