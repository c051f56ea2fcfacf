"""How long planning takes, and how it grows with the number of objects."""

import contextlib
import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from singulation_core import SingulationError
from singulation_core.push_world import PushPhysics, simulate_pushes
from singulation_planner.benchmark.evaluate import plan
from singulation_planner.benchmark.generators import generate, groups
from singulation_planner.benchmark.markdown import table
from singulation_planner.benchmark.paper import label
from singulation_planner.benchmark.record import Job
from singulation_planner.benchmark.run import BRUTE_FORCE
from singulation_planner.benchmark.scenario import Scenario
from singulation_planner.benchmark.settings import Setting

_REPEATS = 25  # the fastest counts: what is slower is other work on the machine
_LARGE = 30  # from here on the growth shows; below, calling a planner at all takes longer than planning
_SIMULATED_UP_TO = 15  # Brute Force takes n^2 pushes


@dataclass(frozen=True, slots=True)
class Timing:
    """Median processor time [s] of a policy over scenes, for each number of objects; NaN where it was not measured."""

    policy: str
    counts: Sequence[int]
    seconds: Sequence[float]

    def growth(self, smallest: int = 0) -> tuple[float, float]:
        """(a, b) of the fit t = a n^b [s] over all measured n >= ``smallest``; NaN if there are fewer than two."""
        pairs = zip(self.counts, self.seconds, strict=True)
        known = [(n, t) for n, t in pairs if np.isfinite(t) and n >= smallest]
        if len(known) < 2:
            return float("nan"), float("nan")
        counts, seconds = np.log(np.array(known)).T
        exponent, logarithm = np.polyfit(counts, seconds, 1)
        return float(np.exp(logarithm)), float(exponent)


def measure(setting: Setting, policies: Sequence[str], counts: Sequence[int], scenes: int) -> list[Timing]:
    """Processor time of ``plan_push`` (single point) on one core."""
    worlds = {n: [generate(setting.generator, n, k % len(groups()), k) for k in range(scenes)] for n in counts}
    return [Timing(name, counts, [_median(setting, name, worlds[n], n) for n in counts]) for name in policies]


def _median(setting: Setting, policy: str, scenes: Sequence[Scenario], count: int) -> float:
    simulated = policy == BRUTE_FORCE
    if simulated and count > _SIMULATED_UP_TO:
        return float("nan")
    repeats = 1 if simulated else _REPEATS
    chosen = scenes[: len(groups())] if simulated else scenes
    plan_once(setting, scenes[0], policy)  # compile
    return float(np.median([min(plan_once(setting, one, policy) for _ in range(repeats)) for one in chosen]))


def plan_once(setting: Setting, scenario: Scenario, policy: str) -> float:
    """Processor time of one plan [s], with or without a result."""
    started = time.process_time()
    with contextlib.suppress(SingulationError):
        plan(setting, scenario, Job(policy))
    return time.process_time() - started


def measure_pushes(setting: Setting, presets: Sequence[str], counts: Sequence[int], pushes: int) -> list[Timing]:
    """Processor time of one simulated push in a row of many on the same scene."""
    result = []
    for preset in presets:
        physics = PushPhysics.named(preset)
        result.append(Timing(preset, counts, [_per_push(setting, physics, n, pushes) for n in counts]))
    return result


def _per_push(setting: Setting, physics: PushPhysics, count: int, pushes: int) -> float:
    times = []
    for group in groups():
        scenario = generate(setting.generator, count, group, group)
        planned = [plan(setting, scenario, Job(name)) for name in ("cluster_push", "min_overlap", "boundary_shear")]
        many = (planned * pushes)[:pushes]
        started = time.process_time()
        simulate_pushes(scenario.arrangement, many, physics, setting.pusher)
        times.append((time.process_time() - started) / pushes)
    return float(np.median(times))


def timing_table(timings: Sequence[Timing], what: str) -> str:
    """Markdown: milliseconds for each n, and the fitted growth."""
    if not timings:
        return ""
    header = [what, *[f"n = {n}" for n in timings[0].counts], "all n", f"n >= {_LARGE}"]
    rows = []
    for one in timings:
        cells = [f"{1e3 * t:.3g}" if np.isfinite(t) else "-" for t in one.seconds]
        rows.append([label(one.policy), *cells, _law(*one.growth()), _law(*one.growth(_LARGE))])
    return table(header, rows)


def _law(factor: float, exponent: float) -> str:
    return f"{1e6 * factor:.3g} µs · n^{exponent:.2f}" if np.isfinite(exponent) else "-"
