"""Table III under other readings of what the paper leaves open: why figures differ, by experiment."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pandas as pd

from singulation_bringup.closed_loop.runs import run_all
from singulation_bringup.closed_loop.sets import MODES, ONE_PUSH, TABLE_POLICIES, one_push_trials
from singulation_bringup.closed_loop.setting import CellSetting
from singulation_bringup.closed_loop.table_three import frame_of, group_of, paired_gains
from singulation_bringup.closed_loop.trial import Record
from singulation_planner.benchmark.markdown import table
from singulation_planner.benchmark.statistics import mean, share

_EQUAL: dict[str, object] = {"fits": "every_mode"}
_BACK: dict[str, object] = {"retreat": 0.1}
_LONG: dict[str, object] = {"push_distance_factor": 2.0}
READINGS: Mapping[str, Mapping[str, object]] = MappingProxyType(
    {
        "as shipped": {},
        "equal pushes": _EQUAL,
        "start moved back": _BACK,
        "twice the travel": _LONG,
        "twice the travel, equal pushes": _LONG | _EQUAL,
        "twice the travel, start moved back": _LONG | _BACK,
    }
)
_TEXT = """## Table III under other readings

The paper gives neither the length of its physical pushes, nor what happens where a start is blocked, nor whether the
three contact modes did the same pushes. 'Equal pushes': only pushes whose start is free for the jaws of every mode.
'Start moved back': a blocked start moves back on its line until it is free, by 100 mm at most, and the travel stays;
otherwise the policy's next push is taken. Travel: one mean bounding radius after contact, or two.
"""


def run_readings(sets: int, out: Path, workers: int) -> str:
    """Run what is missing of every reading, each in a folder of its own; the comparison as Markdown.

    Raises:
        SingulationError: as ``run_all``.
    """
    trials = one_push_trials(sets)
    results = {}
    for name, changes in READINGS.items():
        setting = replace(CellSetting(), **changes)  # type: ignore[arg-type]  # names and types stand above
        results[name] = run_all(trials, setting, out / name.replace(", ", "_").replace(" ", "_"), workers)
    text = table_readings(results)
    (out / "readings.md").write_text(text)
    return text


def table_readings(results: Mapping[str, Sequence[Record]]) -> str:
    """The comparison as Markdown."""
    gains = {name: paired_gains(frame_of(records, ONE_PUSH), "gain") for name, records in results.items()}
    ratios = {name: paired_gains(frame_of(records, ONE_PUSH), "ratio") for name, records in results.items()}
    level = [
        [name, *(_estimate(found[policy, mode]) for policy in TABLE_POLICIES for mode in MODES)]
        for name, found in ratios.items()
    ]
    ahead = [
        [name, *(_ahead(found, mode, group) for mode in MODES[:1] for group in ("easy", "hard", "average"))]
        + [_ahead(found, mode, "average") for mode in MODES[1:]]
        for name, found in gains.items()
    ]
    compared = [(policy, mode) for policy in TABLE_POLICIES for mode in MODES[1:]]
    modes = [
        [name, *(_quotient(found[policy, mode], found[policy, MODES[0]]) for policy, mode in compared)]
        for name, found in gains.items()
    ]
    return "\n".join(
        [
            _TEXT,
            "### (s' - s) / s, average over all sets\n",
            table(["reading", *(f"{mode}, {policy}" for policy in TABLE_POLICIES for mode in MODES)], level),
            "### ClusterPush ahead of Cluster Diffusion\n",
            table(["reading", "single point, easy", "hard", "average", "edge, average", "two-point, average"], ahead),
            "### Edge and two-point against single point, average\n",
            table(["reading", *(f"{policy}, {mode}" for policy, mode in compared)], modes),
        ]
    )


def _estimate(values: "pd.Series[float]") -> str:
    found = mean(values.to_numpy())
    return f"{found.value:.3f} ± {found.error:.3f}"


def _ahead(gains: pd.DataFrame, mode: str, group: str) -> str:
    chosen = gains[group_of(gains.reset_index(), group).to_numpy()]
    return _quotient(chosen[TABLE_POLICIES[0], mode], chosen[TABLE_POLICIES[1], mode])


def _quotient(first: "pd.Series[float]", second: "pd.Series[float]") -> str:
    found = share(np.asarray(first), np.asarray(second))
    return f"{100 * (found.value - 1.0):+.1f} ± {100 * found.error:.1f} %"
