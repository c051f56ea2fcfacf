"""Simulated outcomes of proposals and their values."""

from dataclasses import dataclass, field

import numpy as np

from singulation_core import Arrangement
from singulation_core.polygon import FloatArray
from singulation_core.push_world import PushPhysics, pusher_footprint
from singulation_core.push_world.compiled import CompiledWorld
from singulation_planner.placer import NOT_SIMULATED, Placer
from singulation_planner.rollout.objective import Objective
from singulation_planner.rollout.proposals import Proposals


@dataclass(frozen=True, slots=True)
class Outcomes:
    """Of m pushes: values, changes of s (m,) and poses (m, n, 3); NaN where a simulation failed."""

    values: FloatArray
    changes: FloatArray
    poses: FloatArray


@dataclass(frozen=True, slots=True)
class Judge:
    """Simulates proposals of one scene and one contact mode."""

    placer: Placer
    objective: Objective
    physics: PushPhysics
    arrangement: Arrangement
    worlds: dict[float, CompiledWorld] = field(default_factory=dict)

    def outcomes(self, proposals: Proposals) -> Outcomes:
        """Simulate; pushes whose simulation fails are counted as rejected."""
        poses = np.empty((len(proposals), len(self.placer.scene), 3))
        objects = proposals.candidates.objects
        ends = proposals.starts + self.placer.travel * proposals.candidates.directions
        widths = np.array([self.placer.contact_width(target) for target in objects.tolist()])
        for width in np.unique(widths).tolist():
            same = np.flatnonzero(widths == width)
            world = self._world(int(objects[same[0]]), width)
            poses[same], _ = world.roll_out(proposals.starts[same], ends[same])
        values, changes = self.objective.values(poses)
        self.placer.rejected[NOT_SIMULATED] += int(np.isnan(values).sum())
        return Outcomes(values, changes, poses)

    def _world(self, target: int, width: float) -> CompiledWorld:
        if width not in self.worlds:
            scene = self.placer.scene
            example = self.placer.push(target, scene.centroids[target], np.array((1.0, 0.0)))
            footprint = pusher_footprint(example, self.placer.geometry)
            self.worlds[width] = CompiledWorld(self.arrangement, footprint, self.physics, scene.scale)
        return self.worlds[width]
