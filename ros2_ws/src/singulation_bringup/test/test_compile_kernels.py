"""All rooms are compiled by processes of their own; with more than two cores others begin at further ends."""

import subprocess
import sys

import pytest

from singulation_bringup.commands.compile_kernels import HELPERS, ROOMS

PROGRAM = """
import os, sys
os.sched_getaffinity = lambda _: set(range(int(sys.argv[1])))
from singulation_bringup.commands.compile_kernels import main
if __name__ == "__main__":
    sys.exit(main())
"""


@pytest.mark.parametrize(("cores", "rooms"), [(2, {*ROOMS}), (3, {*ROOMS, *HELPERS})])
def test_every_room_is_made_ready(tmp_path, cores, rooms):
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)
    done = subprocess.run(
        [sys.executable, program, str(cores)], capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    assert {line.split(": ready after ")[0] for line in done.stdout.splitlines()} == rooms
