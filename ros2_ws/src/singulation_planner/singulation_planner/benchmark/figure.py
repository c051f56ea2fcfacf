"""Figure 6 of the paper: gain against the number of objects."""

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from singulation_planner.benchmark.paper import in_order, label
from singulation_planner.benchmark.run import BRUTE_FORCE
from singulation_planner.benchmark.statistics import gains, mean

_REFERENCES = ("quasi_random", BRUTE_FORCE)


def figure_six(results: pd.DataFrame, path: Path) -> None:
    """Mean s' - s of each policy for each number of objects, over Quasi-random's (the paper's) and over Brute Force's.

    Bars are one standard error of the policy's own mean. (The paper draws the standard deviation over scenes.)
    """
    single = results[(results["contact_mode"] == "single_point") & (results["fits"] == "contact_mode")]
    gain = gains(single).droplevel(["contact_mode", "fits"], axis=1)
    references = [name for name in _REFERENCES if name in gain]
    figure = Figure(figsize=(6.5 * max(len(references), 1), 5.2), layout="constrained")
    FigureCanvasAgg(figure)
    for place, reference in enumerate(references, start=1):
        axes = figure.add_subplot(1, len(references), place)
        for rank, name in enumerate(in_order(set(gain.columns))):
            _draw(axes, gain, name, reference, rank)
        axes.set_xlabel("number of objects")
        axes.set_ylabel(f"mean s' - s relative to {label(reference)}")
        axes.grid(alpha=0.3)
    if figure.axes:
        handles, labels = figure.axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=5, fontsize=9)
    figure.savefig(path, dpi=130)


def _draw(axes: Axes, gain: pd.DataFrame, name: str, reference: str, rank: int) -> None:
    both = gain[gain[name].notna() & gain[reference].notna()]
    counts = sorted(set(both.index.get_level_values("n")))
    cells = [both.xs(count, level="n") for count in counts]
    bases = np.array([cell[reference].mean() for cell in cells])
    estimates = [mean(cell[name].to_numpy(dtype=float)) for cell in cells]
    ours = name == "cluster_push"
    axes.errorbar(
        np.array(counts) + 0.03 * (rank - 4),
        np.array([one.value for one in estimates]) / bases,
        np.array([one.error for one in estimates]) / np.abs(bases) if name != reference else None,
        label=label(name),
        color="black" if ours else f"C{rank}",
        linewidth=2.2 if ours else 1.2,
        marker="o",
        markersize=3,
        elinewidth=0.7,
    )
