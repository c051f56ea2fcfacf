"""Waiting for standstill, as the measured states show it."""

import numpy as np

from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.supervision.inputs import Instant, Sample
from yumi_push_executor.supervision.limits import SupervisionLimits
from yumi_push_executor.supervision.state_watch import StateWatch

_SPAN = 0.05  # s between the two positions that are compared
# s for which nothing may have moved. At the slow begin of a motion an arm hardly moves, though the order to stop has
# not reached its controller yet; it must have had the time to, on the robot's clock and on this machine's.
_QUIET = 0.1


class Settling:
    """From the order to stop until both arms are seen to stand.

    Args:
        sent: when the stop was ordered.
        believe: False if the states are known to be frozen; then only a change of them is believed.
        quiet: for how long nothing may have moved [s].
        watch: the stream of states.
        limits: of the supervision.
    """

    def __init__(
        self, sent: Instant, believe: bool, quiet: float, watch: StateWatch, limits: SupervisionLimits
    ) -> None:
        self._ordered = sent
        self._from = sent.time, sent.heard  # standstill counts from here
        self._quiet = max(quiet, _QUIET)
        self._watch = watch
        self._limits = limits
        latest = watch.latest
        self._doubted: dict[str, FloatArray] | None = None if believe or latest is None else latest.positions

    def stands(self) -> bool:
        """Whether standstill has been seen."""
        latest = self._watch.latest
        if latest is None:
            return False
        if self._doubted is not None:
            if all(np.array_equal(latest.positions[arm], self._doubted[arm]) for arm in ARMS):
                return False
            self._doubted = None
            self._from = latest.taken, latest.arrived
            return False
        earlier = self._watch.before(latest.taken - _SPAN)
        if earlier is None or self._moves(earlier, latest):
            self._from = latest.taken, latest.arrived
        stood, listened = latest.taken - self._from[0], latest.arrived - self._from[1]
        return stood >= self._quiet and listened >= _QUIET

    def _moves(self, earlier: Sample, latest: Sample) -> bool:
        way = self._limits.stopped_speed * (latest.taken - earlier.taken)
        return any(not (np.abs(latest.positions[arm] - earlier.positions[arm]).max() <= way) for arm in ARMS)

    def overdue(self, now: Instant) -> bool:
        """Whether standstill should have been seen by now."""
        passed, wall = now.time - self._ordered.time, now.wall - self._ordered.wall
        allowed = self._limits.stop_timeout + 2.0 * self._quiet
        return not (min(passed, wall) <= allowed) or not (wall <= self._limits.wall_silence)
