"""The nodes of a demo as processes that never outlive it."""

import os
import re
import signal
import subprocess
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType

from ament_index_python.packages import get_package_prefix

from singulation_core import ResultCode, SingulationError

_GRACE = 20.0  # s from SIGINT to SIGKILL; an executor brings its arm to a standstill first
_DIE_WITH_PARENT = ("setpriv", "--pdeathsig", "KILL")  # of util-linux, which every Debian and Ubuntu has


class NodeProcesses:
    """Starts executables of the workspace and stops them, the last started first.

    Each runs in a session of its own, so that Ctrl-C reaches the demo alone and the demo decides the order; and the
    kernel ends each when the demo dies without a word.

    Args:
        logs: folder for what they print, one file each.
        environment: added to the demo's own.
    """

    def __init__(self, logs: Path, environment: Mapping[str, str]) -> None:
        self._logs = logs
        self._environment = {**os.environ, **environment}
        self._running: list[tuple[str, subprocess.Popen[bytes]]] = []
        logs.mkdir(parents=True, exist_ok=True)

    def start(self, package: str, executable: str, arguments: Sequence[str] = ()) -> "subprocess.Popen[bytes]":
        """Start what ``ros2 run package executable`` would.

        Raises:
            SingulationError: ``NOT_READY`` if it is not built.
        """
        program = Path(get_package_prefix(package), "lib", package, executable)
        if not program.is_file():
            raise SingulationError(ResultCode.NOT_READY, f"{program} does not exist; run scripts/setup")
        with (self._logs / f"{executable}.log").open("ab") as log:
            process = subprocess.Popen(
                [*_DIE_WITH_PARENT, program, *arguments],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                env=self._environment,
                start_new_session=True,
            )
        self._running.append((executable, process))
        return process

    def check(self) -> None:
        """Raise if one has ended although nobody stopped it.

        Raises:
            SingulationError: with the code and text the process itself gave (``error: NAME (number): text``), else
                ``INTERNAL`` with the end of its log.
        """
        for name, process in self._running:
            if process.poll() not in (None, 0):
                raise _reason(name, int(process.returncode), self._logs / f"{name}.log")

    def stop(self) -> None:
        """Ask all to end, wait, and kill what does not."""
        for _, process in reversed(self._running):
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        deadline = time.monotonic() + _GRACE
        for _, process in reversed(self._running):
            try:
                process.wait(max(0.0, deadline - time.monotonic()))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait(5.0)
        self._running.clear()

    def __enter__(self) -> "NodeProcesses":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()


def _reason(name: str, exit_code: int, log: Path) -> SingulationError:
    lines = log.read_text(errors="replace").splitlines()
    for line in reversed(lines):
        found = re.match(r"error: ([A-Z_]+) \(\d+\): (.*)", line)
        if found and found[1] in ResultCode.__members__:
            return SingulationError(ResultCode[found[1]], found[2])
    tail = "\n  ".join(lines[-8:])
    return SingulationError(ResultCode.INTERNAL, f"{name} ended with code {exit_code}; its log {log} ends:\n  {tail}")
