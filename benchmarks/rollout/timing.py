"""Processor time of plans, on a machine that may be busy: the least of several repetitions of the same plan."""

from collections.abc import Sequence

import numpy as np
from benchmarks.rollout.planners import Planner
from benchmarks.rollout.plans import plan_one, recipes

from singulation_planner.benchmark.markdown import table

_REPETITIONS = 12


def timing_report(planners: Sequence[Planner], counts: Sequence[int]) -> str:
    """Markdown: for each planner and number of blocks the mean over scenes of the least time of a plan [ms]."""
    rows = []
    for planner in planners:
        cells = [planner.text]
        for n in counts:
            least = []
            for recipe in recipes(1, [n]):
                scenario = recipe.scene()
                least.append(min(plan_one(planner, scenario).seconds for _ in range(_REPETITIONS)))
            cells.append(f"{1e3 * np.mean(least):.2f}")
        rows.append(cells)
    return table(["ms of processor time", *(f"n = {n}" for n in counts)], rows)
