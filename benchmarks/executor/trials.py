"""Planning, timing and auditing of many pushes."""

import csv
import gc
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from benchmarks.executor.audit import Figures, audit
from benchmarks.executor.pushes import Task
from benchmarks.executor.reach import ReachMap

from singulation_core import CellGeometry, ResultCode, SingulationError
from singulation_planner.benchmark.progress import Progress
from yumi_push_executor import Motion, MotionParameters, plan_motion


@dataclass(frozen=True, eq=False)
class Trial:
    """One push: what came of planning it, how long that took [s of processor time], and the audit."""

    task: Task
    within_reach: bool
    code: ResultCode
    message: str
    seconds: float
    motion: Motion | None
    figures: Figures | None


def run(tasks: list[Task], reach: ReachMap, audited: bool) -> list[Trial]:
    """Plan every task; two plans beforehand warm up what is compiled and cached, as the node does."""
    for task in tasks[:2]:
        _planned(task)
    gc.collect()
    gc.freeze()
    progress, trials = Progress(len(tasks)), []
    for task in tasks:
        trials.append(_trial(task, reach, audited))
        progress.step()
    return trials


def write_trials(path: Path, trials: list[Trial]) -> None:
    """One line per push."""
    lines = [_line(one) for one in trials]
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(lines[0]))
        writer.writeheader()
        writer.writerows(lines)


def _trial(task: Task, reach: ReachMap, audited: bool) -> Trial:
    begin = time.process_time()
    motion, code, message = _planned(task)
    seconds = time.process_time() - begin
    within = reach.within(np.array((task.push.start, task.push.end)))
    figures = audit(motion, task.arrangement, CellGeometry(), MotionParameters()) if motion and audited else None
    return Trial(task, within, code, message, seconds, motion, figures)


def _planned(task: Task) -> tuple[Motion | None, ResultCode, str]:
    try:
        return plan_motion(task.push, task.arrangement), ResultCode.OK, ""
    except SingulationError as refusal:
        return None, refusal.code, refusal.message


def _line(one: Trial) -> dict[str, object]:
    push, motion, figures = one.task.push, one.motion, one.figures
    return {
        "mode": push.contact_mode.label,
        "start_x": round(push.start[0], 5),
        "start_y": round(push.start[1], 5),
        "end_x": round(push.end[0], 5),
        "end_y": round(push.end[1], 5),
        "width": round(push.contact_width, 5),
        "blocks": len(one.task.arrangement),
        "within_reach": one.within_reach,
        "code": one.code.name,
        "arm": motion.arm if motion else "",
        "tried": motion.candidates[1] if motion else "",
        "planning_ms": round(one.seconds * 1e3, 2),
        "motion_s": round(motion.duration, 2) if motion else "",
        "straightness_mm": round(figures.straightness * 1e3, 4) if figures else "",
        "violations": " | ".join(figures.violations) if figures else "",
        "message": one.message,
    }
