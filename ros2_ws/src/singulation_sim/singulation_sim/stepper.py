"""A thread that lets simulated time pass as fast as it should, or as fast as it can."""

import threading
import time
from collections.abc import Callable

from singulation_sim.cell import SimulatedCell
from singulation_sim.driver import PERIOD

_BACKLOG = 0.1  # s of real time; what is left undone beyond it is not made up for
_SUSPENDED = 5.0  # s of real time; a machine that was away so long has slept


class Stepper:
    """Steps a cell and tells after each interval.

    With own time, an overloaded machine makes simulated time pass more slowly. Without, simulated time is the time of
    the wall and is made up for, unless the machine slept.

    Args:
        cell: only touched with ``lock`` held.
        lock: notified after each interval.
        interval: simulated time between two calls of ``tell`` [s].
        speed: simulated seconds per second.
        own_time: see above.
        tell: called without the lock, with whether anything moved in the interval.
        clock: real time [s].
    """

    def __init__(
        self,
        cell: SimulatedCell,
        lock: threading.Condition,
        *,
        interval: float,
        speed: float,
        own_time: bool,
        tell: Callable[[bool], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._cell, self._lock, self._tell, self._clock = cell, lock, tell, clock
        self._interval, self._speed, self._own_time = interval, speed, own_time
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="simulation", daemon=True)
        self._start = cell.now
        self._elapsed = 0.0
        self.behind = 0.0  # s of real time by which the last interval came late

    def start(self) -> None:
        """Let time pass from now on."""
        self._thread.start()

    def stop(self) -> None:
        """Stop time; whoever waits for it is woken."""
        self._stop.set()
        with self._lock:
            self._lock.notify_all()
        if self._thread.ident is not None and self._thread is not threading.current_thread():
            self._thread.join(timeout=5.0)

    @property
    def stopped(self) -> bool:
        """Whether time was stopped for good."""
        return self._stop.is_set()

    def wait_for(self, moment: float, timeout: float) -> bool:
        """Wait with the lock held until simulated time has reached ``moment`` [s]; False if it did not come."""
        reached = self._lock.wait_for(lambda: self._cell.now >= moment or self.stopped, timeout)
        return reached and not self.stopped

    def _run(self) -> None:
        origin = self._clock()
        while not self.stopped:
            self._elapsed += self._interval
            due = origin + self._elapsed / self._speed
            late = self._clock() - due
            self.behind = max(late, 0.0)
            if late < 0.0:
                self._stop.wait(-late)
            elif late > (_BACKLOG if self._own_time else _SUSPENDED):
                origin += late
                self._jump(late)
            self._tell(self._advance())

    def _advance(self) -> bool:
        moved = False
        with self._lock:
            target = self._start + self._elapsed
            while self._cell.now + 0.5 * PERIOD < target:
                moved |= self._cell.step()
            self._lock.notify_all()
        return moved

    def _jump(self, late: float) -> None:
        """Without own time the cell's clock has to stay with the wall's."""
        if not self._own_time:
            with self._lock:
                self._cell.driver.now += late
                self._start += late
