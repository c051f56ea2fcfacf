"""What is known of the robot at the moment, shared between the threads of a node."""

import threading
import time
from collections import deque
from collections.abc import Callable, Sequence

from singulation_core import InvalidInputError
from yumi_push_executor.supervision import DriverStatus, Instant, JointRange, Sample, StateWatch, SupervisionLimits
from yumi_push_executor.wire import JointNames, StateReader

TICK = 0.02  # s
_QUEUE = 500  # samples; two seconds at 250 Hz, more than any gap the supervision allows


class RobotView:
    """Joint states and driver state as they arrive; a motion takes them from here.

    Args:
        names: of the joints on the wire.
        ranges: joint range per arm.
        limits: of the supervision.
        clock: the present.
    """

    def __init__(
        self,
        names: JointNames,
        ranges: dict[str, JointRange],
        limits: SupervisionLimits,
        clock: Callable[[], Instant],
    ) -> None:
        self.lock = threading.RLock()  # whoever steps a supervisor on ``watch`` holds it
        self.watch = StateWatch(limits, ranges)
        self.driver: DriverStatus | None = None
        self.messages = 0
        self._ticked = time.monotonic()
        self._listened = 0.0
        self._reader = StateReader(names, limits.state_age)
        self._clock = clock
        self._fresh: deque[Sample] = deque(maxlen=_QUEUE)
        self._arrival = threading.Event()

    def add_states(
        self, names: Sequence[str], positions: Sequence[float], velocities: Sequence[float], delay: float
    ) -> None:
        """Take a message of joint states that is ``delay`` [s] old by its stamp.

        Raises:
            InvalidInputError: malformed; it is counted and changes nothing.
        """
        with self.lock:
            now = self._clock()
            self.messages += 1
            try:
                sample = self._reader.read(names, positions, velocities, taken=now.time - delay, arrived=now.heard)
            except InvalidInputError:
                self.watch.refused += 1
                raise
            if sample is not None and self.watch.add(sample, now):
                self._fresh.append(sample)
        self._arrival.set()

    @property
    def listened(self) -> float:
        """For how long joint states could have been heard so far [s]; see ``Instant``."""
        return self._listened

    def tick(self) -> None:
        """Whoever hears joint states hears this, too, every ``TICK``; what is missed of it was not listened to."""
        with self.lock:
            now = time.monotonic()
            self._listened += min(now - self._ticked, 1.5 * TICK)
            self._ticked = now

    def add_driver(self, status: DriverStatus) -> None:
        """Take the driver's state."""
        with self.lock:
            self.driver = status
        self._arrival.set()

    def wait(self, timeout: float) -> None:
        """Until something new has arrived, at most ``timeout`` [s]."""
        self._arrival.wait(timeout)
        self._arrival.clear()

    def take(self) -> list[Sample]:
        """Good samples since the last call, oldest first."""
        with self.lock:
            fresh = list(self._fresh)
            self._fresh.clear()
        return fresh

    def wake(self) -> None:
        """End a ``wait``."""
        self._arrival.set()
