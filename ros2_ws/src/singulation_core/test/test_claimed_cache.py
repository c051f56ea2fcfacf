"""Processes that share a folder of compiled functions compile each of them once."""

import os
import subprocess
import sys

import pytest

KERNEL = """
import math
import numpy as np
from singulation_core.jit import compiled_maker

@compiled_maker
def busy(values):
    found = np.zeros(8)
    for k in range(len(values)):
        found[k % 8] += math.sin(values[k]) * math.hypot(values[k], 1.0)
    return found
"""
NEED = """
import numpy as np
from singulation_core import claimed_cache
from singulation_core.compiling import compiling_told
import kernel
claimed_cache._PATIENCE = {patience}
with compiling_told(lambda: print("compiled")):
    print(kernel.busy(np.ones(3))[0] > 0.8)
"""
CLAIM = """
import sys
import numba
from singulation_core.claimed_cache import ClaimedCache
import kernel
assert ClaimedCache(kernel.busy.py_func)._claim((numba.types.Array(numba.float64, 1, "C"),))
print("claimed", flush=True)
sys.stdin.readline()
"""


@pytest.fixture
def start(tmp_path):
    """Starts a program that knows the module ``kernel`` and keeps what is compiled in a folder of this test."""
    (tmp_path / "kernel.py").write_text(KERNEL)
    path = os.pathsep.join([str(tmp_path), *filter(None, [os.environ.get("PYTHONPATH")])])
    environment = {**os.environ, "PYTHONPATH": path, "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    started = []

    def run(program):
        pipe = subprocess.PIPE
        command = [sys.executable, "-c", program]
        started.append(subprocess.Popen(command, env=environment, stdin=pipe, stdout=pipe, stderr=pipe, text=True))
        return started[-1]

    yield run
    for process in started:
        process.kill()
        process.communicate(timeout=30)


def said(process):
    out, errors = process.communicate(timeout=120)
    assert process.returncode == 0, errors
    return out.split()


def test_of_processes_that_start_at_once_one_compiles(start):
    need = NEED.format(patience=60.0)
    words = [said(process) for process in [start(need) for _ in range(3)]]
    assert sorted(words) == [["True"], ["True"], ["compiled", "True"]]
    assert said(start(need)) == ["True"]


def test_a_process_that_dies_leaves_no_claim(start):
    claimer = start(CLAIM)
    assert claimer.stdout.readline() == "claimed\n"
    claimer.kill()
    claimer.wait(timeout=30)
    assert said(start(NEED.format(patience=300.0))) == ["compiled", "True"]


def test_nobody_waits_for_ever(start):
    claimer = start(CLAIM)
    assert claimer.stdout.readline() == "claimed\n"
    assert said(start(NEED.format(patience=0.3))) == ["compiled", "True"]
    assert claimer.poll() is None


def test_without_locks_everybody_compiles(start):
    without = "claimed_cache._claims_of = lambda folder: open('/nowhere/claims')\n"
    need = NEED.format(patience=60.0).replace("with compiling", f"{without}with compiling")
    assert said(start(need)) == ["compiled", "True"]
    assert said(start(need)) == ["True"]
