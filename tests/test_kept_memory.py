"""Processes that handle clouds keep freed memory: all threads take theirs from one heap that never shrinks."""

import os
import subprocess
import sys

import pytest

from singulation_node.large_messages import HEAPS_VARIABLE

PROGRAM = """
import ctypes, importlib, resource, sys, tempfile, threading
importlib.import_module(sys.argv[1])
BLOCK = 40_000_000
def twice():
    for _ in range(2):
        kept = [bytearray(BLOCK), bytearray(BLOCK)]
        del kept
threads = [threading.Thread(target=twice) for _ in range(6)]
faults = [0]
for thread in threads:
    thread.start()
    thread.join()
    faults.append(resource.getrusage(resource.RUSAGE_SELF).ru_minflt)
print(faults[-1] - faults[2])
"""


def faults_after_the_first_block(module: str, **variables: str) -> int:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, module],
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    return int(done.stdout)


@pytest.mark.parametrize(
    "module",
    [
        "singulation_perception.perception_node",
        "singulation_perception.record_clouds",
        "singulation_perception.replay_clouds",
        "singulation_sim.sim_cell",
        "singulation_bringup.demo.__main__",
    ],
)
def test_large_blocks_come_from_kept_memory_in_every_thread(module):
    assert faults_after_the_first_block(module) < 1000


def test_who_sets_the_number_of_heaps_is_left_alone():
    pages_of_a_block = 40_000_000 // 4096
    faults = faults_after_the_first_block("singulation_perception.perception_node", **{HEAPS_VARIABLE: "8"})
    assert faults > pages_of_a_block
