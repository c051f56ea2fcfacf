"""What became of every cloud: published, rejected with a code, or superseded by a newer one. Nothing else exists."""

import threading
from collections import Counter, deque
from collections.abc import Mapping
from dataclasses import dataclass
from statistics import median

from singulation_core import ResultCode

_REMEMBERED = 100  # clouds over which rate and times are taken


@dataclass(frozen=True, slots=True)
class LedgerState:
    """A consistent snapshot of the counters.

    Args:
        received: clouds that came in; equals published + superseded + rejected + pending.
        published: arrangements that went out.
        superseded: never processed, a newer cloud came first.
        rejected: by code name.
        pending: waiting or being processed, 0 to 2.
        rate: clouds a second over the last ones, 0 before the second.
        quiet: since the last cloud came [s], infinite before the first.
        age: stamp to publishing of the last published one [s], NaN before.
        stages: median milliseconds of each stage.
        last_error: text of the last rejection, empty before.
        healthy: whether the newest finished cloud was published.
        lost: clouds that the middleware could not deliver; they never came in and are not part of ``received``.
        since_loss: since the last of them [s], infinite if there was none.
    """

    received: int
    published: int
    superseded: int
    rejected: Mapping[str, int]
    pending: int
    rate: float
    quiet: float
    age: float
    stages: Mapping[str, float]
    last_error: str
    healthy: bool
    lost: int
    since_loss: float


class FrameLedger:
    """Counts outcomes, from any thread. Times are monotonic seconds given by the caller."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._received = self._published = self._superseded = 0
        self._rejected: Counter[str] = Counter()
        self._arrivals: deque[float] = deque(maxlen=_REMEMBERED)
        self._stages: deque[Mapping[str, float]] = deque(maxlen=_REMEMBERED)
        self._age = float("nan")
        self._last_error = ""
        self._healthy = True
        self._lost, self._last_loss = 0, float("-inf")

    def lost(self, count: int, now: float) -> None:
        """The middleware says that clouds did not arrive, ``count`` in all so far."""
        with self._lock:
            self._lost, self._last_loss = count, now

    def received(self, now: float) -> None:
        """A cloud came in."""
        with self._lock:
            self._received += 1
            self._arrivals.append(now)

    def superseded(self) -> None:
        """A waiting cloud was given up for a newer one, or because the node stops."""
        with self._lock:
            self._superseded += 1

    def rejected(self, code: ResultCode, text: str) -> None:
        """A cloud could not be used."""
        with self._lock:
            self._rejected[code.name] += 1
            self._last_error, self._healthy = f"{code.name} ({int(code)}): {text}", False

    def published(self, age: float, stages: Mapping[str, float]) -> None:
        """A cloud became an arrangement, ``age`` [s] after its stamp; ``stages`` in milliseconds."""
        with self._lock:
            self._published += 1
            self._age, self._healthy = age, True
            self._stages.append(dict(stages))

    def state(self, now: float) -> LedgerState:
        """All counters at one moment."""
        with self._lock:
            finished = self._published + self._superseded + self._rejected.total()
            names = {name for stages in self._stages for name in stages}
            return LedgerState(
                received=self._received,
                published=self._published,
                superseded=self._superseded,
                rejected=dict(self._rejected),
                pending=self._received - finished,
                rate=self._rate(),
                quiet=now - self._arrivals[-1] if self._arrivals else float("inf"),
                age=self._age,
                stages={name: median(one[name] for one in self._stages if name in one) for name in sorted(names)},
                last_error=self._last_error,
                healthy=self._healthy,
                lost=self._lost,
                since_loss=now - self._last_loss,
            )

    def _rate(self) -> float:
        span = self._arrivals[-1] - self._arrivals[0] if len(self._arrivals) > 1 else 0.0
        return (len(self._arrivals) - 1) / span if span > 0.0 else 0.0
