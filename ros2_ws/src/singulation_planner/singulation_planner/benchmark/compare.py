"""The authors' simulator against ours, on the pushes that the authors' code planned."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from singulation_core import Arrangement, ContactMode, Push, PusherGeometry
from singulation_core.polygon import FloatArray, separation
from singulation_core.push_world import PushPhysics, simulate_pushes
from singulation_planner.benchmark.markdown import table
from singulation_planner.benchmark.scenario import Scenario, read_scenarios

# Lengths in bounding radii, which these files have as unit.
_JAWS = PusherGeometry(tip_radius=0.1, edge_width=0.3, edge_thickness=0.2)
_TWO_POINTS = 0.6
_TRAVEL = 4.1  # "4": their pusher stops in the step after 4 units are reached, as free blocks show (they go 4.6)
_RETREAT = 0.1  # a start is moved back in such steps until it is free
# Length and width of what must be free there: 0.3 x 0.2, across for an edge, along else (as the outcomes show).
_FREE = {"single_point": (0.3, 0.2), "edge": (0.2, 0.3), "two_point": (0.3, 0.2)}
_SKIN = 0.02  # Box2D calls two polygons touching that are nearer than twice its skin of 0.01
_MODES = {"single_point": ContactMode.SINGLE_POINT, "edge": ContactMode.EDGE, "two_point": ContactMode.TWO_POINT}


@dataclass(frozen=True, slots=True)
class _Planned:
    policy: str
    start: FloatArray
    direction: FloatArray
    retreat: float  # by which the start was moved back until it was free
    outcome: dict[str, Any]


def compare(path: Path) -> pd.DataFrame:
    """Gains of both simulators for every push of a file made with the authors' code.

    Returns:
        Columns scenario, n, group, policy, mode, code, theirs, ours (s' - s), position_error (of the worst block, in
        bounding radii; NaN where the file has no poses). ``code`` is PATH_BLOCKED where the wider jaws would start on a
        block, which their simulator does not mind.

    Raises:
        SingulationError: as ``read_scenarios``.
    """
    rows: list[dict[str, Any]] = []
    for scenario, record in read_scenarios(path, 1.0):
        for mode in _MODES:
            rows += _rows(scenario, record, mode, list(_planned(scenario.arrangement, record["policies"], mode)))
    return pd.DataFrame(rows)


def _planned(arrangement: Arrangement, policies: dict[str, Any], mode: str) -> Iterator[_Planned]:
    for name, outcome in policies.items():
        if outcome is None or not outcome.get(mode):
            continue
        start, end = np.array(outcome["start"]), np.array(outcome["end"])
        direction = (end - start) / np.hypot(*(end - start))
        free = _moved_back(arrangement, start, direction, *_FREE[mode])
        yield _Planned(name, free, direction, float(np.hypot(*(free - start))), outcome)


def _moved_back(
    arrangement: Arrangement, start: FloatArray, direction: FloatArray, length: float, width: float
) -> FloatArray:
    aside = np.array((-direction[1], direction[0])) * 0.5 * width
    ahead = direction * 0.5 * length
    footprint = np.array((-ahead - aside, ahead - aside, ahead + aside, -ahead + aside))
    position = start
    while any(
        np.hypot(*(item.centroid - position)) < item.bounding_radius + 0.3
        and separation(item.outline, footprint + position) <= _SKIN
        for item in arrangement.objects
    ):
        position = position - _RETREAT * direction
    return position


def _rows(scenario: Scenario, record: dict[str, Any], mode: str, planned: Sequence[_Planned]) -> list[dict[str, Any]]:
    pushes = [_push(one, mode) for one in planned]
    outcomes = simulate_pushes(scenario.arrangement, pushes, PushPhysics.authors(), _JAWS, 1.0)
    origins = np.array([item["position"] for item in record["objects"]])
    rows = []
    for one, poses, code in zip(planned, outcomes.poses, outcomes.codes, strict=True):
        theirs, ends = one.outcome[mode], _carried(origins, scenario.arrangement.centroids, poses)
        rows.append(
            {
                "scenario": scenario.key,
                "n": scenario.n,
                "group": scenario.group,
                "policy": one.policy,
                "mode": mode,
                "code": code.name,
                "theirs": theirs["after"] - theirs["before"],
                "ours": _spread(ends) - _spread(origins),
                "position_error": _worst(ends, theirs.get("poses")),
            }
        )
    return rows


def _push(planned: _Planned, mode: str) -> Push:
    start, travel = planned.start, _TRAVEL
    width = {"single_point": 0.0, "edge": _JAWS.edge_width, "two_point": _TWO_POINTS}[mode]
    if mode == "edge":  # theirs is given by the middle of the jaw, ours by its front
        start = start + 0.5 * _JAWS.edge_thickness * planned.direction
    if mode == "two_point":  # theirs measures the travel from where the start was before it was moved back
        travel += planned.retreat
    return Push(start, start + travel * planned.direction, _MODES[mode], width)


def _carried(origins: FloatArray, centroids: FloatArray, poses: FloatArray) -> FloatArray:
    """(n, 2) where the blocks' origins in the file (centroids of the listed vertices) go when the blocks move."""
    cosine, sine = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    arm = origins - centroids
    turned = np.stack((cosine * arm[:, 0] - sine * arm[:, 1], sine * arm[:, 0] + cosine * arm[:, 1]), axis=1)
    return np.asarray(poses[:, :2] + turned)


def _spread(points: FloatArray) -> float:
    first, second = np.triu_indices(len(points), 1)
    return float(np.log(np.hypot(*(points[first] - points[second]).T)).mean())


def _worst(ends: FloatArray, theirs: Sequence[Sequence[float]] | None) -> float:
    if theirs is None:
        return float("nan")
    return float(np.hypot(*(np.array(theirs)[:, :2] - ends).T).max())


def comparison_table(rows: pd.DataFrame) -> str:
    """Agreement of the gains for each contact mode, and of single-point pushes for each number of objects."""
    return _summary(rows, "mode") + "\n" + _summary(rows[rows["mode"] == "single_point"], "n")


def _summary(rows: pd.DataFrame, by: str) -> str:
    header = [by, "pushes", "not simulated", "correlation of gains", "mean theirs", "mean ours", "ratio"]
    header += ["same sign [%]", "median error of the worst block [bounding radii]"]
    lines = []
    for name, group in rows.groupby(by, sort=by != "mode"):
        done = group[group["code"] == "OK"]
        agree = (np.sign(done["theirs"]) == np.sign(done["ours"])).mean()
        lines.append(
            [
                str(name),
                str(len(done)),
                str(len(group) - len(done)),
                f"{np.corrcoef(done['theirs'], done['ours'])[0, 1]:.3f}",
                f"{done['theirs'].mean():.4f}",
                f"{done['ours'].mean():.4f}",
                f"{done['ours'].mean() / done['theirs'].mean():.3f}",
                f"{100 * agree:.1f}",
                f"{done['position_error'].median():.2f}",
            ]
        )
    return table(header, lines)
