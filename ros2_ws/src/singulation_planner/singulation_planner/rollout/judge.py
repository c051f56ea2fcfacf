"""Simulated outcomes of proposals and their values."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from singulation_core import Arrangement, ContactMode
from singulation_core.polygon import FloatArray
from singulation_core.push_world import PushPhysics, pusher_footprint
from singulation_core.push_world.compiled import CompiledWorld
from singulation_planner.kernels.types import IntArray
from singulation_planner.placer import NOT_SIMULATED, Placer
from singulation_planner.rollout.objective import Objective
from singulation_planner.rollout.options import SHIFT
from singulation_planner.rollout.proposals import Proposals

# What perception and the paper's section V-A leave open, beside the position: standard deviations of direction [rad],
# friction, and of a block's density as a share of the mean.
_TURN, _FRICTION, _DENSITY = 0.05, 0.1, 0.1
_LEAST_FRICTION = 0.05
# A second look at a push: in steps half as long, with a little less and a little more friction.
_SHORTER, _FRICTIONS = 0.5, (0.9, 1.1)
_SAMPLED = 1 + len(_FRICTIONS)  # first of the sampled worlds; before it the one seen and those of the second look


@dataclass(frozen=True, slots=True)
class Outcomes:
    """Of m pushes: values, changes of s (m,) and poses (m, n, 3); NaN where a simulation failed."""

    values: FloatArray
    changes: FloatArray
    poses: FloatArray


@dataclass(frozen=True, slots=True)
class Judge:
    """Simulates proposals of one scene and one contact mode.

    Attributes:
        placer, objective: of the scene.
        physics: of the simulations.
        arrangement: the scene's, in canonical order.
        count: of sampled worlds.
        seed: of the sampled worlds.
    """

    placer: Placer
    objective: Objective
    physics: PushPhysics
    arrangement: Arrangement
    count: int = 1
    seed: int = 0
    _worlds: dict[float, list[CompiledWorld]] = field(default_factory=dict)

    def outcomes(self, proposals: Proposals) -> Outcomes:
        """In the world as it was seen. Pushes whose simulation fails are counted as rejected."""
        return self._simulate(proposals, 0)

    def least(self, proposals: Proposals, first: Outcomes, enough: float) -> Outcomes:
        """Of the outcomes ``first`` of one proposal and those of a second look the one with the least value.

        Where they differ much, the push stands on a knife's edge: its block may slip to one side or to the other. A
        search that simulates many pushes finds such ones, and what it expects of them does not happen. A value that
        is not above ``enough`` ends the look.
        """
        least = first
        for k in range(len(_FRICTIONS)):
            look = self._simulate(proposals, 1 + k)
            if not (look.values[0] >= least.values[0]):
                least = look
            if not (least.values[0] > enough):
                break
        return least

    def in_all_worlds(self, proposals: Proposals) -> Outcomes:
        """Means over the sampled worlds in which the simulation does not fail; the poses are NaN."""
        found = [self._simulate(proposals, _SAMPLED + number) for number in range(self.count)]
        values = np.array([one.values for one in found])
        # A push that cannot even begin in some worlds gains nothing there.
        failed = np.isnan(values)
        values = np.where(failed, self._stay(), values).mean(axis=0)
        changes = np.nan_to_num([one.changes for one in found]).mean(axis=0)
        return Outcomes(np.where(failed.all(axis=0), np.nan, values), changes, np.full_like(found[0].poses, np.nan))

    def _stay(self) -> float:
        world = next(iter(self._worlds.values()))[0]
        return float(self.objective.values(world.poses, world.poses[np.newaxis])[0][0])

    def _simulate(self, proposals: Proposals, number: int) -> Outcomes:
        starts, ends = proposals.starts, proposals.starts + self.placer.travel * proposals.candidates.directions
        poses = np.empty((len(proposals), len(self.placer.scene), 3))
        for width, target, same in self._by_width(proposals.candidates.objects):
            world = self._of_width(target, width)[number]
            poses[same], _ = world.roll_out(starts[same], ends[same])
        values, changes = self.objective.values(world.poses, poses)
        self.placer.rejected[NOT_SIMULATED] += int(np.isnan(values).sum())
        return Outcomes(values, changes, poses)

    def _by_width(self, objects: IntArray) -> Iterator[tuple[float, int, slice | IntArray]]:
        """Contact width, one of the objects, and the indices of all that are pushed with it."""
        if self.placer.mode is not ContactMode.TWO_POINT:
            yield self.placer.contact_width(int(objects[0])), int(objects[0]), slice(None)
            return
        widths = np.array([self.placer.contact_width(target) for target in objects.tolist()])
        for width in np.unique(widths).tolist():
            same = np.flatnonzero(widths == width)
            yield width, int(objects[same[0]]), same

    def _of_width(self, target: int, width: float) -> list[CompiledWorld]:
        if width not in self._worlds:
            scene = self.placer.scene
            example = self.placer.push(target, scene.centroids[target], np.array((1.0, 0.0)))
            footprint = pusher_footprint(example, self.placer.geometry)
            seen = CompiledWorld(self.arrangement, footprint, self.physics, scene.scale)
            again = [seen.finer(_SHORTER, friction) for friction in _FRICTIONS]
            sampled = [self._sampled(seen, k) for k in range(self.count if self.count > 1 else 0)]
            self._worlds[width] = [seen, *again, *sampled]
        return self._worlds[width]

    def _sampled(self, seen: CompiledWorld, number: int) -> CompiledWorld:
        scene = self.placer.scene
        random = np.random.default_rng((self.seed, number))
        friction = max(_LEAST_FRICTION, self.physics.friction + _FRICTION * random.standard_normal())
        physics = replace(self.physics, friction=friction, density_spread=_DENSITY, seed=int(random.integers(2**31)))
        shifts = SHIFT * scene.scale * random.standard_normal((len(scene), 2))
        return seen.varied(shifts, _TURN * random.standard_normal(len(scene)), physics)
