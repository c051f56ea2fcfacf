"""``compile_kernels``: compile now what every node would else compile at its first start.

Numba keeps the result beside the sources, or in the user's cache folder where those cannot be written.
``scripts/setup`` runs this; on a cell that is built in another way run it once after each update.
"""

import gc
import multiprocessing
import os
import sys
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import partial

from singulation_core.compiling import help_with
from singulation_perception import warm_up as warm_perception
from singulation_planner import warm_up as warm_planner
from singulation_sim.camera import warm_up as warm_camera
from yumi_push_executor.executor_settings import ExecutorSettings
from yumi_push_executor.push_planner import PushPlanner


def _warm_executor() -> None:
    PushPlanner(ExecutorSettings()).warm_up()


# The longest first, so that two cores end at about the same time.
ROOMS: Mapping[str, Callable[[], None]] = {
    "perception": warm_perception,
    "planner": warm_planner,
    "executor": _warm_executor,
    "simulated camera": warm_camera,
}
# With more cores than that the two long ones are begun at other ends too: no function is compiled twice.
HELPERS: Mapping[str, Callable[[], None]] = {
    "perception, from its second step": partial(help_with, "singulation_perception.warming", 1),
    "planner, from its second step": partial(help_with, "singulation_planner.warming", 1),
}


def main() -> int:
    """Compile every room in a process of its own, as many at once as there are cores; the exit code."""
    context = multiprocessing.get_context("spawn")
    cores = len(os.sched_getaffinity(0))
    rooms = (*ROOMS, *HELPERS) if cores > 2 else tuple(ROOMS)
    with ProcessPoolExecutor(cores, mp_context=context) as pool:
        for done in as_completed([pool.submit(_timed, room) for room in rooms]):
            room, seconds = done.result()
            print(f"{room}: ready after {seconds:.1f} s", flush=True)
    return 0


def _timed(room: str) -> tuple[str, float]:
    gc.disable()  # nearly everything that compiling makes stays
    started = time.monotonic()
    {**ROOMS, **HELPERS}[room]()
    return room, time.monotonic() - started


if __name__ == "__main__":
    sys.exit(main())
