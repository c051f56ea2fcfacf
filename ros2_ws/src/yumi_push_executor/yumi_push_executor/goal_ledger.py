"""Counts of goals and how they ended: every one that came in ends exactly once."""

import threading
from collections import Counter

from singulation_core import ResultCode


class GoalLedger:
    """Thread-safe; ``received`` equals the sum of ``ended`` plus those still open."""

    def __init__(self) -> None:
        self._lock = threading.Condition()
        self._received = 0
        self._ended: Counter[ResultCode] = Counter()

    def receive(self) -> None:
        """A goal came in."""
        with self._lock:
            self._received += 1

    def end(self, code: ResultCode) -> None:
        """A goal got its outcome."""
        with self._lock:
            self._ended[code] += 1
            self._lock.notify_all()

    def ended(self, code: ResultCode) -> int:
        """How many ended with a code."""
        with self._lock:
            return self._ended[code]

    def wait_for_none_open(self, timeout: float) -> bool:
        """Wait until every goal has ended, at most ``timeout`` [s]; whether they have."""
        with self._lock:
            return self._lock.wait_for(lambda: self._received == self._ended.total(), timeout)

    def counts(self) -> dict[str, int]:
        """Received, open, and each code that has occurred, for the diagnostics."""
        with self._lock:
            known = {code.name: count for code, count in sorted(self._ended.items())}
            return {"received": self._received, "open": self._received - self._ended.total(), **known}
