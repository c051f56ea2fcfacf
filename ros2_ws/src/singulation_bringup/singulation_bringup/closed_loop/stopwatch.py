"""Processor time of the stages of a cycle."""

import time
from collections.abc import Iterator
from contextlib import contextmanager


class Stopwatch:
    """Sums processor time by stage [s]; other processes on the machine do not count."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def timed(self, stage: str) -> Iterator[None]:
        """Add the block's processor time to a stage."""
        started = time.process_time()
        try:
            yield
        finally:
            self.add(stage, time.process_time() - started)

    def add(self, stage: str, seconds: float) -> None:
        """Add a time that was measured elsewhere [s]."""
        self.seconds[stage] = self.seconds.get(stage, 0.0) + seconds
