"""Where the jaws can stand straight down over the table: exhaustive, with random seeds, not the planner's branches."""

from dataclasses import dataclass

import numpy as np

from singulation_core import Arrangement, CellGeometry
from singulation_core.polygon import FloatArray
from yumi_push_executor.clearance import Checker, Margins, Stage, build_scene
from yumi_push_executor.kinematics import BRANCHES, CLEAR_VIEW, TIP_OFFSET, YumiArm, chain
from yumi_push_executor.kinematics.model import ARMS
from yumi_push_executor.motion.jaws import tool_pose

_SEEDS = 60


@dataclass(frozen=True, eq=False)
class ReachMap:
    """For a grid over the workspace: reached by arm, at pushing and at travelling height.

    Args:
        xs, ys: (m,), (n,) grid lines in ``table`` [m].
        reached: arm -> (m, n) bool.
        margin: arm -> (m, n) largest distance to the joint limits over all postures found [rad], NaN where none.
    """

    xs: FloatArray
    ys: FloatArray
    reached: dict[str, FloatArray]
    margin: dict[str, FloatArray]

    def within(self, points: FloatArray) -> bool:
        """Whether one arm reaches the grid cells around all of (k, 2) points."""
        return any(all(self._around(arm, point) for point in points) for arm in self.reached)

    def _around(self, arm: str, point: FloatArray) -> bool:
        i = int(np.clip(np.searchsorted(self.xs, point[0]) - 1, 0, len(self.xs) - 2))
        j = int(np.clip(np.searchsorted(self.ys, point[1]) - 1, 0, len(self.ys) - 2))
        return bool(self.reached[arm][i : i + 2, j : j + 2].all())


def reach_map(spacing: float, heights: tuple[float, ...] = (0.005, 0.06), seed: int = 0) -> ReachMap:
    """Search every grid point; a point counts if every height has a posture clear of body, other arm and table."""
    cell = CellGeometry()
    x_min, x_max, y_min, y_max = cell.workspace
    xs = np.linspace(x_min, x_max, round((x_max - x_min) / spacing) + 1)
    ys = np.linspace(y_min, y_max, round((y_max - y_min) / spacing) + 1)
    random = np.random.default_rng(seed)
    reached, margin = {}, {}
    for name in ARMS:
        arm = YumiArm(name)
        scene = build_scene(name, cell, Arrangement(()), (), np.zeros(2), 0.05)
        checker = Checker(scene, CLEAR_VIEW, 0.0, Margins())
        seeds = [one[name] for one in BRANCHES] + list(random.uniform(arm.lower, arm.upper, (_SEEDS, 7)))
        best = np.array([[_best(arm, checker, cell, np.array((x, y)), heights, seeds) for y in ys] for x in xs])
        reached[name], margin[name] = np.isfinite(best), best
    return ReachMap(xs, ys, reached, margin)


def _best(
    arm: YumiArm,
    checker: Checker,
    cell: CellGeometry,
    point: FloatArray,
    heights: tuple[float, ...],
    seeds: list[FloatArray],
) -> float:
    """Largest distance to the joint limits of the axes 1 to 6 that every height has a clear posture with, else NaN."""
    margins = []
    for height in heights:
        pose = tool_pose(cell.body_from_table, point, height, 0.0, TIP_OFFSET)
        found = [_margin(arm, checker, pose, seed) for seed in seeds]
        margins.append(np.nanmax([*found, -np.inf]))
    return float(min(margins)) if min(margins) > 0.0 else float("nan")


def _margin(arm: YumiArm, checker: Checker, pose: FloatArray, seed: FloatArray) -> float:
    q, *missed = chain.solve(arm.chain, seed, pose, seed, 40)
    if not (max(missed) <= 1e-6):
        return float("nan")
    if checker.first_contact(q[None], Stage.DESCEND) is not None:
        return float("nan")
    return float(np.minimum(q - arm.lower, arm.upper - q)[:6].min())
