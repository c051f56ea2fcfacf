"""Whether joint states come, come in time, and can be real."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from singulation_core import ResultCode
from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import ARMS, JOINTS
from yumi_push_executor.supervision.faults import Fault, Stop
from yumi_push_executor.supervision.inputs import Instant, Sample
from yumi_push_executor.supervision.limits import SupervisionLimits

_SPAN = 0.5  # s of states that are kept
_BEYOND_RANGE = 0.1  # rad; encoders do not read further outside the mechanical range
_CLOCK_RESTART = 1.0  # s; a stamp this far back means a new clock, not a late message
_SPEED_SPAN = 0.03  # s over which speeds are measured where the driver reports none


@dataclass(frozen=True, slots=True)
class JointRange:
    """Lower and upper limits of one arm's joints, (7,) rad each."""

    lower: FloatArray
    upper: FloatArray


class StateWatch:
    """Keeps the last half second of good samples and says what is wrong with the stream.

    Args:
        limits: of the supervision.
        ranges: joint range per arm.
    """

    def __init__(self, limits: SupervisionLimits, ranges: dict[str, JointRange]) -> None:
        self.limits = limits
        self.ranges = ranges
        self._good: deque[Sample] = deque()
        self._problem = ""  # of the newest sample, if it cannot be real
        self._delay = ""  # why the newest sample was not taken in time
        self.refused = 0  # samples out of order, too late, or not real

    @property
    def latest(self) -> Sample | None:
        """Newest good sample."""
        return self._good[-1] if self._good else None

    def add(self, sample: Sample, now: Instant) -> bool:
        """Take a sample; whether it was good."""
        latest = self.latest
        if latest is not None and sample.taken < latest.taken - _CLOCK_RESTART:
            self._good.clear()
            latest = None
        # A late sample is no more than a missing one: a hiccup of this machine must not end a motion, silence will.
        self._delay = self._delay_problem(sample, now)
        if latest is not None and sample.taken <= latest.taken:
            self.refused += 1
            return False
        self._problem = "" if self._delay else sample_problem(sample, self.ranges)
        if self._delay or self._problem:
            self.refused += 1
            return False
        self._good.append(sample)
        while self._good[0].taken < sample.taken - _SPAN:
            self._good.popleft()
        return True

    def fault(self, now: Instant) -> Fault | None:
        """Why the stream cannot be relied on, if so."""
        latest = self.latest
        if latest is None:
            text = self._problem or self._delay or "no joint state has come yet"
            return Fault(ResultCode.NOT_READY, text, Stop.ALONG_PATH)
        if self._problem:
            return Fault(ResultCode.STATE_LOST, self._problem, Stop.ALONG_PATH)
        silent, age = now.heard - latest.arrived, now.time - latest.taken
        if not (min(silent, age) <= self.limits.state_age) or not (silent <= self.limits.wall_silence):
            text = (
                f"the last good joint state is {max(age, 0.0):.2f} s old and came {silent:.2f} s ago, limit "
                f"{self.limits.state_age} s"
            )
            return Fault(ResultCode.STATE_LOST, "; ".join(filter(None, (text, self._delay))), Stop.ALONG_PATH)
        return None

    def speed(self, arm: str) -> FloatArray:
        """(7,) joint speeds of the newest good sample [rad/s], NaN if they are not known."""
        latest = self.latest
        if latest is None or arm not in latest.positions:
            return np.full(JOINTS, np.nan)
        if arm in latest.velocities:
            return latest.velocities[arm]
        earlier = self.before(latest.taken - _SPEED_SPAN)
        if earlier is None:
            return np.full(JOINTS, np.nan)
        return np.asarray((latest.positions[arm] - earlier.positions[arm]) / (latest.taken - earlier.taken))

    def before(self, time: float) -> Sample | None:
        """Newest kept sample taken at ``time`` or earlier."""
        return next((sample for sample in reversed(self._good) if sample.taken <= time), None)

    def _delay_problem(self, sample: Sample, now: Instant) -> str:
        delay = now.time - sample.taken
        if abs(delay) <= self.limits.state_delay:
            return ""
        side = "before" if delay > 0.0 else "after"
        return f"joint states are stamped {abs(delay):.2f} s {side} they arrive, limit {self.limits.state_delay} s"


def sample_problem(sample: Sample, ranges: dict[str, JointRange]) -> str:
    """Why a sample cannot be real, "" if it can."""
    for arm in ARMS:
        if arm not in sample.positions:
            return f"joint states lack the {arm} arm"
        positions = sample.positions[arm]
        bad = np.flatnonzero(~np.isfinite(positions))
        if len(bad):
            return f"joint states: {arm} joint {bad[0] + 1} is {positions[bad[0]]}"
        if not positions.any():
            return f"joint states: all joints of the {arm} arm are exactly 0, as before a driver has read the robot"
        outside = np.maximum(ranges[arm].lower - positions, positions - ranges[arm].upper)
        worst = int(outside.argmax())
        if not (outside[worst] <= _BEYOND_RANGE):
            return (
                f"joint states: {arm} joint {worst + 1} at {positions[worst]:.3f} rad lies {outside[worst]:.3f} rad "
                "outside its range"
            )
    return ""
