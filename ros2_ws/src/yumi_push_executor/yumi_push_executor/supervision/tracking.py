"""Whether the arm follows the trajectory it was ordered to follow."""

import math
from collections import deque

import numpy as np

from singulation_core import ResultCode
from singulation_core.polygon import FloatArray
from yumi_push_executor.supervision.faults import Fault, Stop
from yumi_push_executor.supervision.inputs import Instant
from yumi_push_executor.supervision.limits import SupervisionLimits
from yumi_push_executor.supervision.trajectory import Trajectory

_NOTICED = 0.003  # rad; a movement larger than this is no noise
_GRID = 0.004  # s between the points of the command that a measured position is compared with
_STILL = 0.1  # share of the commanded movement below which an arm counts as not moving


class FollowingWatch:
    """Compares measured positions with the command.

    A controller starts a trajectory some time after it was sent and follows it some time behind, and its stamps come
    from another clock. So a measured position is compared with a piece of the command: from the allowed skew ahead
    of now to the longest allowed lag behind. The error is its distance to the nearest point of that piece. The latency
    of the start is learned when the arm is first seen to move.

    Args:
        arm: ``left`` or ``right``, for the texts.
        trajectory: that was ordered.
        sent: when.
        limits: of the supervision.
    """

    def __init__(self, arm: str, trajectory: Trajectory, sent: Instant, limits: SupervisionLimits) -> None:
        self.trajectory = trajectory
        self._sent = sent.time
        self._sent_heard = sent.heard
        self._arm = arm
        self._limits = limits
        self._latency: float | None = None
        self._behind = 0.0  # s between now and the point of the command that the last position matched best
        self._seen: deque[tuple[float, FloatArray]] = deque()
        self._commands = trajectory.sample(np.arange(0.0, trajectory.duration + _GRID, _GRID))[0]
        self._visible = _first_movement(self._commands)

    @property
    def begun(self) -> bool:
        """Whether the arm has been seen to move."""
        return self._latency is not None

    def elapsed(self, time: float) -> float:
        """Time on the trajectory that the controller should have reached at ``time`` [s]."""
        return time - self._sent - (self._latency or 0.0)

    def matched(self, time: float) -> float:
        """Time on the trajectory where the arm is at ``time``, by its last measured position [s]."""
        return time - self._sent - self._behind

    def check(self, taken: float, arrived: float, positions: FloatArray) -> Fault | None:
        """Judge one measured position, (7,) rad, taken and arrived at these times [s]."""
        self._remember(taken, positions)
        self._learn_latency(taken, positions)
        fault = self._late_start(taken, arrived) or self._frozen(taken)
        if fault is not None:
            return fault
        error = self._error(taken, positions)
        worst = int(error.argmax())
        if error[worst] <= self._limits.path_tolerance:
            return None
        return self._explain(taken, f"joint {worst + 1} is {error[worst]:.3f} rad away from the path")

    def finished(self, taken: float, positions: FloatArray, speed: FloatArray) -> bool:
        """Whether the arm stands at the end of the trajectory."""
        return (
            self.elapsed(taken) >= self.trajectory.duration
            and float(np.abs(positions - self.trajectory.end).max()) <= self._limits.goal_tolerance
            and float(np.abs(speed).max()) <= self._limits.stopped_speed
        )

    def overtime(self, taken: float, positions: FloatArray) -> Fault | None:
        """A fault once the end has not been reached in time."""
        waiting = not self.begun and self._visible is not None  # whether it begins at all is judged elsewhere
        if waiting or not (self.elapsed(taken) > self.trajectory.duration + self._limits.goal_time):
            return None
        missing = np.abs(positions - self.trajectory.end)
        worst = int(missing.argmax())
        return Fault(
            ResultCode.GOAL_TOLERANCE,
            f"{self._arm} joint {worst + 1} stands {missing[worst]:.4f} rad before its end "
            f"{self._limits.goal_time} s after it should be there, tolerance {self._limits.goal_tolerance} rad",
            lift=True,
        )

    def _remember(self, taken: float, positions: FloatArray) -> None:
        self._seen.append((taken, positions))
        while len(self._seen) > 2 and self._seen[1][0] <= taken - self._limits.progress_window:
            self._seen.popleft()

    def _learn_latency(self, taken: float, positions: FloatArray) -> None:
        if self._latency is None and self._visible is not None:
            moved = float(np.abs(positions - self.trajectory.start).max())
            if moved > _NOTICED:
                seen = taken - self._sent - self._visible
                self._latency = max(seen, -self._limits.clock_skew)

    def _late_start(self, taken: float, arrived: float) -> Fault | None:
        if self._visible is None or self._latency is not None:
            return None
        # As everywhere, both clocks must say so: a fast simulation on a busy machine takes long on its own clock.
        late = min(taken - self._sent - self._visible, arrived - self._sent_heard)
        if late <= self._limits.start_latency:
            return None
        text = f"the {self._arm} arm has not begun to move {self._limits.start_latency} s after it was ordered to"
        # The order may be late and not lost: what comes of it must be seen before anything else is ordered.
        quiet = 2.0 * self._limits.start_latency
        if self._unchanged():
            return Fault(ResultCode.NO_PROGRESS, f"{text}; its joint states are frozen", frozen=True, quiet=quiet)
        return Fault(ResultCode.NO_PROGRESS, text, lift=True, quiet=quiet)

    def _error(self, taken: float, positions: FloatArray) -> FloatArray:
        """(7,) distance to the nearest allowed point of the command, each joint [rad]."""
        latency = math.inf if self._latency is None else max(self._latency, 0.0)
        raw, last = taken - self._sent, len(self._commands) - 1
        first = min(int(max(raw - latency - self._limits.lag, 0.0) / _GRID), last)
        end = min(max(int((raw + self._limits.clock_skew) / _GRID), first), last)
        errors = np.abs(self._commands[first : end + 1] - positions)
        best = int(errors.max(axis=1).argmin())
        if len(self._seen) > 1 and not np.array_equal(self._seen[-2][1], positions):
            self._behind = raw - (first + best) * _GRID  # states that do not change say nothing about the arm
        return np.asarray(errors[best])

    def _unchanged(self) -> bool:
        """Encoders of a real arm are never so still that not one bit changes: the numbers are frozen, not the arm."""
        values = np.array([positions for _, positions in self._seen])
        return len(values) > 2 and not np.ptp(values, axis=0).any()

    def _frozen(self, taken: float) -> Fault | None:
        if not self.begun or not self._unchanged():
            return None
        span, commanded, _ = self._window(taken)
        if not (span >= self._limits.progress_window and commanded > _NOTICED):
            return None
        return Fault(
            ResultCode.NO_PROGRESS,
            f"the joint states of the {self._arm} arm are frozen: not one bit changed for {span:.2f} s while it was "
            f"ordered to move {commanded:.4f} rad",
            Stop.ALONG_PATH,
            frozen=True,
        )

    def _explain(self, taken: float, text: str) -> Fault:
        span, commanded, moved = self._window(taken)
        if moved < _STILL * commanded:
            ordered = f"moved {moved:.4f} rad in {span:.2f} s while it was ordered to move {commanded:.4f} rad"
            return Fault(ResultCode.NO_PROGRESS, f"the {self._arm} arm {ordered}; {text}", lift=True)
        limit = self._limits.path_tolerance
        return Fault(ResultCode.PATH_TOLERANCE, f"{self._arm} arm: {text}, limit {limit} rad", lift=True)

    def _window(self, taken: float) -> tuple[float, float, float]:
        """Length of the remembered time [s], and how far the command and the arm went in it [rad]."""
        then, before = self._seen[0]
        ordered, _ = self.trajectory.sample((self.elapsed(then), self.elapsed(taken)))
        moved = float(np.abs(self._seen[-1][1] - before).max())
        return taken - then, float(np.abs(ordered[1] - ordered[0]).max()), moved


def _first_movement(commands: FloatArray) -> float | None:
    """When the command has left its start by more than noise [s], None if it never does."""
    far = np.flatnonzero(np.abs(commands - commands[0]).max(axis=1) > _NOTICED)
    return float(far[0]) * _GRID if len(far) else None
