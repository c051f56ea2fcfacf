"""How long the steps of a run take, whatever cell does them."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from singulation_bringup.singulation_loop import Cell
from singulation_core import Arrangement, ContactMode, Push


@dataclass(slots=True)
class StageTime:
    """How often a step was done, and the time of all of them together [s]."""

    count: int = 0
    seconds: float = 0.0


class TimedCell:
    """A cell of ``singulation_loop`` that notes the time of every look, plan and push, those that fail included.

    Args:
        cell: does the work.
    """

    def __init__(self, cell: Cell) -> None:
        self._cell = cell
        self.stages = {name: StageTime() for name in ("look", "plan", "push")}

    def look(self) -> Arrangement:
        """As the cell's."""
        with self._timed("look"):
            return self._cell.look()

    def plan(self, seen: Arrangement, policy: str, mode: ContactMode, min_gap: float) -> Push:
        """As the cell's."""
        with self._timed("plan"):
            return self._cell.plan(seen, policy, mode, min_gap)

    def execute(self, push: Push) -> None:
        """As the cell's."""
        with self._timed("push"):
            self._cell.execute(push)

    def check_cancelled(self) -> None:
        """As the cell's."""
        self._cell.check_cancelled()

    @contextmanager
    def _timed(self, stage: str) -> Iterator[None]:
        started, noted = time.monotonic(), self.stages[stage]
        noted.count += 1
        try:
            yield
        finally:
            noted.seconds += time.monotonic() - started
