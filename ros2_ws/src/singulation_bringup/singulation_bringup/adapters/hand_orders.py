"""Orders to the two hands: one at a time, the newest of each hand, each with an end."""

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass

from singulation_core import InvalidInputError
from yumi_push_executor.motion.parameters import MAX_OPENING

SIDES = ("left", "right")


def finger_millimetres(opening: float) -> float:
    """What a SmartGripper is told for a jaw opening [m]: the position of one finger [mm].

    Raises:
        InvalidInputError: not finite, negative, or wider than the jaws open.
    """
    if not (math.isfinite(opening) and 0.0 <= opening <= MAX_OPENING):
        raise InvalidInputError(f"gripper: opening {opening} m, need 0 to {MAX_OPENING} m")
    return 1e3 * opening / 2.0


@dataclass(frozen=True, slots=True)
class HandOrder:
    """Where the fingers of a hand shall go [mm]."""

    side: str
    position: float


class HandOrders:
    """What is waited for and what is being carried out; both hands share one routine of the controller.

    Args:
        timeout: an order without an end is given up after this time [s].
        clock: the present [s].
    """

    def __init__(self, timeout: float, clock: Callable[[], float]) -> None:
        self._timeout, self._clock = timeout, clock
        self._lock = threading.Lock()
        self._waiting: dict[str, HandOrder] = {}
        self._current: tuple[HandOrder, float] | None = None

    def add(self, order: HandOrder) -> None:
        """A newer order replaces one of the same hand that has not begun."""
        with self._lock:
            self._waiting[order.side] = order

    def begin(self) -> HandOrder | None:
        """The next order to carry out; None while one is being carried out, or if there is none."""
        with self._lock:
            if self._current is not None or not self._waiting:
                return None
            order = self._waiting.pop(next(iter(self._waiting)))
            self._current = (order, self._clock() + self._timeout)
            return order

    def end(self, order: HandOrder) -> bool:
        """The order is done or has failed; False if it had been given up already."""
        with self._lock:
            if self._current is None or self._current[0] is not order:
                return False
            self._current = None
            return True

    def overdue(self) -> HandOrder | None:
        """The order that has just been given up because no answer came, if there is one."""
        with self._lock:
            if self._current is None or self._clock() < self._current[1]:
                return None
            order, self._current = self._current[0], None
            return order
