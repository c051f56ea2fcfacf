"""Single key presses from the terminal, without waiting for the return key."""

import os
import select
import sys
import termios
import tty
from types import TracebackType
from typing import Any


class StepKeys:
    """Reads keys while its ``with`` block runs and puts the terminal back afterwards; silent without a terminal.

    Args:
        wanted: False leaves the terminal alone.
    """

    def __init__(self, wanted: bool) -> None:
        self._terminal = sys.stdin.fileno() if wanted and sys.stdin is not None and sys.stdin.isatty() else -1
        self._saved: list[Any] = []

    @property
    def available(self) -> bool:
        """Whether there is a terminal to press keys on."""
        return self._terminal >= 0

    def __enter__(self) -> "StepKeys":
        if self.available:
            self._saved = termios.tcgetattr(self._terminal)
            tty.setcbreak(self._terminal)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._saved:
            termios.tcsetattr(self._terminal, termios.TCSADRAIN, self._saved)

    def pressed(self) -> str:
        """The next key that was pressed, empty if none was."""
        if not self.available or not select.select([self._terminal], [], [], 0.0)[0]:
            return ""
        # Not sys.stdin.read: what it takes beyond the first key would be invisible to select.
        return os.read(self._terminal, 1).decode("ascii", errors="replace")
