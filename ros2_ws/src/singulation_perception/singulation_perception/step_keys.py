"""Single key presses from the terminal, without waiting for the return key."""

import select
import sys
import termios
import tty
from types import TracebackType
from typing import Any


class StepKeys:
    """Reads keys while its ``with`` block runs and puts the terminal back afterwards; silent without a terminal."""

    def __init__(self) -> None:
        self._saved: list[Any] | None = None

    @property
    def available(self) -> bool:
        """Whether there is a terminal to press keys on."""
        return self._saved is not None

    def __enter__(self) -> "StepKeys":
        if sys.stdin is not None and sys.stdin.isatty():
            self._saved = termios.tcgetattr(sys.stdin)
            tty.setcbreak(sys.stdin)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._saved is not None:
            termios.tcsetattr(sys.stdin, termios.TCSADRAIN, self._saved)

    def pressed(self) -> str:
        """The next key that was pressed, empty if none was."""
        if self._saved is None or not select.select([sys.stdin], [], [], 0.0)[0]:
            return ""
        return sys.stdin.read(1)
