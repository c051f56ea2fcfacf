"""Joint states as they are reported, with what faults make of them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_sim.driver.faults import FaultBoard


@dataclass(frozen=True, eq=False)
class JointStates:
    """Positions [rad, m] and velocities [rad/s, m/s] of named joints, (joints,) each."""

    names: Sequence[str]
    positions: FloatArray
    velocities: FloatArray


class StateFaults:
    """What the outside sees of the measured states."""

    def __init__(self) -> None:
        self._last: JointStates | None = None

    def shown(self, measured: JointStates, faults: FaultBoard, now: float, frozen: bool) -> JointStates | None:
        """The states to be reported at ``now`` [s]; None for none at all.

        Args:
            measured: the true states with noise.
            faults: those present.
            now: [s].
            frozen: whether the link is down, so that the last states are repeated.
        """
        if faults.present("drop_states", now):
            return None
        if frozen or faults.present("freeze_states", now):
            self._last = self._last or measured
            return self._last
        self._last = measured
        for fault, value in (("nan_states", np.nan), ("zero_states", 0.0)):
            if faults.present(fault, now):
                filled = np.full_like(measured.positions, value)
                return replace(measured, positions=filled, velocities=filled)
        return measured
