"""How far ClusterPush is ahead of Cluster Diffusion under other readings of the latter, by simulated pushes alone."""

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from singulation_bringup.closed_loop.sets import CONFIGURATIONS, EASY, MIXED, TABLE_POLICIES
from singulation_bringup.closed_loop.setting import CellSetting
from singulation_core import Arrangement, SingulationError, singulation_distance
from singulation_core.polygon import FloatArray
from singulation_core.push_world import simulate_push
from singulation_planner import plan_push
from singulation_planner.benchmark.markdown import table
from singulation_planner.benchmark.statistics import share
from singulation_sim.scenes import random_scene

_OURS, _THEIRS = TABLE_POLICIES
READINGS: Mapping[str, Mapping[str, Any]] = MappingProxyType(
    {
        "nearest to the centre first (ours)": {},
        "farthest first": {"equally_free": "farthest"},
        "centres of clusters": {"centre": "clusters"},
        "centres of clusters, farthest first": {"centre": "clusters", "equally_free": "farthest"},
    }
)
_TEXT = """## ClusterPush ahead of Cluster Diffusion under other readings of Cluster Diffusion

The paper says that Cluster Diffusion "aims to push one object away from the center of the clutter towards free space",
and neither which center nor which of several objects with free space in front. Single-point pushes, planned with the
blocks' true poses and simulated with the friction of each set, without camera and robot: {sets} sets;
travel after contact {travel:g} mean bounding radii.
"""


def compare_readings(sets: int, travel: float, out: Path) -> str:
    """Write ``diffusion_readings.md``; its text.

    Args:
        sets: of each configuration of Table III.
        travel: of a push after contact [mean bounding radii].
        out: folder.
    """
    setting = CellSetting(push_distance_factor=travel)
    cases = [(one, seed) for seed in range(sets) for one in CONFIGURATIONS]
    scenes = [random_scene(one.kind, one.blocks, seed, setting.geometry) for one, seed in cases]
    groups = {
        "easy": np.array([one == EASY for one, _ in cases]),
        "hard": np.array([one.kind == MIXED for one, _ in cases]),
        "average": np.ones(len(cases), dtype=bool),
    }
    ours = _gains(scenes, cases, setting, _OURS, {})
    rows = []
    for name, options in READINGS.items():
        theirs = _gains(scenes, cases, setting, _THEIRS, options)
        found = [share(ours[chosen], theirs[chosen]) for chosen in groups.values()]
        rows.append([name, *(f"{100 * (one.value - 1.0):+.1f} ± {100 * one.error:.1f} %" for one in found)])
    text = _TEXT.format(sets=len(cases), travel=travel) + "\n" + table(["Cluster Diffusion", *groups], rows)
    out.mkdir(parents=True, exist_ok=True)
    (out / "diffusion_readings.md").write_text(text)
    return text


def _gains(
    scenes: list[Arrangement],
    cases: list[tuple[Any, int]],
    setting: CellSetting,
    policy: str,
    options: Mapping[str, Any],
) -> FloatArray:
    """s' - s of one push in each scene; 0 where there is none."""
    found = []
    for scene, (_, seed) in zip(scenes, cases, strict=True):
        unit = float(scene.bounding_radii.mean())
        try:
            push = plan_push(
                scene,
                policy,
                push_distance_factor=setting.push_distance_factor,
                workspace=setting.geometry.workspace_polygon,
                **options,
            )
            after = simulate_push(scene, push, setting.table_physics(seed))
        except SingulationError:
            after = scene
        found.append(singulation_distance(after, unit) - singulation_distance(scene, unit))
    return np.array(found)
