"""The loop that runs one supervised motion: waits for states, steps the supervisor, sends its orders."""

from collections.abc import Callable
from contextlib import ExitStack

from singulation_core import ResultCode, SingulationError
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.robot_view import RobotView
from yumi_push_executor.supervision import Instant, Order, Outcome, Step, SupervisionLimits, Supervisor, hold_arm

_PERIOD = 0.02  # s between two steps if no state arrives


class MotionRunner:
    """Runs one motion in the calling thread; ``halt`` and ``abandon`` may come from any thread, any time.

    Args:
        view: of the robot.
        limits: of the supervision.
        send: hands an order to its controller.
        clock: the present.
        cancelled: whether the client has cancelled; asked at every step.
    """

    def __init__(
        self,
        view: RobotView,
        limits: SupervisionLimits,
        send: Callable[[Order], None],
        clock: Callable[[], Instant],
        cancelled: Callable[[], bool],
    ) -> None:
        self._view = view
        self._limits = limits
        self._send = send
        self._clock = clock
        self._halt_reason = ""
        self._cancelled = cancelled
        self._abandoned = False
        self.moved = False  # whether anything has been ordered

    def halt(self, reason: str) -> None:
        """Stop both arms, stay there."""
        self._halt_reason = reason
        self._view.wake()

    def abandon(self) -> None:
        """Wait for standstill no longer: nothing will be heard of the robot any more."""
        self._abandoned = True
        self._view.wake()

    def stopped_early(self) -> Outcome | None:
        """The outcome if it was cancelled or halted before anything moved."""
        if self._halt_reason:
            return Outcome(ResultCode.HALTED, f"{self._halt_reason}; nothing had moved yet", standing=True)
        if self._cancelled():
            return Outcome(ResultCode.CANCELLED, "cancelled by the client; nothing had moved yet", standing=True)
        return None

    def run(self, supervisor: Supervisor, on_step: Callable[[Step], None]) -> Outcome:
        """Until the motion has ended; ``on_step`` hears of every step.

        Raises:
            SingulationError: it was refused and nothing was ordered.
        """
        self._view.take()  # what came before the start is no progress of this motion
        early = self.stopped_early()
        if early is not None:
            return early
        with self._view.lock:
            step = supervisor.start(self._view.driver, self._clock())
            self.moved = True
            self._send_all(step)
        with ExitStack() as left_by_a_defect:
            left_by_a_defect.callback(self._hold_both)
            outcome = self._follow(supervisor, on_step)
            left_by_a_defect.pop_all()
        return outcome

    def _follow(self, supervisor: Supervisor, on_step: Callable[[Step], None]) -> Outcome:
        while True:
            self._view.wait(_PERIOD)
            with self._view.lock:
                self._pass_on_requests(supervisor)
                step = supervisor.step(self._view.take(), self._view.driver, self._clock())
                self._send_all(step)
            on_step(step)
            if step.outcome is not None:
                return step.outcome
            if self._abandoned:
                return Outcome(ResultCode.HALTED, f"{self._halt_reason}; standstill was not seen", standing=False)

    def _pass_on_requests(self, supervisor: Supervisor) -> None:
        if self._halt_reason:
            supervisor.halt(self._halt_reason)
        elif self._cancelled():
            supervisor.cancel()

    def _send_all(self, step: Step) -> None:
        for order in step.orders:
            self._send(order)

    def _hold_both(self) -> None:
        """After a defect of ours: whatever was ordered, end it."""
        for arm in ARMS:
            try:
                with self._view.lock:
                    self._send(hold_arm(arm, self._view.watch, self._limits))
            except SingulationError:
                continue
