"""How many pushes it takes until the blocks are separated, and how often that succeeds."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from singulation_bringup.closed_loop.sets import SEPARATE
from singulation_bringup.closed_loop.table_three import frame_of
from singulation_bringup.closed_loop.trial import Record
from singulation_bringup.policy_choice import DEFAULT_MIN_GAP
from singulation_planner.benchmark.markdown import table
from singulation_planner.benchmark.statistics import Estimate, mean

_BY = ["policy", "contact_mode"]


def separated(records: Sequence[Record]) -> pd.DataFrame:
    """Results of the experiment with ``done`` (the loop says so) and ``real`` (it is so)."""
    found = frame_of(records, SEPARATE)
    found["done"] = found["code"] == "OK"
    found["real"] = found["done"] & (found["gap_after"] >= DEFAULT_MIN_GAP - _MEASURED)
    return found


_MEASURED = 0.002  # m; perception measures a gap within this


def table_separated(records: Sequence[Record]) -> str:
    """The report as Markdown; empty if there are no results."""
    found = separated(records)
    if found.empty:
        return ""
    counts = sorted(found["blocks"].unique())
    sets = len(found[["kind", "blocks", "seed"]].drop_duplicates())
    parts = [
        "## Pushes until separated\n",
        f"{sets} sets of mixed blocks; separated: the smallest gap is seen to be at least {1e3 * DEFAULT_MIN_GAP:.0f} "
        "mm. 'Really': the true gap is, too, within 2 mm. Pushes: mean over the sets that were separated. Where a push "
        "could not be performed, the coordinator asked its other policies; 'fall-backs' is the share of such pushes.\n",
        "### Share of sets separated, and pushes\n",
        table(
            ["", "sets", "separated", "really", "pushes", "fall-backs", *(f"{n} blocks" for n in counts)],
            [_row(name, part, counts) for name, part in _parts(found)],
        ),
        "### How the runs ended, and how the pushes ended\n",
        table(
            ["", "runs", "pushes"],
            [[name, _tally(part["code"].tolist()), _pushes(part["outcomes"].tolist())] for name, part in _parts(found)],
        ),
    ]
    return "\n".join(parts)


def _parts(found: pd.DataFrame) -> list[tuple[str, pd.DataFrame]]:
    """Policy and contact mode with their results, the most successful first."""
    groups = [(f"{mode}, {policy}", part) for (policy, mode), part in found.groupby(_BY)]
    return sorted(groups, key=lambda one: (-one[1]["done"].mean(), one[1]["pushes"].mean()))


def _row(name: str, part: pd.DataFrame, counts: Sequence[int]) -> list[str]:
    done = part[part["done"]]
    pushes = mean(done["pushes"].to_numpy(dtype=np.float64))
    fallbacks = part["fallbacks"].sum() / max(part["pushes"].sum(), 1)
    by_count = [part[part["blocks"] == n] for n in counts]
    return [
        name,
        str(len(part)),
        share_of(part["done"]).percent() + " %",
        share_of(part["real"]).percent() + " %",
        f"{pushes.value:.2f} ± {pushes.error:.2f}" if len(done) else "-",
        f"{100 * fallbacks:.1f} %",
        *(_of_count(one) for one in by_count),
    ]


def _of_count(part: pd.DataFrame) -> str:
    """Share separated and mean pushes of one number of blocks."""
    if part.empty:
        return "-"
    pushes = part.loc[part["done"], "pushes"]
    return f"{100 * part['done'].mean():.0f} %" + (f", {pushes.mean():.1f}" if len(pushes) else "")


def share_of(flags: "pd.Series[bool]") -> Estimate:
    """A share with its binomial standard error, by Agresti and Coull, so that all or none is no certainty."""
    n, k = len(flags), int(flags.sum())
    p = (k + 2.0) / (n + 4.0)
    return Estimate(k / n, float(np.sqrt(p * (1.0 - p) / (n + 4.0))))


def _tally(codes: Sequence[str]) -> str:
    return ", ".join(f"{name} {count}" for name, count in pd.Series(codes).value_counts().items())


def _pushes(outcomes: Sequence[str]) -> str:
    """Codes of all pushes of all runs."""
    pairs = [pair.rsplit(":", 1) for text in outcomes for pair in str(text).split()]
    totals = pd.DataFrame(pairs, columns=["code", "count"]).astype({"count": int}).groupby("code")["count"].sum()
    return ", ".join(f"{name} {count}" for name, count in totals.sort_values(ascending=False).items())
