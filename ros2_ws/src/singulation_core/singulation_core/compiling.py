"""What happens around a warm-up: somebody is told when something is compiled, and other processes help with it."""

import gc
import importlib
import os
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import Any

from numba.core import event

_COMPILE = "numba:compile"
_STOP = 10.0  # s
_HELP = "import sys; from singulation_core.compiling import help_with; help_with(sys.argv[1], int(sys.argv[2]))"


@contextmanager
def compiling_told(begun: Callable[[], None]) -> Iterator[None]:
    """Within the block, ``begun`` is called once, when Numba begins to compile: what is kept on disk is only loaded."""
    with event.install_listener(_COMPILE, _First(begun)):
        yield


class _First(event.Listener):  # type: ignore[misc]  # Numba has no types
    def __init__(self, begun: Callable[[], None]) -> None:
        self._waiting = [begun]

    def on_start(self, event: Any) -> None:
        if self._waiting:
            self._waiting.pop()()

    def on_end(self, event: Any) -> None:
        pass


@contextmanager
def helpers(module: str) -> Iterator[None]:
    """Processes that compile ahead, as many as there are further cores, until the block ends.

    Each runs the ``STEPS`` of the module from another one on, so that they take what this process comes to last. What
    becomes of them does not matter: this process compiles what they did not.
    """
    others = min(len(os.sched_getaffinity(0)), len(_steps(module))) - 1
    with ExitStack() as stack:
        for first in range(1, others + 1):
            stack.callback(_ended, _helper(module, first))
        yield


def help_with(module: str, first: int) -> None:
    """Run the ``STEPS`` of a module, beginning with the one of number ``first``."""
    gc.disable()  # nearly everything that compiling makes stays
    steps = _steps(module)
    for step in (*steps[first:], *steps[:first]):
        step()


def _steps(module: str) -> Sequence[Callable[[], None]]:
    steps: Sequence[Callable[[], None]] = importlib.import_module(module).STEPS
    return steps


def _helper(module: str, first: int) -> "subprocess.Popen[bytes]":
    nowhere = subprocess.DEVNULL
    return subprocess.Popen(
        [sys.executable, "-c", _HELP, module, str(first)], stdin=nowhere, stdout=nowhere, stderr=nowhere
    )


def _ended(process: "subprocess.Popen[bytes]") -> None:
    process.kill()
    process.wait(timeout=_STOP)
