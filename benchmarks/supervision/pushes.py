"""Many random pushes, executed one after the other under supervision."""

from collections import Counter
from dataclasses import dataclass

import numpy as np
from benchmarks.executor.pushes import Task, random_tasks
from benchmarks.supervision.robot import BenchRobot

from singulation_core import ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from singulation_planner.benchmark.progress import Progress
from yumi_push_executor.supervision import Phase

_NAN = float("nan")
_PLANNING = {
    ResultCode.UNREACHABLE,
    ResultCode.PATH_BLOCKED,
    ResultCode.PUSH_OUTSIDE_WORKSPACE,
    ResultCode.CONTACT_WIDTH,
}


@dataclass(frozen=True, slots=True)
class Executed:
    """One push and its one outcome; lengths in metres, NaN if it was not begun.

    Args:
        mode: of contact.
        arm: that pushed, "" if none.
        code: of the outcome, or of the refusal.
        text: why.
        duration: from the first order to the outcome [s].
        deviation: of the real tips from the planned straight line during the push.
        missed: distance of the real tips from the planned end where the push ended.
        outcomes: how many the supervision gave.
    """

    mode: str
    arm: str
    code: ResultCode
    text: str
    duration: float
    deviation: float
    missed: float
    outcomes: int

    def row(self) -> dict[str, object]:
        """As a line of a table."""
        return {
            "mode": self.mode,
            "arm": self.arm,
            "code": self.code.name,
            "duration [s]": round(self.duration, 3),
            "deviation [mm]": round(1e3 * self.deviation, 3),
            "missed [mm]": round(1e3 * self.missed, 3),
            "text": self.text,
        }


def execute_pushes(count: int, seed: int) -> list[Executed]:
    """Plan and run random pushes among blocks; every one starts where the one before has left the arms."""
    robot = BenchRobot(seed=seed)
    progress, executed = Progress(count), []
    for task in random_tasks(count, seed, blocks=True):
        executed.append(_execute(robot, task))
        progress.step()
    return executed


def pushes_table(executed: list[Executed]) -> list[str]:
    """Counts and worst figures as Markdown."""
    planned = [one for one in executed if one.code not in _PLANNING]
    done = [one for one in planned if one.code is ResultCode.OK]
    codes = Counter(one.code.name for one in executed)
    deviation, missed = ([getattr(one, name) for one in done] for name in ("deviation", "missed"))
    return [
        f"## {len(executed)} random pushes among blocks, executed one after the other",
        "",
        "| figure | value |",
        "|---|---|",
        f"| outcomes | {', '.join(f'{name} {number}' for name, number in codes.most_common())} |",
        f"| pushes with a motion | {len(planned)} |",
        f"| of them executed to the end | {len(done)} ({100.0 * len(done) / max(len(planned), 1):.1f} %) |",
        f"| pushes with other than one outcome | {sum(one.outcomes != 1 for one in planned)} |",
        f"| real tips off the straight line while pushing, median and worst | {_figures(deviation)} |",
        f"| real tips off the end of the push, median and worst | {_figures(missed)} |",
        f"| duration, median and longest | {np.median([one.duration for one in done]):.1f} s, "
        f"{max(one.duration for one in done):.1f} s |",
    ]


def _figures(values: list[float]) -> str:
    return f"{1e3 * float(np.median(values)):.2f} mm, {1e3 * max(values):.2f} mm"


def _execute(robot: BenchRobot, task: Task) -> Executed:
    mode, arm = task.push.contact_mode.label, ""
    path: list[FloatArray] = []
    try:
        segments = robot.planner.plan(task.push, task.arrangement, robot.sample)
        arm = segments[0].arm
        began = robot.driver.now
        outcome = robot.run(segments, lambda step, _: path.append(robot.tip(arm)) if step.phase is Phase.PUSH else None)
    except SingulationError as refusal:
        return Executed(mode, arm, refusal.code, refusal.message, _NAN, _NAN, _NAN, 0)
    outcomes = robot.outcomes
    if outcome.code is not ResultCode.OK:
        robot.heal()
    line = next(one.trajectory for one in segments if one.phase is Phase.PUSH)
    if len(path) < 2 or line is None:
        return Executed(mode, arm, outcome.code, outcome.text, robot.driver.now - began, _NAN, _NAN, outcomes)
    deviation, missed = _deviation(np.array(path), robot.planner.tip(arm, line.start), robot.planner.tip(arm, line.end))
    return Executed(mode, arm, outcome.code, outcome.text, robot.driver.now - began, deviation, missed, outcomes)


def _deviation(path: FloatArray, start: FloatArray, end: FloatArray) -> tuple[float, float]:
    """Largest distance of (n, 3) points to a straight line, and of the last of them to its end [m]."""
    direction = (end - start) / np.linalg.norm(end - start)
    relative = path - start
    across = relative - np.outer(relative @ direction, direction)
    return float(np.sqrt((across**2).sum(axis=1)).max()), float(np.linalg.norm(path[-1] - end))
