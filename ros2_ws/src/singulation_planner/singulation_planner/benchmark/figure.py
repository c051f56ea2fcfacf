"""Figure 6 of the paper: gain against the number of objects."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from singulation_planner.benchmark.paper import in_order, label
from singulation_planner.benchmark.run import BRUTE_FORCE
from singulation_planner.benchmark.statistics import Estimate, gains, share

_REFERENCE = "quasi_random"


def figure_six(results: pd.DataFrame, path: Path) -> None:
    """Mean s' - s of each policy for each number of objects, over Quasi-random's (the paper's) and over Brute Force's.

    Bars are one standard error of the mean ratio. (The paper draws the standard deviation over scenes.)
    """
    single = results[(results["contact_mode"] == "single_point") & (results["fits"] == "contact_mode")]
    gain = gains(single).droplevel(["contact_mode", "fits"], axis=1)
    references = [name for name in (_REFERENCE, BRUTE_FORCE) if name in gain]
    figure = Figure(figsize=(6.5 * max(len(references), 1), 4.8), layout="constrained")
    FigureCanvasAgg(figure)
    for place, reference in enumerate(references, start=1):
        axes = figure.add_subplot(1, len(references), place)
        for rank, name in enumerate(in_order(set(gain.columns))):
            if name != reference and (name != BRUTE_FORCE or reference == _REFERENCE):
                _draw(axes, gain, name, reference, rank)
        axes.set_xlabel("number of objects")
        axes.set_ylabel(f"mean s' - s relative to {label(reference)}")
        axes.grid(alpha=0.3)
    figure.axes[-1].legend(fontsize=8, ncols=2) if figure.axes else None
    figure.savefig(path, dpi=150)


def _draw(axes: Axes, gain: pd.DataFrame, name: str, reference: str, rank: int) -> None:
    counts = sorted(set(gain.index.get_level_values("n")))
    points: list[Estimate] = []
    for count in counts:
        cell = gain.xs(count, level="n")
        points.append(share(cell[name].to_numpy(dtype=float), cell[reference].to_numpy(dtype=float)))
    ours = name == "cluster_push"
    axes.errorbar(
        np.array(counts) + 0.04 * (rank - 4),
        [point.value for point in points],
        [point.error for point in points],
        label=label(name),
        color=f"C{rank}" if not ours else "black",
        linewidth=2.2 if ours else 1.2,
        marker="o",
        markersize=3,
        elinewidth=0.7,
    )
