"""Tables and the figure of gain against time."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from benchmarks.rollout.planners import BRUTE_FORCE, LONG, Planner
from benchmarks.rollout.plans import Store

from singulation_core.polygon import FloatArray
from singulation_planner.benchmark.evaluate import SceneRecipe
from singulation_planner.benchmark.markdown import table

_FEW, _MANY = 5, 15


def share_table(
    store: Store,
    scenes: Sequence[SceneRecipe],
    planners: Sequence[Planner],
    judges: Mapping[str, str],
    reference: Planner = BRUTE_FORCE,
) -> str:
    """Markdown: for each planner its processor time and its share of the reference's mean gain, in each judge.

    Args:
        store: plans and gains.
        scenes: of the table; those without a plan of the reference are left out.
        planners: rows.
        judges: texts of the columns by name.
        reference: 100 %.
    """
    known = [one for one in scenes if all((one.key, reference.name, judge) in store.gains for judge in judges)]
    few, many = [one for one in known if one.n <= _FEW], [one for one in known if one.n == _MANY]
    header = [f"{len(known)} scenes", f"ms, n <= {_FEW}", f"ms, n = {_MANY}", *judges.values()]
    header += [f"{judges[first]}, {text}" for first in list(judges)[:1] for text in (f"n <= {_FEW}", f"n = {_MANY}")]
    rows = []
    for planner in planners:
        if not known or not all((one.key, planner.name, judge) in store.gains for one in known for judge in judges):
            continue
        first = next(iter(judges))
        shares = [_share(store, known, planner, judge, reference) for judge in judges]
        shares += [_share(store, part, planner, first, reference) for part in (few, many)]
        rows.append([planner.text, *(_time(store, part, planner) for part in (few, many)), *shares])
    return table(header, rows)


def hindsight(
    store: Store,
    scenes: Sequence[SceneRecipe],
    planners: Sequence[Planner],
    judges: Mapping[str, str],
    reference: Planner = BRUTE_FORCE,
) -> str:
    """What the best of all planners' pushes gains, chosen for each scene by what the judge says: more than any choice
    between them can.
    """
    text = ""
    for judge, name in judges.items():
        known = [one for one in scenes if (one.key, reference.name, judge) in store.gains]
        rows = [one for one in planners if all((scene.key, one.name, judge) in store.gains for scene in known)]
        if known and rows:
            best = np.max([_gains(store, known, one, judge) for one in rows], axis=0)
            share = 100.0 * best.mean() / _gains(store, known, reference, judge).mean()
            text += f"\nThe best push of all rows, chosen for each scene in hindsight ({name}): {share:.1f} %\n"
    return text


def _gains(store: Store, scenes: Sequence[SceneRecipe], planner: Planner, judge: str) -> FloatArray:
    return np.array([store.gains[one.key, planner.name, judge] for one in scenes])


def _share(store: Store, scenes: Sequence[SceneRecipe], planner: Planner, judge: str, reference: Planner) -> str:
    """Mean gain over that of the reference, with the standard error over scenes of the ratio."""
    if not scenes:
        return "-"
    share, error = _ratio(store, scenes, planner, judge, reference)
    return f"{share:.1f} ± {error:.1f} %"


def _ratio(
    store: Store, scenes: Sequence[SceneRecipe], planner: Planner, judge: str, reference: Planner
) -> tuple[float, float]:
    gains, whole = (_gains(store, scenes, one, judge) for one in (planner, reference))
    ratio = gains.mean() / whole.mean()
    error = (gains - ratio * whole).std() / whole.mean() / np.sqrt(len(scenes))
    return 100.0 * float(ratio), 100.0 * float(error)


def _time(store: Store, scenes: Sequence[SceneRecipe], planner: Planner) -> str:
    if not scenes:
        return "-"
    return f"{1e3 * float(np.median([store.plans[one.key, planner.name].seconds for one in scenes])):.2f}"


def frontier(
    store: Store,
    scenes: Sequence[SceneRecipe],
    planners: Sequence[Planner],
    path: Path,
    reference: Planner = BRUTE_FORCE,
    judge: str = "pymunk",
) -> None:
    """Figure: share of the reference's gain against processor time."""
    import matplotlib.pyplot as plt  # noqa: PLC0415  takes a second

    known = [one for one in scenes if (one.key, reference.name, judge) in store.gains]
    points = {}
    for one in planners:  # the longest budgets were given on some of the scenes only
        mine = [scene for scene in known if (scene.key, one.name, judge) in store.gains]
        if mine:
            points[one] = _point(store, mine, one, judge, reference)
    curve = np.array(sorted(points[one] for one in planners if one in points and one.policy == "rollout_push"))
    figure, axes = plt.subplots(figsize=(7.5, 4.5), layout="constrained")
    if len(curve):
        axes.errorbar(curve[:, 0], curve[:, 1], yerr=curve[:, 2], marker="o", capsize=2, label="Rollout Push")
    for planner, (milliseconds, share, error) in points.items():
        if planner.policy != "rollout_push":
            axes.errorbar(milliseconds, share, yerr=error, marker="s", capsize=2, linestyle="none", label=planner.text)
    axes.axhline(100.0, color="0.7", linewidth=0.8, zorder=0)
    axes.set(xscale="log", xlabel="processor time for a plan [ms], median")
    axes.set_ylabel(f"mean gain s' - s [% of {reference.text}]", fontsize=9)
    counts = [one.n for one in known]
    title = f"{len(known)} scenes of {min(counts, default=0)} to {max(counts, default=0)} blocks, judged in fine pymunk"
    if any(one in points for one in LONG if one.policy == "rollout_push"):
        title += ", from 1 s on 52 of them"
    axes.set_title(title, fontsize=10)
    axes.legend(loc="lower right", fontsize=9)
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=120)
    plt.close(figure)


def _point(
    store: Store, scenes: Sequence[SceneRecipe], planner: Planner, judge: str, reference: Planner
) -> tuple[float, float, float]:
    """Milliseconds, per cent of the reference, standard error."""
    times = [store.plans[one.key, planner.name].seconds for one in scenes]
    return (1e3 * float(np.median(times)), *_ratio(store, scenes, planner, judge, reference))
