"""What a push, or each of many pushes, does to an arrangement."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core.arrangement import Arrangement
from singulation_core.errors import SingulationError
from singulation_core.polygon import FloatArray
from singulation_core.push import Push, PusherGeometry
from singulation_core.push_world.displaced import displaced
from singulation_core.push_world.footprint import Footprint, pusher_footprint
from singulation_core.push_world.physics import PushPhysics
from singulation_core.push_world.plane_frame import PlaneFrame
from singulation_core.push_world.world import PushWorld, unit_of
from singulation_core.result_code import ResultCode

_PUSHER = "pusher"
_REASONS = {
    ResultCode.PATH_BLOCKED: "its pusher would start on a block; it must start on free table",
    ResultCode.INTERNAL: "the solver diverged",
}


@dataclass(frozen=True, eq=False)
class PushOutcomes:
    """Results of m pushes of one arrangement of n objects, without building 'm' arrangements.

    Args:
        before: the arrangement pushed.
        poses: (m, n, 3) x, y [m] of the centroids and turn [rad]; NaN where a push could not be simulated.
        codes: (m,) OK, PATH_BLOCKED (the pusher would start on a block) or INTERNAL (the solver diverged).
    """

    before: Arrangement
    poses: FloatArray
    codes: tuple[ResultCode, ...]

    @property
    def done(self) -> NDArray[np.bool_]:
        """(m,) which pushes were simulated."""
        return np.array([code is ResultCode.OK for code in self.codes], dtype=np.bool_)

    def gains(self) -> FloatArray:
        """(m,) s' - s of each push: the change of the mean log pair distance, in which no unit of length remains.

        NaN where a push was not simulated, and everywhere for fewer than two objects.
        """
        if len(self.before) < 2:
            return np.full(len(self.codes), np.nan)
        first, second = np.triu_indices(len(self.before), 1)
        floor = 0.05 * float(self.before.bounding_radii.mean())
        return _log_distances(self.poses[..., :2], first, second, floor) - _log_distances(
            self.before.centroids, first, second, floor
        )

    def arrangement(self, index: int) -> Arrangement:
        """The arrangement after push ``index``; a block that did not move is the same object as before.

        Raises:
            SingulationError: with the code of that push if it was not simulated.
        """
        if self.codes[index] is not ResultCode.OK:
            raise SingulationError(self.codes[index], f"push {index} was not simulated: {_REASONS[self.codes[index]]}")
        return displaced(self.before, self.poses[index])


def simulate_push(
    arrangement: Arrangement,
    push: Push,
    physics: PushPhysics | None = None,
    pusher: PusherGeometry | None = None,
    unit: float | None = None,
) -> Arrangement:
    """The arrangement after one push.

    The pusher goes straight from ``push.start`` to ``push.end`` and is lifted there. Deterministic, and the same
    in every position, direction, scale and order of the objects.

    Args:
        arrangement: before the push, in any frame.
        push: in the same frame.
        physics: ``PushPhysics.quasi_static()`` if None.
        pusher: jaws; the YuMi's if None.
        unit: length that ``physics`` calls 1 [m]; the mean bounding radius if None.

    Raises:
        SingulationError: ``PATH_BLOCKED`` if the pusher would start on a block, ``OVERLAPPING_OBJECTS`` if blocks
            overlap by more than noise explains, ``INTERNAL`` if the solver diverges.
    """
    used = physics or PushPhysics.quasi_static()
    if used.engine == "compiled":
        return simulate_pushes(arrangement, [push], used, pusher, unit).arrangement(0)
    world = PushWorld(arrangement, used, unit)
    _perform(world, push, pusher or PusherGeometry())
    return world.arrangement()


def simulate_pushes(
    arrangement: Arrangement,
    pushes: Sequence[Push],
    physics: PushPhysics | None = None,
    pusher: PusherGeometry | None = None,
    unit: float | None = None,
) -> PushOutcomes:
    """Many pushes, each from the same arrangement; the same results as ``simulate_push``, in a third of the time.

    A push that cannot be simulated does not stop the others: see ``PushOutcomes.codes``.

    Raises:
        SingulationError: ``OVERLAPPING_OBJECTS`` as for one push.
    """
    used, jaws = physics or PushPhysics.quasi_static(), pusher or PusherGeometry()
    if used.engine == "compiled":
        poses, codes = _all_compiled(arrangement, pushes, used, jaws, unit)
    else:
        poses, codes = _all_by_pymunk(arrangement, pushes, used, jaws, unit)
    return PushOutcomes(arrangement, poses, tuple(codes))


def _all_by_pymunk(
    arrangement: Arrangement, pushes: Sequence[Push], physics: PushPhysics, jaws: PusherGeometry, unit: float | None
) -> tuple[FloatArray, list[ResultCode]]:
    poses = np.full((len(pushes), len(arrangement), 3), np.nan)
    codes = [ResultCode.OK] * len(pushes)
    for _, chosen in _by_footprint(pushes, jaws):
        world = PushWorld(arrangement, physics, unit)  # other jaws in an old space: another order of contacts
        for index in chosen:
            try:
                _perform(world, pushes[index], jaws)
                poses[index] = world.poses()
            except SingulationError as error:
                codes[index] = error.code
    return poses, codes


def _all_compiled(
    arrangement: Arrangement, pushes: Sequence[Push], physics: PushPhysics, jaws: PusherGeometry, unit: float | None
) -> tuple[FloatArray, list[ResultCode]]:
    from singulation_core.push_world import compiled  # noqa: PLC0415  loading Numba takes half a second

    meaning = {compiled.DONE: ResultCode.OK, compiled.BLOCKED: ResultCode.PATH_BLOCKED}
    poses = np.full((len(pushes), len(arrangement), 3), np.nan)
    codes = np.empty(len(pushes), dtype=np.int64)
    for footprint, chosen in _by_footprint(pushes, jaws):
        world = compiled.CompiledWorld(arrangement, footprint, physics, unit_of(arrangement, unit))
        starts, ends = (np.array([getattr(pushes[k], name) for k in chosen]) for name in ("start", "end"))
        poses[chosen], codes[chosen] = world.roll_out(starts, ends)
    return poses, [meaning.get(int(code), ResultCode.INTERNAL) for code in codes]


def _by_footprint(pushes: Sequence[Push], jaws: PusherGeometry) -> list[tuple[Footprint, list[int]]]:
    """Indices of the pushes with the same jaws."""
    groups: dict[int, tuple[Footprint, list[int]]] = {}
    for index, push in enumerate(pushes):
        footprint = pusher_footprint(push, jaws)
        groups.setdefault(id(footprint), (footprint, []))[1].append(index)
    return list(groups.values())


def _perform(world: PushWorld, push: Push, pusher: PusherGeometry) -> None:
    """One push in the restored world, in the frame of the push."""
    heading = math.atan2(*push.direction[::-1].tolist())
    world.restore(PlaneFrame(push.start, heading, world.unit))
    world.place(_PUSHER, pusher_footprint(push, pusher), (*push.start, heading))
    end = (*push.end, heading)
    if world.physics.velocity_kept == 0.0:
        world.approach(_PUSHER, end)
        world.move({_PUSHER: end})
        world.settle()
    else:
        world.move({_PUSHER: end})
        own_steps = math.ceil(push.length / world.unit / world.physics.step - 1e-9)
        world.wait(max(world.physics.total_steps - own_steps, 0))


def _log_distances(points: FloatArray, first: NDArray[np.intp], second: NDArray[np.intp], floor: float) -> FloatArray:
    difference = points[..., first, :] - points[..., second, :]
    distances = np.maximum(np.hypot(difference[..., 0], difference[..., 1]), floor)
    return np.asarray(np.log(distances).mean(axis=-1))
