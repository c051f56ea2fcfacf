"""Whether the jaws open as ordered, and stay so while they push."""

import math

from singulation_core import ResultCode
from yumi_push_executor.supervision.faults import Fault
from yumi_push_executor.supervision.limits import SupervisionLimits

_SETTLED = 0.05  # s for which the opening must have been right


class GripperWatch:
    """Follows one order to the jaws.

    Args:
        arm: ``left`` or ``right``, for the texts.
        target: ordered opening [m].
        start: measured opening before [m].
        sent: when it was ordered, on the clock of the states [s].
        limits: of the supervision.
    """

    def __init__(self, arm: str, target: float, start: float, sent: float, limits: SupervisionLimits) -> None:
        self._arm, self._target, self._start, self._limits = arm, target, start, limits
        self._deadline = sent + abs(target - start) / limits.gripper_speed + limits.gripper_time
        self._right_since = math.inf

    def check(self, taken: float, opening: float) -> Fault | None:
        """Judge one measured opening [m]."""
        if abs(opening - self._target) <= self._limits.opening_tolerance:
            self._right_since = min(self._right_since, taken)
            return None
        self._right_since = math.inf
        if not (taken <= self._deadline):
            return Fault(
                ResultCode.GRIPPER_STUCK,
                f"the {self._arm} jaws stand at {opening * 1e3:.1f} mm and not at {self._target * 1e3:.1f} mm "
                f"{self._limits.gripper_time} s after they should have been there",
                lift=True,
            )
        return None

    def finished(self, taken: float) -> bool:
        """Whether the jaws have stood at the ordered opening for a moment."""
        return taken - self._right_since >= _SETTLED

    def fraction(self, opening: float) -> float:
        """How much of the way is done, 0..1."""
        way = abs(self._target - self._start)
        return (
            1.0 if way < self._limits.opening_tolerance else min(1.0, max(0.0, 1.0 - abs(self._target - opening) / way))
        )


def drift_fault(arm: str, ordered: float, opening: float, limits: SupervisionLimits) -> Fault | None:
    """A fault if the jaws no longer stand as ordered while the arm moves."""
    if abs(opening - ordered) <= limits.opening_drift:
        return None
    return Fault(
        ResultCode.GRIPPER_STUCK,
        f"the {arm} jaws went from {ordered * 1e3:.1f} mm to {opening * 1e3:.1f} mm during the motion, "
        f"limit {limits.opening_drift * 1e3:.1f} mm",
        lift=True,
    )
