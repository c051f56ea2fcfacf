"""Share of sets that are separated after so many pushes, for each policy."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

_COLOURS = mpl.colormaps["tab20"].colors  # type: ignore[attr-defined]  # a ListedColormap
_MODES = ("single_point", "edge", "two_point")


def picture_of_separation(path: Path, found: pd.DataFrame, most: int) -> None:
    """One panel for each contact mode.

    Args:
        path: PNG to write.
        found: as ``separated`` gives it.
        most: pushes a run may have.
    """
    modes = [mode for mode in _MODES if mode in set(found["contact_mode"])]
    figure = Figure(figsize=(4.6 * len(modes) + 2.4, 4.4), layout="constrained")
    panels = figure.subplots(1, len(modes), squeeze=False, sharey=True)[0]
    policies = sorted(found["policy"].unique())
    for axes, mode in zip(panels, modes, strict=True):
        of_mode = found[found["contact_mode"] == mode]
        for k, policy in enumerate(policies):
            part = of_mode[of_mode["policy"] == policy]
            if len(part):
                axes.step(*_steps(part, most), where="post", color=_COLOURS[k % 20], label=policy.replace("_", " "))
        axes.set_title(mode.replace("_", " "))
        axes.set_xlabel("pushes")
        axes.set_xlim(0, most)
        axes.set_ylim(0, 101)
        axes.grid(alpha=0.3)
    panels[0].set_ylabel("sets separated [%]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right upper", fontsize=9)
    figure.savefig(path, dpi=110)


def _steps(part: pd.DataFrame, most: int) -> tuple[np.ndarray, np.ndarray]:
    pushes = np.arange(most + 1)
    needed = part.loc[part["done"], "pushes"].to_numpy()
    return pushes, 100.0 * (needed[None] <= pushes[:, None]).sum(axis=1) / len(part)
