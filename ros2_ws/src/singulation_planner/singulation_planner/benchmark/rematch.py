"""Our policies against the authors' code on the authors' scenes."""

from pathlib import Path
from typing import Any

import pandas as pd

from singulation_core import SingulationError, singulation_distance
from singulation_core.push_world import simulate_push
from singulation_planner.benchmark.evaluate import plan
from singulation_planner.benchmark.generators import UNIT
from singulation_planner.benchmark.markdown import table
from singulation_planner.benchmark.paper import CASES, in_order, label
from singulation_planner.benchmark.record import Job
from singulation_planner.benchmark.scenario import Scenario, read_scenarios
from singulation_planner.benchmark.settings import Setting, find_setting
from singulation_planner.benchmark.statistics import share

_THEIR_NAMES = {
    "quasi_random": "quasi_random",
    "boundaryShear": "boundary_shear",
    "clusterDiffusion": "cluster_diffusion",
    "center_object_removal": "center_object_removal",
    "min_contact_range": "min_contact_range",
    "min_overlap": "min_overlap",
    "two_cluster_separation": "two_cluster_separation",
    "clusterPush2D": "cluster_push",
}


def rematch(path: Path) -> pd.DataFrame:
    """Gains of single-point pushes on the scenes of a file made with the authors' code.

    Returns:
        Columns scenario, n, group, policy, theirs (s' - s of the push of the authors' code in their simulator), ours
        (of our plan in our simulator, in the authors' setting), brute (of their Brute Force; NaN where it did not run).

    Raises:
        SingulationError: as ``read_scenarios``.
    """
    setting = find_setting("authors")
    rows: list[dict[str, Any]] = []
    for scenario, record in read_scenarios(path, UNIT):
        best = record.get("brute_force")
        for theirs, ours in _THEIR_NAMES.items():
            outcome = record["policies"].get(theirs)
            if outcome is not None:
                rows.append(
                    {
                        "scenario": scenario.key,
                        "n": scenario.n,
                        "group": scenario.group,
                        "policy": ours,
                        "theirs": _change(outcome["single_point"]),
                        "ours": _gain(setting, scenario, ours),
                        "brute": _change(best) if best else float("nan"),
                    }
                )
    return pd.DataFrame(rows)


def _change(outcome: dict[str, float]) -> float:
    return outcome["after"] - outcome["before"]


def _gain(setting: Setting, scenario: Scenario, policy: str) -> float:
    """s' - s; 0 where there is no push."""
    try:
        push = plan(setting, scenario, Job(policy))
        after = simulate_push(scenario.arrangement, push, setting.physics, setting.pusher)
    except SingulationError:
        return 0.0
    return singulation_distance(after, scenario.unit) - singulation_distance(scenario.arrangement, scenario.unit)


def rematch_table(rows: pd.DataFrame) -> str:
    """Ours in percent of theirs over all scenes, and both in percent of their Brute Force where it ran."""
    header = ["policy", "scenes", *[f"{case}: ours / theirs [%]" for case in CASES], "theirs [% of their BF]", "ours"]
    lines = []
    for name in in_order(set(rows["policy"])):
        own = rows[rows["policy"] == name]
        cells = [_ratio(own.query(query), "ours", "theirs") for query in CASES.values()]
        best = [_ratio(own, column, "brute") for column in ("theirs", "ours")]
        lines.append([label(name), str(len(own)), *cells, *best])
    return table(header, lines)


def _ratio(rows: pd.DataFrame, top: str, bottom: str) -> str:
    return share(rows[top].to_numpy(dtype=float), rows[bottom].to_numpy(dtype=float)).percent()
