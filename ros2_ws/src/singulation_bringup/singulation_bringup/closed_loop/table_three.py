"""Table III beside the paper's, with standard errors and paired comparisons."""

from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd

from singulation_bringup.closed_loop.paper import AHEAD, IMPROVEMENT, TABLE_III
from singulation_bringup.closed_loop.sets import EASY, MIXED, MODES, ONE_PUSH, TABLE_POLICIES
from singulation_bringup.closed_loop.trial import COLUMNS, Record
from singulation_core.polygon import FloatArray
from singulation_planner.benchmark.markdown import table
from singulation_planner.benchmark.statistics import Estimate, mean, share

_GROUPS = ("easy", "hard", "average")
_COMPARED = ("quotient of the means, less one", "mean difference of s' - s", "sets better / worse / equal")
_EQUAL = 1e-9
_ROW = ["kind", "blocks", "seed"]


def frame_of(records: Sequence[Record], experiment: str) -> pd.DataFrame:
    """Results of one experiment with the change of s and its ratio, real and seen."""
    found = pd.DataFrame([one.as_row() for one in records if one.experiment == experiment], columns=list(COLUMNS))
    found["gain"] = found["s_after"] - found["s_before"]
    found["ratio"] = found["gain"] / found["s_before"]
    counted = (found["seen_before"] == found["blocks"]) & (found["seen_after"] == found["blocks"])
    found["seen_gain"] = (found["seen_s_after"] - found["seen_s_before"]).where(counted)
    found["seen_ratio"] = found["seen_gain"] / found["seen_s_before"]
    return found


def table_three(records: Sequence[Record]) -> str:
    """The report of the one-push experiment as Markdown; empty if there are no results of it."""
    found = frame_of(records, ONE_PUSH)
    if found.empty:
        return ""
    sets = found[_ROW].drop_duplicates()
    easy, hard = int(group_of(sets, "easy").sum()), int(group_of(sets, "hard").sum())
    parts = [
        "## Table III: one push in the closed loop\n",
        f"{len(sets)} sets in {len(sets[['kind', 'blocks']].drop_duplicates())} configurations; easy: three squares "
        f"({easy} sets), hard: mixed shapes ({hard} sets), average: all of them. Each number: mean ± standard error "
        "over sets. s in units of the mean bounding radius of the set; a push that could not be done counts as no "
        "change.\n",
        "### (s' - s) / s as the blocks really lie, and the paper's\n",
        _values(found, "ratio", lambda one: f"{one.value:.3f} ± {one.error:.3f}", paper=True),
        "### s' - s as the blocks really lie (free of units)\n",
        _values(found, "gain", lambda one: f"{one.value:.4f} ± {one.error:.4f}"),
        "### s' - s as perception sees it\n",
        _values(found, "seen_gain", lambda one: f"{one.value:.4f} ± {one.error:.4f}"),
        "### ClusterPush ahead of Cluster Diffusion, on the same sets\n",
        _ahead(found),
        "### Edge and two-point pushes against single point, on the same sets\n",
        _improvement(found),
        "### By configuration: s' - s of ClusterPush and Cluster Diffusion, single point\n",
        _by_configuration(found),
        "### How the pushes ended\n",
        _codes(found),
    ]
    return "\n".join(parts)


def group_of(found: pd.DataFrame, group: str) -> "pd.Series[bool]":
    """Which rows are easy, hard, or counted in the average."""
    if group == "easy":
        return (found["kind"] == EASY.kind) & (found["blocks"] == EASY.blocks)
    return (found["kind"] == MIXED) if group == "hard" else found["kind"].notna()


def paired_gains(found: pd.DataFrame, value: str) -> pd.DataFrame:
    """Sets (rows) by (policy, contact mode)."""
    return found.pivot(index=_ROW, columns=["policy", "contact_mode"], values=value)


