"""What the supervision sees: the time, measured states and the state of the driver."""

import math
from dataclasses import dataclass, field
from enum import IntEnum

from singulation_core.polygon import FloatArray


@dataclass(frozen=True, slots=True)
class Instant:
    """One moment on three clocks [s].

    Args:
        time: the clock of states and trajectories; simulated time under ``use_sim_time``, else the steady clock.
        wall: the steady clock of this machine.
        listened: the steady clock without the times in which this process could not have heard anything, because the
            machine had no time for it; ``wall`` if NaN. Whoever is silent is silent on this clock.
    """

    time: float
    wall: float
    listened: float = math.nan

    @property
    def heard(self) -> float:
        """``listened`` if it is known, else ``wall`` [s]."""
        return self.wall if math.isnan(self.listened) else self.listened


@dataclass(frozen=True, eq=False, slots=True)
class Sample:
    """Joint states of one moment.

    Args:
        taken: when they were measured, by their stamp.
        arrived: when it was heard, see ``Instant.heard`` [s].
        positions: (7,) rad per arm, kinematic order; an arm that is not reported is missing.
        velocities: (7,) rad/s per arm; missing if not reported.
        openings: jaw opening per arm [m]; missing if not reported.
    """

    taken: float
    arrived: float
    positions: dict[str, FloatArray]
    velocities: dict[str, FloatArray] = field(default_factory=dict)
    openings: dict[str, float] = field(default_factory=dict)


class DriverMode(IntEnum):
    """Values are those of ``singulation_msgs/msg/DriverState``."""

    MOTORS_OFF = 0
    MOTORS_ON = 1
    GUARD_STOP = 2
    EMERGENCY_STOP = 3
    COLLISION_STOP = 4
    SYSTEM_FAILURE = 5


@dataclass(frozen=True, slots=True)
class DriverStatus:
    """What the robot's controller says of itself.

    Args:
        mode: of the controller.
        motion_enabled: whether it follows trajectories now.
        calibrated: per arm, whether its gripper is.
        message: the driver's own words.
        seen: when it arrived.
    """

    mode: DriverMode
    motion_enabled: bool
    calibrated: dict[str, bool]
    message: str
    seen: Instant
