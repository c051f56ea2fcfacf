"""One run of the loop on one set of blocks: what is asked, and what came of it."""

import math
import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from functools import cache
from typing import Any

from singulation_bringup.closed_loop.library_cell import LibraryCell
from singulation_bringup.closed_loop.setting import CellSetting
from singulation_bringup.singulation_loop import SingulationGoal, SingulationLoop
from singulation_bringup.singulation_progress import SingulationResult
from singulation_core import Arrangement, contact_mode, singulation_distance, smallest_gap
from singulation_perception import warm_up as warm_perception
from singulation_planner import warm_up as warm_planner
from singulation_sim.camera import warm_up as warm_camera

Key = tuple[str, str, int, int, str, str]


@dataclass(frozen=True, slots=True)
class Trial:
    """What is asked.

    Args:
        experiment: name of what it belongs to.
        kind: of the blocks, one of the scenes of ``singulation_sim``.
        blocks: how many.
        seed: of scene, noise, physics and policy.
        policy, contact_mode: how to push.
        max_pushes: at most so many.
        min_gap: that ends it [m].
        fallbacks: policies asked when a push cannot be performed.
    """

    experiment: str
    kind: str
    blocks: int
    seed: int
    policy: str
    contact_mode: str
    max_pushes: int
    min_gap: float
    fallbacks: tuple[str, ...] = ()

    @property
    def key(self) -> Key:
        """What makes it unique among the trials of one setting."""
        return self.experiment, self.kind, self.blocks, self.seed, self.policy, self.contact_mode


@dataclass(frozen=True, slots=True)
class Record:
    """What came of a trial; one line of the results.

    Args:
        code: of the loop, by name.
        pushes: that were tried.
        outcomes: their codes and how often, for example ``OK:4 COLLISION_STOP:1``.
        fallbacks: how many of them another policy planned.
        unit: length that counts as 1 in s: the mean bounding radius of the set [m].
        s_before, s_after: s(A) of the blocks as they really lie.
        seen_s_before, seen_s_after: as perception sees them, in units of the bounding radii it sees.
        seen_before, seen_after: number of blocks perception sees.
        gap_before, gap_after: smallest gap as it really is [m].
        seen_gap_after: as perception sees it [m].
        looks: clouds.
        robot: simulated time in motions [s].
        segment, plan, motion, supervise, other: processor time [s]; ``supervise`` while the robot moves, ``other`` is
            the coordinator's own outside the motion.
        simulate: processor time of what stands for hardware [s].
        wall: time of this machine [s].
        text: of the loop.
    """

    experiment: str
    kind: str
    blocks: int
    seed: int
    policy: str
    contact_mode: str
    code: str
    pushes: int
    outcomes: str
    fallbacks: int
    unit: float
    s_before: float
    s_after: float
    seen_s_before: float
    seen_s_after: float
    seen_before: int
    seen_after: int
    gap_before: float
    gap_after: float
    seen_gap_after: float
    looks: int
    robot: float
    segment: float
    plan: float
    motion: float
    supervise: float
    other: float
    simulate: float
    wall: float
    text: str

    @property
    def key(self) -> Key:
        """As the trial's."""
        return self.experiment, self.kind, self.blocks, self.seed, self.policy, self.contact_mode

    def as_row(self) -> dict[str, Any]:
        """Column name to value."""
        return asdict(self)


COLUMNS = tuple(one.name for one in fields(Record))


@cache
def _warm() -> None:
    """Compiled code is loaded before anything is timed."""
    warm_camera()
    warm_perception()
    warm_planner()
    setting = CellSetting()
    run(Trial("", "squares", 3, 0, "cluster_push", "single_point", 1, 1.0), setting)


def evaluate(task: tuple[Trial, CellSetting]) -> Record:
    """Run one trial. It cannot end a long run: a defect becomes its code."""
    _warm()
    return run(*task)


def run(trial: Trial, setting: CellSetting) -> Record:
    """Run one trial.

    Raises:
        SingulationError: the set cannot be made.
    """
    cell = LibraryCell(setting.simulated_cell(trial.kind, trial.blocks, trial.seed), setting, trial.seed)
    before = cell.truth()
    goal = SingulationGoal(
        trial.max_pushes, trial.min_gap, trial.policy, contact_mode(trial.contact_mode), trial.fallbacks
    )
    wall, started = time.perf_counter(), time.process_time()
    try:
        result = SingulationLoop(cell, goal).run()
        code, text = result.code.name, result.message
    except Exception as error:
        result, code, text = None, "INTERNAL", f"{type(error).__name__}: {error}"
    values: dict[str, Any] = {name: getattr(trial, name) for name in Trial.__slots__ if name in COLUMNS}
    values |= _stages(cell.stopwatch.seconds, time.process_time() - started)
    values |= _pushes_of(result, trial) | _distances(before, cell.truth()) | _seen(result)
    values |= {"code": code, "text": text, "looks": cell.looks, "robot": cell.robot.moved}
    return Record(**values, wall=time.perf_counter() - wall)


def _stages(seconds: Mapping[str, float], total: float) -> dict[str, float]:
    """Processor time by stage; ``moving`` holds what passes during a motion, timing included."""
    known = {name: seconds.get(name, 0.0) for name in ("segment", "plan", "motion", "render", "moving", "supervise")}
    outside = sum(known[name] for name in ("segment", "plan", "motion", "render", "moving"))
    simulate = known.pop("render") + known.pop("moving") - known["supervise"]
    return {**known, "other": total - outside, "simulate": simulate}


def _pushes_of(result: SingulationResult | None, trial: Trial) -> dict[str, Any]:
    outcomes = [] if result is None else result.progress.outcomes
    codes = Counter(one.code.name for one in outcomes)
    return {
        "pushes": len(outcomes),
        "outcomes": " ".join(f"{name}:{count}" for name, count in codes.most_common()),
        "fallbacks": sum(one.push.policy != trial.policy for one in outcomes),
    }


def _distances(before: Arrangement, after: Arrangement) -> dict[str, float]:
    """As the blocks really lie, in units of their mean bounding radius."""
    unit = float(before.bounding_radii.mean())
    return {
        "unit": unit,
        "s_before": singulation_distance(before, unit),
        "s_after": singulation_distance(after, unit),
        "gap_before": smallest_gap(before),
        "gap_after": smallest_gap(after),
    }


def _seen(result: SingulationResult | None) -> dict[str, Any]:
    progress = None if result is None else result.progress
    if progress is None or not progress.distances:
        nothing = dict.fromkeys(("seen_s_before", "seen_s_after", "seen_gap_after"), math.nan)
        return {**nothing, "seen_before": 0, "seen_after": 0}
    return {
        "seen_s_before": progress.distances[0],
        "seen_s_after": progress.distances[-1],
        "seen_gap_after": progress.gaps[-1],
        "seen_before": progress.counts[0],
        "seen_after": progress.counts[-1],
    }
