"""Tables and the figure of gain against time."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from benchmarks.rollout.planners import BRUTE_FORCE, Planner
from benchmarks.rollout.plans import Store

from singulation_planner.benchmark.evaluate import SceneRecipe
from singulation_planner.benchmark.markdown import table

_FEW, _MANY = 5, 15


def share_table(
    store: Store, scenes: Sequence[SceneRecipe], planners: Sequence[Planner], judges: Mapping[str, str]
) -> str:
    """Markdown: for each planner its processor time and its share of Brute Force's mean gain, in each judge.

    Args:
        store: plans and gains.
        scenes: of the table; those without a Brute Force plan are left out.
        planners: rows.
        judges: texts of the columns by name.
    """
    known = [one for one in scenes if all((one.key, BRUTE_FORCE.name, judge) in store.gains for judge in judges)]
    few, many = [one for one in known if one.n <= _FEW], [one for one in known if one.n == _MANY]
    header = [f"{len(known)} scenes", f"ms, n <= {_FEW}", f"ms, n = {_MANY}", *judges.values()]
    header += [f"{judges[first]}, {text}" for first in list(judges)[:1] for text in (f"n <= {_FEW}", f"n = {_MANY}")]
    rows = []
    for planner in planners:
        if not all((one.key, planner.name, judge) in store.gains for one in known for judge in judges):
            continue
        first = next(iter(judges))
        shares = [_share(store, known, planner, judge) for judge in judges]
        shares += [_share(store, part, planner, first) for part in (few, many)]
        rows.append([planner.text, *(_time(store, part, planner) for part in (few, many)), *shares])
    return table(header, rows)


def _gains(store: Store, scenes: Sequence[SceneRecipe], planner: Planner, judge: str) -> np.ndarray:
    return np.array([store.gains[one.key, planner.name, judge] for one in scenes])


def _share(store: Store, scenes: Sequence[SceneRecipe], planner: Planner, judge: str) -> str:
    """Mean gain over that of Brute Force, with the standard error over scenes of the ratio."""
    if not scenes:
        return "-"
    gains, whole = (_gains(store, scenes, one, judge) for one in (planner, BRUTE_FORCE))
    ratio = gains.mean() / whole.mean()
    error = (gains - ratio * whole).std() / whole.mean() / np.sqrt(len(scenes))
    return f"{100.0 * ratio:.1f} ± {100.0 * error:.1f} %"


def _time(store: Store, scenes: Sequence[SceneRecipe], planner: Planner) -> str:
    if not scenes:
        return "-"
    return f"{1e3 * float(np.median([store.plans[one.key, planner.name].seconds for one in scenes])):.2f}"


def frontier(store: Store, scenes: Sequence[SceneRecipe], planners: Sequence[Planner], judge: str, path: Path) -> None:
    """Figure: share of Brute Force's gain against processor time."""
    import matplotlib.pyplot as plt  # noqa: PLC0415  takes a second

    known = [one for one in scenes if (one.key, BRUTE_FORCE.name, judge) in store.gains]
    figure, axes = plt.subplots(figsize=(7.5, 4.5), layout="constrained")
    points = {one: _point(store, known, one, judge) for one in planners}
    curve = np.array([points[one] for one in planners if one.policy == "rollout_push" and points[one] is not None])
    axes.errorbar(
        curve[:, 0], curve[:, 1], yerr=curve[:, 2], marker="o", capsize=2, label="Rollout Push, score alone to 100 ms"
    )
    for planner, point in points.items():
        if planner.policy != "rollout_push" and point is not None:
            time, share, error = point
            axes.errorbar(time, share, yerr=error, marker="s", capsize=2, linestyle="none", label=planner.text)
    axes.axhline(100.0, color="0.7", linewidth=0.8, zorder=0)
    axes.set(
        xscale="log", xlabel="processor time for a plan [ms], median", ylabel="mean gain s' - s [% of Brute Force]"
    )
    axes.set_title(f"{len(known)} scenes of 3 to 15 blocks, judged in fine pymunk", fontsize=10)
    axes.legend(loc="lower right", fontsize=9)
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=120)
    plt.close(figure)


def _point(
    store: Store, scenes: Sequence[SceneRecipe], planner: Planner, judge: str
) -> tuple[float, float, float] | None:
    """Milliseconds, per cent of Brute Force, standard error."""
    if not scenes or not all((one.key, planner.name, judge) in store.gains for one in scenes):
        return None
    gains, whole = (_gains(store, scenes, one, judge) for one in (planner, BRUTE_FORCE))
    ratio = gains.mean() / whole.mean()
    error = (gains - ratio * whole).std() / whole.mean() / np.sqrt(len(scenes))
    times = [store.plans[one.key, planner.name].seconds for one in scenes]
    return 1e3 * float(np.median(times)), 100.0 * float(ratio), 100.0 * float(error)
