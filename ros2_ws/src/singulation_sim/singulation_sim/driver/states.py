"""Joint states as they are reported."""

from collections.abc import Sequence
from dataclasses import dataclass

from singulation_core.polygon import FloatArray


@dataclass(frozen=True, eq=False)
class JointStates:
    """Positions [rad, m] and velocities [rad/s, m/s] of named joints, (joints,) each."""

    names: Sequence[str]
    positions: FloatArray
    velocities: FloatArray
