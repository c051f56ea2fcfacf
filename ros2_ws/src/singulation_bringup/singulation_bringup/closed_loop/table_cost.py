"""What a look-plan-push-look cycle costs, and how fast the closed loop runs."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from singulation_bringup.closed_loop.trial import COLUMNS, Record
from singulation_planner.benchmark.markdown import table

# Stage -> what it is counted by.
_STAGES = {"segment": "looks", "plan": "pushes", "motion": "pushes", "other": "looks"}


def table_cost(records: Sequence[Record]) -> str:
    """Processor time as Markdown; empty if no pushes were done."""
    found = pd.DataFrame([one.as_row() for one in records], columns=list(COLUMNS))
    found = found[found["pushes"] > 0]
    if found.empty:
        return ""
    stages = {name: 1e3 * found[name] / found[by] for name, by in _STAGES.items()}
    stages["cycle without the robot's motion"] = sum(stages.values())
    stages["supervision, during the motion"] = 1e3 * found["supervise"] / found["pushes"]
    header = ["processor time [ms]", "median", "mean", "95 %", "largest run"]
    rows = [[name, *(f"{one:.1f}" for one in _figures(values))] for name, values in stages.items()]
    robot, wall = found["robot"].sum(), found["wall"].sum()
    computing = found[["segment", "plan", "motion", "other", "supervise", "simulate"]].sum().sum()
    return "\n".join(
        [
            "## Cost of a cycle\n",
            "Look, plan, push, look again: one segmentation, one plan, one motion plan, and the coordinator's own work "
            "(tracking, s, gaps). Means over each run, then over the runs.\n",
            table(header, rows),
            f"{int(found['pushes'].sum())} pushes, {robot:.0f} s of robot motion in {computing:.0f} s of processor "
            f"time ({robot / computing:.0f} times real time on one core) and {wall:.0f} s of processes' wall time.\n",
        ]
    )


def _figures(values: "pd.Series[float]") -> tuple[float, float, float, float]:
    numbers = values.to_numpy(dtype=np.float64)
    return float(np.median(numbers)), float(numbers.mean()), float(np.quantile(numbers, 0.95)), float(numbers.max())
