"""Many look-plan-push-look cycles in a row in one process: what grows, and whether every push is accounted for."""

import gc
import os
import threading
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import psutil  # type: ignore[import-untyped]

from singulation_bringup.closed_loop.library_cell import LibraryCell
from singulation_bringup.closed_loop.setting import CellSetting
from singulation_bringup.policy_choice import DEFAULT_MIN_GAP, FALLBACK_POLICIES
from singulation_bringup.singulation_loop import SingulationGoal, SingulationLoop
from singulation_core import ContactMode
from singulation_planner.benchmark.markdown import table

_EVERY = 10  # cycles between two samples
_SETTLED = 0.25  # share of the samples that belong to warming up, beside the first one
_PER_SET = 10  # pushes on one set at most


@dataclass(frozen=True, slots=True)
class Sample:
    """What the process holds after so many pushes."""

    pushes: int
    memory: float  # resident, MiB
    threads: int
    handles: int


@dataclass(frozen=True, slots=True)
class Endurance:
    """What a long run came to.

    Args:
        samples: in order.
        codes: of all pushes.
        asked: pushes handed to the robot.
        performed: of them, those that were no refusals.
        outcomes: that the loop left.
    """

    samples: tuple[Sample, ...]
    codes: Counter[str]
    asked: int
    performed: int
    outcomes: int

    @property
    def growth(self) -> float:
        """Slope of the memory after warming up [MiB in 100 pushes]."""
        kept = self.samples[1 + int(_SETTLED * len(self.samples)) :]
        if len(kept) < 2:
            return 0.0
        return float(100.0 * np.polyfit([one.pushes for one in kept], [one.memory for one in kept], 1)[0])


def run_cycles(cycles: int, setting: CellSetting | None = None, every: int = _EVERY) -> Endurance:
    """Push, set after set, until ``cycles`` pushes were done, with all contact modes in turn."""
    setting = setting or CellSetting()
    samples, codes = [_sample(0)], Counter[str]()
    asked = performed = outcomes = seed = 0
    while outcomes < cycles:
        cell = LibraryCell(setting.simulated_cell("mixed", 3 + seed % 5, seed), setting, seed)
        left = min(_PER_SET, cycles - outcomes)
        goal = SingulationGoal(
            left, DEFAULT_MIN_GAP, "cluster_push", ContactMode(seed % len(ContactMode)), FALLBACK_POLICIES
        )
        result = SingulationLoop(cell, goal).run()
        codes.update(one.code.name for one in result.progress.outcomes)
        outcomes += len(result.progress.outcomes)
        asked, performed, seed = asked + cell.asked, performed + cell.asked - cell.refused, seed + 1
        if outcomes >= samples[-1].pushes + every:
            samples.append(_sample(outcomes))
    return Endurance(tuple(samples), codes, asked, performed, outcomes)


def endure(cycles: int, out: Path) -> str:
    """Run, and write ``endurance.md`` and ``endurance.csv``; the text of the former."""
    found = run_cycles(cycles)
    out.mkdir(parents=True, exist_ok=True)
    rows = [[str(one.pushes), f"{one.memory:.1f}", str(one.threads), str(one.handles)] for one in found.samples]
    (out / "endurance.csv").write_text(
        "pushes,memory_mib,threads,handles\n" + "".join(",".join(row) + "\n" for row in rows)
    )
    codes = ", ".join(f"{name} {count}" for name, count in found.codes.most_common())
    text = "\n".join(
        [
            f"## {found.outcomes} look-plan-push-look cycles in one process\n",
            table(["pushes", "memory [MiB]", "threads", "file handles"], rows),
            f"Memory after warming up: {found.growth:+.2f} MiB in 100 pushes.",
            f"{found.asked} pushes were handed to the robot, {found.asked - found.performed} of them refused before "
            f"anything moved, {found.performed} performed; {found.outcomes} outcomes: {codes}.\n",
        ]
    )
    (out / "endurance.md").write_text(text)
    return text


def _sample(pushes: int) -> Sample:
    gc.collect()
    process = psutil.Process(os.getpid())
    return Sample(pushes, process.memory_info().rss / 2**20, threading.active_count(), process.num_fds())
