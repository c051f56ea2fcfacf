"""The demo as a process, and where tests find recordings."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

ROOT = Path(__file__).resolve().parents[1]
REAL_CLOUDS = sorted((ROOT.parent / "shared" / "data" / "mosd").glob("learn*.pcd"))


class Demo:
    """A running demo as a person would start it, without the set-up step."""

    def __init__(self, out, *arguments):
        self.out = Path(out)
        self.process = subprocess.Popen(
            [sys.executable, "-m", "singulation_bringup.demo", "--out", str(self.out), *map(str, arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "SINGULATION_ROOT": str(ROOT)},
        )
        self.seen = []

    def wait_for_line(self, text):
        """Read until a line contains the text; the children that run by then."""
        for line in self.process.stdout:
            self.seen.append(line)
            if text in line:
                return psutil.Process(self.process.pid).children(recursive=True)
        pytest.fail(f"{text!r} was never printed; there was:\n{''.join(self.seen)}\n{self.process.stderr.read()}")

    def interrupt(self, number=signal.SIGINT):
        self.process.send_signal(number)

    def end(self, timeout=240):
        """Exit code, output and errors once it has ended."""
        try:
            output, errors = self.process.communicate(timeout=timeout)
        finally:
            self.process.kill()
        return self.process.returncode, "".join(self.seen) + output, errors

    @property
    def summary(self):
        return json.loads((self.out / "summary.json").read_text())