def _values(found: pd.DataFrame, value: str, text: Callable[[Estimate], str], paper: bool = False) -> str:
    rows = []
    for (policy, mode), theirs in TABLE_III.items():
        of_row = found[(found["policy"] == policy) & (found["contact_mode"] == mode)]
        numbers = [text(mean(of_row.loc[group_of(of_row, group), value].to_numpy())) for group in _GROUPS]
        rows.append([f"{mode}, {policy}", *numbers, *([f"{one:.3f}" for one in theirs] if paper else [])])
    return table(["", *_GROUPS, *([f"paper: {group}" for group in _GROUPS] if paper else [])], rows)


def _ahead(found: pd.DataFrame) -> str:
    rows = []
    gains = paired_gains(found, "gain")
    groups = {group: group_of(gains.reset_index(), group).to_numpy() for group in _GROUPS}
    ours, theirs = TABLE_POLICIES
    for mode in MODES:
        for k, (group, chosen) in enumerate(groups.items()):
            paper = TABLE_III[ours, mode][k] / TABLE_III[theirs, mode][k] - 1.0
            said = f" (text: {100 * AHEAD[k]:+.1f} %)" if mode == "single_point" else ""
            compared = _compared(gains[ours, mode].to_numpy()[chosen], gains[theirs, mode].to_numpy()[chosen])
            rows.append([f"{mode}, {group}", *compared, f"{100 * paper:+.1f} %{said}"])
    return table(["", *_COMPARED, "paper"], rows)


def _improvement(found: pd.DataFrame) -> str:
    rows = []
    gains = paired_gains(found, "gain")
    for mode, text in IMPROVEMENT.items():
        for policies in (*((one,) for one in TABLE_POLICIES), TABLE_POLICIES):
            first, base = (sum(gains[one, kind].to_numpy() for one in policies) for kind in (mode, "single_point"))
            theirs = [sum(TABLE_III[one, kind][2] for one in policies) for kind in (mode, "single_point")]
            said = f" (text: {100 * text:+.1f} %)" if policies == TABLE_POLICIES else ""
            rows.append(
                [
                    f"{mode}, {' and '.join(policies)}",
                    *_compared(first, base),
                    f"{100 * (theirs[0] / theirs[1] - 1.0):+.1f} %{said}",
                ]
            )
    return table(["", *_COMPARED, "paper, average"], rows)


def _compared(first: FloatArray, second: FloatArray) -> list[str]:
    """Quotient of the means, mean difference, and on how many sets the first was better, worse or equal."""
    quotient, difference = share(first, second), mean(first - second)
    better, worse = int((first > second + _EQUAL).sum()), int((second > first + _EQUAL).sum())
    return [
        f"{100 * (quotient.value - 1.0):+.1f} ± {100 * quotient.error:.1f} %",
        f"{difference.value:+.4f} ± {difference.error:.4f}",
        f"{better} / {worse} / {len(first) - better - worse}",
    ]


def _by_configuration(found: pd.DataFrame) -> str:
    single = found[found["contact_mode"] == "single_point"]
    rows = []
    for (kind, blocks), part in single.groupby(["kind", "blocks"], sort=False):
        gains = [mean(part.loc[part["policy"] == one, "gain"].to_numpy()) for one in TABLE_POLICIES]
        s = mean(part["s_before"].to_numpy())
        rows.append([f"{kind}, {blocks}", f"{s.value:.3f}", *[f"{one.value:.4f} ± {one.error:.4f}" for one in gains]])
    return table(["configuration", "s before", *TABLE_POLICIES], rows)


def _codes(found: pd.DataFrame) -> str:
    """The loop ends with MAX_PUSHES_REACHED after its one push; what counts is the push's own code."""
    rows = []
    for (policy, mode), part in found.groupby(["policy", "contact_mode"], sort=False):
        done = part["outcomes"].replace("", np.nan).fillna(part["code"] + " before a push")
        counts = done.str.replace(":1", "", regex=False).value_counts()
        codes = ", ".join(f"{name} {count}" for name, count in counts.items())
        rows.append([f"{mode}, {policy}", str(len(part)), codes])
    return table(["", "pushes", "codes"], rows)
