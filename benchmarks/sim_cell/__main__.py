"""What the simulated cell costs in processor time, and whether it grows over many cycles.

scripts/bench sim_cell [--repeats 20] [--cycles 200] [--out FOLDER]
"""

import argparse
import csv
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import psutil
from benchmarks.sim_cell.sweeps import Sweeper

from singulation_core import CellGeometry
from singulation_core.transforms import inverse
from singulation_sim.camera import PHOXI_FULL, PHOXI_SMALL, PhoxiCamera, RobotShape
from singulation_sim.cell import SimulatedCell
from singulation_sim.driver import PERIOD
from singulation_sim.scenes import random_scene
from yumi_push_executor.kinematics import CLEAR_VIEW
from yumi_push_executor.kinematics.postures import BRANCHES

Row = tuple[str, str, str]


def main() -> int:
    """Measure and write the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=20, help="of each measurement (default 20)")
    parser.add_argument("--cycles", type=int, default=200, help="looks and pushes of the long run (default 200)")
    parser.add_argument("--out", type=Path, default=Path("bench_results/sim_cell"), help="folder for the table")
    options = parser.parse_args()
    rows = [*_camera_rows(options.repeats), *_cycle_rows(options.repeats), *_long_run(options.cycles)]
    options.out.mkdir(parents=True, exist_ok=True)
    table = "\n".join(["| what | value | unit |", "|---|---|---|", *(f"| {' | '.join(row)} |" for row in rows)]) + "\n"
    (options.out / "sim_cell.md").write_text(table)
    with (options.out / "sim_cell.csv").open("w", newline="") as file:
        csv.writer(file).writerows([("what", "value", "unit"), *rows])
    print(table)
    return 0


def _median(action: Callable[[], object], repeats: int) -> float:
    """Median processor time of one call [s], after one that is not counted."""
    action()
    times = []
    for _ in range(repeats):
        start = time.process_time()
        action()
        times.append(time.process_time() - start)
    return float(np.median(times))


def _camera_rows(repeats: int) -> Sequence[Row]:
    geometry, shape, scene = CellGeometry(), RobotShape(), random_scene("mixed", 7, 2)
    table_from_body = inverse(geometry.body_from_table)
    rows = []
    for size, model in (("1032x772", PHOXI_SMALL), ("2064x1544", PHOXI_FULL)):
        camera = PhoxiCamera(geometry, model)
        for arms, left in (("arms out of view", CLEAR_VIEW["left"]), ("left arm over the table", BRANCHES[0]["left"])):
            solids = shape.solids({"left": left, "right": CLEAR_VIEW["right"]}, {"left": 0.0, "right": 0.0})
            robot = [solid.moved(table_from_body) for solid in solids]
            seconds = _median(lambda camera=camera, robot=robot: camera.capture(scene, robot), repeats)
            rows.append((f"cloud {size}, 7 blocks, {arms}", f"{seconds * 1e3:.0f}", "ms"))
    return rows


def _cycle_rows(repeats: int) -> Sequence[Row]:
    """Processor time of one cycle of 4 ms, standing, travelling, pushing."""
    rows = []
    for what, height in (("standing", None), ("travelling", 0.08), ("pushing", 0.01)):
        sweeper = Sweeper(SimulatedCell(random_scene("mixed", 7, 2)))
        times = []
        for _ in range(repeats):
            if height is not None:
                sweeper.approach(height)
                sweeper.start(height)
            start = time.process_time()
            sweeper.cell.run(1.0)
            times.append(time.process_time() - start)
        cycle = float(np.median(times)) * PERIOD
        rows.append((f"cycle of {PERIOD * 1e3:.0f} ms, {what}", f"{cycle * 1e6:.0f}", "us"))
        rows.append((f"fastest factor to real time, {what}", f"{PERIOD / cycle:.0f}", ""))
    return rows


def _long_run(cycles: int) -> Sequence[Row]:
    """Looks and pushes in turn; memory, threads and file handles after a tenth of them and at the end."""
    process = psutil.Process()
    sweeper = Sweeper(SimulatedCell(random_scene("mixed", 7, 2)))
    start, early = time.process_time(), (0, 0, 0)
    for cycle in range(cycles):
        sweeper.cell.set_scene(random_scene("mixed", 0, cycle))
        sweeper.cell.render(sweeper.cell.view())
        sweeper.approach(0.01)
        sweeper.start(0.01)
        sweeper.cell.run(1.2)
        if cycle == cycles // 10:
            early = (process.memory_info().rss, process.num_threads(), process.num_fds())
    seconds = (time.process_time() - start) / cycles
    late = (process.memory_info().rss, process.num_threads(), process.num_fds())
    return [
        (f"one of {cycles} cycles of scene, look, push", f"{seconds * 1e3:.0f}", "ms"),
        ("memory gained from a tenth of them to the end", f"{(late[0] - early[0]) / 2**20:.1f}", "MiB"),
        ("threads gained", str(late[1] - early[1]), ""),
        ("file handles gained", str(late[2] - early[2]), ""),
    ]


if __name__ == "__main__":
    sys.exit(main())
