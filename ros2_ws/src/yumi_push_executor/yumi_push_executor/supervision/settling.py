"""Waiting for standstill, as the measured states show it."""

import numpy as np

from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.supervision.inputs import Instant
from yumi_push_executor.supervision.limits import SupervisionLimits
from yumi_push_executor.supervision.state_watch import StateWatch

_SPAN = 0.05  # s for which nothing may have moved


class Settling:
    """From the order to stop until both arms are seen to stand.

    Args:
        sent: when the stop was ordered.
        believe: False if the states are known to be frozen; then only a change of them is believed.
        watch: the stream of states.
        limits: of the supervision.
    """

    def __init__(self, sent: Instant, believe: bool, watch: StateWatch, limits: SupervisionLimits) -> None:
        self._ordered = sent
        self._from = sent.time  # standstill counts from here
        self._watch = watch
        self._limits = limits
        latest = watch.latest
        self._doubted: dict[str, FloatArray] | None = None if believe or latest is None else latest.positions

    def stands(self) -> bool:
        """Whether standstill has been seen."""
        latest = self._watch.latest
        if latest is None or latest.taken - self._from < _SPAN:
            return False
        if self._doubted is not None:
            if all(np.array_equal(latest.positions[arm], self._doubted[arm]) for arm in ARMS):
                return False
            self._doubted = None
            self._from = latest.taken
            return False
        earlier = self._watch.before(latest.taken - _SPAN)
        if earlier is None:
            return False
        way = self._limits.stopped_speed * (latest.taken - earlier.taken)
        return all(float(np.abs(latest.positions[arm] - earlier.positions[arm]).max()) <= way for arm in ARMS)

    def overdue(self, now: Instant) -> bool:
        """Whether standstill should have been seen by now."""
        passed, wall = now.time - self._ordered.time, now.wall - self._ordered.wall
        return not (min(passed, wall) <= self._limits.stop_timeout) or not (wall <= self._limits.wall_silence)
