"""Stops of the robot controller: what is braking, backing off, standing, and when motion is allowed again."""

import math
from enum import Enum

from singulation_sim.driver.mode import DriverMode

_RUNNING = "running"


class Phase(Enum):
    """What the arms do at the moment."""

    FOLLOW = "follow the trajectories"
    COAST = "keep their velocity, the link is down"
    BRAKE = "brake"
    BACK_OFF = "go back along the path"
    STOPPED = "stand, motion is not enabled"


class SafetyController:
    """Mode, phase and text of the robot controller.

    A stop ends every trajectory. Its release (the button is pulled out, the guard closes) leaves the motors off; only a
    reset enables motion again, and then the arms hold. After a collision the controller's error handler acknowledges
    by itself after a while, as the lab's RAPID program does.
    """

    def __init__(self) -> None:
        self.mode = DriverMode.MOTORS_ON
        self.phase = Phase.FOLLOW
        self.message = _RUNNING
        self._backs_off = False
        self._until = math.inf  # the link is given up, the button released, or the collision acknowledged [s]
        self._handler_time = math.inf

    @property
    def motion_enabled(self) -> bool:
        """Whether trajectories are taken and followed, as far as the controller knows."""
        return self.phase in (Phase.FOLLOW, Phase.COAST)

    def stop(self, mode: DriverMode, message: str, until: float = math.inf) -> None:
        """Brake now; the cause goes away at ``until`` [s]."""
        self.mode, self.message, self._until = mode, message, until
        self.phase = Phase.BRAKE
        self._backs_off = False

    def collide(self, message: str, handler_time: float) -> None:
        """Brake and back off; ``handler_time`` [s] after that the error handler takes motion again."""
        self.stop(DriverMode.COLLISION_STOP, message)
        self._backs_off, self._handler_time = True, handler_time

    def lose_link(self, until: float) -> None:
        """The link to the controller is down; at ``until`` [s] it ends the session."""
        if self.phase is Phase.FOLLOW:
            self.phase, self._until = Phase.COAST, until

    def reset(self) -> None:
        """Everything released and acknowledged, motors on, motion enabled."""
        self.mode, self.phase, self.message, self._until = DriverMode.MOTORS_ON, Phase.FOLLOW, _RUNNING, math.inf

    def advance(self, now: float, finished: bool) -> None:
        """Next phase, where due.

        Args:
            now: [s].
            finished: whether all arms have finished what the present phase makes them do.
        """
        if self.phase is Phase.COAST and now >= self._until:
            self.stop(self.mode, "no data from the EGM client (41822): session ended, reset needed")
        elif self.phase is Phase.BRAKE and finished:
            self.phase = Phase.BACK_OFF if self._backs_off else Phase.STOPPED
        elif self.phase is Phase.BACK_OFF and finished:
            self.phase, self._until = Phase.STOPPED, now + self._handler_time
        elif self.phase is Phase.STOPPED and now >= self._until:
            self._release()

    def _release(self) -> None:
        self._until = math.inf
        if self.mode is DriverMode.COLLISION_STOP:
            self.reset()
            self.message = "running; the last collision was acknowledged by the error handler"
        else:
            self.message = f"{self.mode.name.lower()} released, motors off, reset needed"
            self.mode = DriverMode.MOTORS_OFF
