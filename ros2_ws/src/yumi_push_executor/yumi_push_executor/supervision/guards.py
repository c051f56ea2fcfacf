"""What has to be in order at every step, whatever the arm is doing."""

from singulation_core import ResultCode
from yumi_push_executor.supervision.driver_watch import driver_fault, gripper_fault, may_lift
from yumi_push_executor.supervision.faults import Fault, Stop
from yumi_push_executor.supervision.inputs import DriverStatus, Instant
from yumi_push_executor.supervision.limits import SupervisionLimits
from yumi_push_executor.supervision.state_watch import StateWatch

_FASTEST = 100.0  # simulated seconds per second of a simulation that is believed


class Guards:
    """Driver, clocks, the stream of states and the hand.

    Args:
        watch: the stream of states.
        limits: of the supervision.
    """

    def __init__(self, watch: StateWatch, limits: SupervisionLimits) -> None:
        self._watch = watch
        self._limits = limits
        self._last = Instant(0.0, 0.0)
        self._hiccup = False  # this process did not run for a while before the present step

    def stepped(self, now: Instant) -> None:
        """A step was made."""
        self._last = now

    def fault(self, driver: DriverStatus | None, now: Instant, arm: str, *, hand: bool, retreat: bool) -> Fault | None:
        """Why the arm must stop, if so.

        Args:
            driver: its newest state.
            now: the present.
            arm: that moves.
            hand: whether the motion needs the arm's hand.
            retreat: whether this is the way back after a fault, which is allowed in more states of the driver.
        """
        if not retreat or not may_lift(driver, self._limits, now):
            fault = driver_fault(driver, self._limits, now)
            if fault is not None:
                return fault
        return self._blind_fault(now) or self._state_fault(now) or (gripper_fault(driver, arm) if hand else None)

    def _blind_fault(self, now: Instant) -> Fault | None:
        passed, wall = now.time - self._last.time, now.wall - self._last.wall
        if not (-self._limits.state_delay <= passed <= _FASTEST * wall + 1.0):
            text = f"the clock jumped by {passed:.1f} s within {wall:.2f} s of the steady clock"
            return Fault(ResultCode.TIMEOUT, text, Stop.ALONG_PATH)
        if not (min(passed, wall) <= self._limits.blind_time):
            text = f"the supervision did not run for {min(passed, wall):.2f} s, limit {self._limits.blind_time} s"
            return Fault(ResultCode.TIMEOUT, text, lift=True)
        return None

    def _state_fault(self, now: Instant) -> Fault | None:
        """States that seem old after a pause of this process may be waiting to be read: judge at the next step."""
        hiccup = min(now.time - self._last.time, now.wall - self._last.wall) > 0.5 * self._limits.state_age
        self._hiccup = hiccup and not self._hiccup
        return None if self._hiccup else self._watch.fault(now)
