"""From arrangements and pushes to arrays and back."""

import copy
import math
from collections.abc import Sequence
from itertools import accumulate

import numpy as np

from singulation_core.arrangement import Arrangement
from singulation_core.errors import InvalidInputError
from singulation_core.polygon import FloatArray
from singulation_core.push_world.compiled.outlines import measure
from singulation_core.push_world.compiled.rollout import measure_overlaps, part_overlaps, roll_out_many
from singulation_core.push_world.compiled.types import Contacts, IntArray, Numbers, Scratch, Shapes, State
from singulation_core.push_world.footprint import Footprint
from singulation_core.push_world.overlap import refuse_deep_overlap
from singulation_core.push_world.physics import HEALED, TOUCHING, PushPhysics

_SWEEPS = 20  # over all pairs, in which overlaps of a varied world are undone
_RETREAT = 1.0  # inner units
_NONE = np.empty((0, 2))


class CompiledWorld:
    """The blocks of an arrangement, ready for any number of pushes by one footprint.

    Args:
        arrangement: where the blocks lie; overlaps there are left as they are.
        footprint: of the pusher, with at most one polygon.
        physics: quasi-static; its engine is not asked for.
        unit: length that ``physics`` calls 1 [m].

    Raises:
        InvalidInputError: a footprint of several polygons.
        SingulationError: ``OVERLAPPING_OBJECTS`` beyond what perception noise explains.
    """

    def __init__(self, arrangement: Arrangement, footprint: Footprint, physics: PushPhysics, unit: float) -> None:
        if len(footprint.polygons) > 1:
            raise InvalidInputError(
                f"compiled push world: {len(footprint.polygons)} polygons in the footprint, need 0 or 1"
            )
        count = len(arrangement)
        self._unit = unit
        self._origins = np.column_stack((arrangement.centroids / unit, np.zeros(count)))
        self._shapes = _shapes(arrangement, footprint, physics.densities(count), unit)
        self._state, self._contacts = _state(self._shapes), _contacts(16 * count + 16)
        self._scratch = Scratch(np.zeros((2, count + 1), dtype=np.int64), np.zeros((2, 4)), np.zeros(2))
        self._densities = physics.densities(count)
        self._numbers = Numbers(
            physics.friction,
            physics.overlap_correction,
            HEALED,
            physics.slop,
            _step(arrangement, footprint, physics, unit),
            TOUCHING,
            physics.iterations,
            physics.settle_steps,
            0.0,
        )
        measure_overlaps(self._shapes, self._state, self._origins)
        self._refuse_deep_overlaps(arrangement)

    def _refuse_deep_overlaps(self, arrangement: Arrangement) -> None:
        for one, other in np.argwhere(self._state.slack > 0.0).tolist():
            radius = float(min(self._shapes.radii[one], self._shapes.radii[other]))
            ids = arrangement.objects[one].id, arrangement.objects[other].id
            refuse_deep_overlap(*ids, float(self._state.slack[one, other]), radius)

    @property
    def poses(self) -> FloatArray:
        """(n, 3) x, y [m], turn [rad] of the blocks before a push."""
        return self._origins * (self._unit, self._unit, 1.0)

    def varied(self, shifts: FloatArray, turns: FloatArray, physics: PushPhysics) -> "CompiledWorld":
        """A world in which the blocks lie, weigh and rub a little differently.

        Blocks that overlap then are moved apart, and a pusher that would start on a block is moved back until it is
        free. It shares its working memory with this world: never use both at the same time.

        Args:
            shifts, turns: (n, 2) [m], (n,) [rad] of the blocks.
            physics: friction and densities; the rest stays.
        """
        made = copy.copy(self)
        made._origins = self._origins + np.column_stack((shifts / self._unit, turns))
        made._numbers = self._numbers._replace(friction=physics.friction, retreat=_RETREAT)
        factors = np.append(np.array(self._densities) / physics.densities(len(shifts)), 0.0)
        made._shapes = self._shapes._replace(mobility=self._shapes.mobility * factors[:, np.newaxis])
        part_overlaps(made._shapes, self._state, made._origins, _SWEEPS)
        made._state = self._state._replace(slack=np.zeros_like(self._state.slack))
        measure_overlaps(made._shapes, made._state, made._origins)
        return made

    def finer(self, steps: float, friction: float) -> "CompiledWorld":
        """The same world with steps and friction multiplied by these.

        It shares its working memory with this world: never use both at the same time.
        """
        made, numbers = copy.copy(self), self._numbers
        made._numbers = numbers._replace(step=steps * numbers.step, friction=friction * numbers.friction)
        return made

    def roll_out(self, starts: FloatArray, ends: FloatArray) -> tuple[FloatArray, IntArray]:
        """Outcomes of pushes. Calls from several threads need a world each; the interpreter is free meanwhile.

        Args:
            starts, ends: (m, 2) [m].

        Returns:
            (m, n, 3) x, y [m] of the centroids and turn [rad], NaN where not done; (m,) DONE, BLOCKED or DIVERGED.
        """
        poses, codes = np.empty((len(starts), len(self._origins), 3)), np.empty(len(starts), dtype=np.int64)
        roll_out_many(
            self._shapes,
            self._state,
            self._contacts,
            self._scratch,
            self._numbers,
            self._origins,
            self._unit,
            starts,
            ends,
            poses,
            codes,
        )
        return poses, codes


def _step(arrangement: Arrangement, footprint: Footprint, physics: PushPhysics, unit: float) -> float:
    """The step of the physics, shorter where pusher or blocks are thin (see ``PushWorld``)."""
    blocks = min((0.125 * item.area / item.bounding_radius for item in arrangement.objects), default=math.inf)
    return max(min(physics.step, 0.5 * footprint.thickness / unit, blocks / unit), 0.1 * physics.step)


def _shapes(arrangement: Arrangement, footprint: Footprint, densities: Sequence[float], unit: float) -> Shapes:
    """All outlines at once: a planner makes a world for each plan."""
    outlines = [*(item.outline for item in arrangement.objects), *footprint.polygons]
    count = len(arrangement)
    firsts = np.array((0, *accumulate(map(len, outlines))), dtype=np.int64)
    if not footprint.polygons:
        firsts = np.append(firsts, firsts[-1:])
    vertices = int(firsts[-1])
    shapes = Shapes(
        firsts,
        np.empty((vertices, 2)),
        np.empty((vertices, 2)),
        np.append(arrangement.bounding_radii, footprint.reach) / unit,
        np.empty(count + 1),
        np.empty((count + 1, 2)),
        np.array([(one.x, one.y, one.radius) for one in footprint.discs]).reshape(-1, 3) / unit,
    )
    masses = np.array([item.area for item in arrangement.objects]) / unit**2 * np.array(densities)
    measure(np.concatenate([*outlines, _NONE]), arrangement.centroids, masses, unit, shapes)
    return shapes


def _state(shapes: Shapes) -> State:
    count, vertices = len(shapes.radii), len(shapes.vertices)
    return State(
        np.zeros((count, 3)),
        np.zeros((vertices, 2)),
        np.zeros((vertices, 2)),
        np.zeros((count, 3)),
        np.zeros((count, count)),
        np.full((count, count), -1, dtype=np.int64),
        np.zeros((count, count, 2, 3)),
    )


def _contacts(size: int) -> Contacts:
    return Contacts(
        np.zeros((size, 3), dtype=np.int64),
        np.zeros((size, 2)),
        np.zeros((size, 4)),
        np.zeros(size),
        np.zeros(size),
        np.zeros((size, 2)),
        np.zeros((size, 2)),
        np.zeros(1, dtype=np.int64),
    )
