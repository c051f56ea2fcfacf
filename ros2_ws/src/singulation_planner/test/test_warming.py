"""The steps of the warm-up, in whatever order, compile what it does and nothing else."""

import subprocess
import sys

PROGRAM = """
import sys
from singulation_core.compiling import compiling_told, help_with
from singulation_planner import warm_up

warm_up()
with compiling_told(lambda: print("compiled again")):
    help_with("singulation_planner.warming", 1)
"""


def test_helpers_and_warm_up_need_the_same():
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
