"""A line that says how far a long run is and when it will be done."""

import sys
import time
from typing import TextIO

_WIDTH = 30


class Progress:
    """Shows ``[#####.....] 312/1040  30 %  12.3/s  ETA 1:02`` on a terminal, or a line every ten seconds elsewhere.

    Args:
        total: number of steps.
        stream: standard error if None.
    """

    def __init__(self, total: int, stream: TextIO | None = None) -> None:
        self._total, self._done = total, 0
        self._stream = stream or sys.stderr
        self._live = self._stream.isatty()
        self._started = self._shown = time.monotonic()

    def step(self) -> None:
        """One more is done."""
        self._done += 1
        now = time.monotonic()
        if self._done == self._total or now - self._shown >= (0.2 if self._live else 10.0):
            self._shown = now
            self._stream.write(("\r" if self._live else "") + self.line(now - self._started) + self._end())
            self._stream.flush()

    def line(self, elapsed: float) -> str:
        """The text after ``elapsed`` seconds."""
        share = self._done / max(self._total, 1)
        bar = "#" * int(share * _WIDTH)
        rate = self._done / max(elapsed, 1e-9)
        left = (self._total - self._done) / rate if self._done else float("inf")
        return f"[{bar:.<{_WIDTH}}] {self._done}/{self._total}  {share:4.0%}  {rate:.1f}/s  ETA {_clock(left)}"

    def _end(self) -> str:
        return "" if self._live and self._done < self._total else "\n"


def _clock(seconds: float) -> str:
    if not (seconds < 360000.0):
        return "?"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
