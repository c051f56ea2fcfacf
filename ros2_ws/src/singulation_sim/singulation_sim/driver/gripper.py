"""SmartGripper: two fingers that move alike, 25 mm each, at most 25 mm/s each (facts of ABB's RAPID module)."""

import math
from dataclasses import dataclass

from singulation_core import InvalidInputError, ResultCode, SingulationError

MAX_OPENING = 0.05  # m between the fingers
FINGER_SPEED = 0.025  # m/s
_REACHED = 1e-9  # m


@dataclass(slots=True)
class Gripper:
    """Opening of one hand; commands are ignored by an uncalibrated hand and clipped to its travel, as ABB's are.

    Args:
        opening: distance of the fingers [m].
        calibrated: whether the hand takes commands.
    """

    opening: float = 0.0
    calibrated: bool = True
    stuck: bool = False
    target: float = 0.0
    finger_velocity: float = 0.0  # m/s, of each finger

    def __post_init__(self) -> None:
        self.target = self.opening

    @property
    def finger_position(self) -> float:
        """What each finger joint reports [m]."""
        return self.opening / 2.0

    @property
    def is_moving(self) -> bool:
        """Whether the opening is not the commanded one yet and may still become it."""
        return abs(self.opening - self.target) > _REACHED and not self.stuck

    def command(self, opening: float) -> None:
        """Drive to an opening [m].

        Raises:
            SingulationError: ``INVALID_INPUT`` for no number, ``GRIPPER_NOT_CALIBRATED``.
        """
        if not math.isfinite(opening):
            raise InvalidInputError(f"gripper: opening {opening} m, need 0 to {MAX_OPENING}")
        if not self.calibrated:
            raise SingulationError(ResultCode.GRIPPER_NOT_CALIBRATED, "gripper: not calibrated, the command is ignored")
        self.target = min(max(opening, 0.0), MAX_OPENING)

    def stop(self) -> None:
        """Stay at the present opening."""
        self.target = self.opening
        self.finger_velocity = 0.0

    def step(self, period: float) -> None:
        """Move for ``period`` [s]."""
        reach = 0.0 if self.stuck else 2.0 * FINGER_SPEED * period
        change = min(max(self.target - self.opening, -reach), reach)
        self.opening += change
        self.finger_velocity = change / (2.0 * period)
