"""A table top with blocks, over which pushers move as they are told."""

import math
from collections.abc import Mapping

import numpy as np
import pymunk
from numpy.typing import ArrayLike

from singulation_core.arrangement import Arrangement
from singulation_core.errors import InvalidInputError, SingulationError
from singulation_core.polygon import FloatArray
from singulation_core.push_world.approach import free_share, standing_on
from singulation_core.push_world.displaced import displaced
from singulation_core.push_world.footprint import Footprint
from singulation_core.push_world.overlap import part_overlapping
from singulation_core.push_world.physics import HEALED, TOUCHING, PushPhysics
from singulation_core.push_world.plane_frame import PlaneFrame
from singulation_core.push_world.space import add_blocks, block_poses, new_space, pusher_body
from singulation_core.result_code import ResultCode

_FAR_AWAY = np.array((1e5, 1e5, 0.0))  # inner units


class PushWorld:
    """Blocks move only where a pusher, or another block, moves them. Deterministic; independent of scale.

    A pusher is a rigid footprint with a name (each finger of a gripper may be one). Its pose x, y [m], heading [rad]
    in the frame of the arrangement is prescribed from outside::

        world = PushWorld(arrangement)
        world.place("left", Footprint(discs=(Disc(0.0, 0.0, 0.006),)), (0.10, 0.0, 0.0))   # jaws come down
        world.move({"left": (0.12, 0.0, 0.0)})     # in a straight line, as often as wanted, all pushers at once
        world.lift("left")                         # jaws go up
        seen = world.arrangement()

    With a quasi-static preset time does not matter: only the path of the pushers does.

    Args:
        arrangement: where the blocks lie. Overlaps are cut, not pushed, apart (see ``overlap``).
        physics: preset or own values.
        unit: length that ``physics`` calls 1 [m]; the mean bounding radius if None.
        frame: of the inner coordinates; by default the one of the arrangement, around its middle.

    Raises:
        SingulationError: ``OVERLAPPING_OBJECTS`` beyond what perception noise explains.
    """

    def __init__(
        self,
        arrangement: Arrangement,
        physics: PushPhysics | None = None,
        unit: float | None = None,
        frame: PlaneFrame | None = None,
    ) -> None:
        self._initial = arrangement
        self.physics = physics or PushPhysics.quasi_static()
        self.unit = unit_of(arrangement, unit)
        self._space = new_space(self.physics, len(arrangement))
        self._blocks = add_blocks(self._space, arrangement, self.unit, self.physics)
        self._pushers: dict[str, tuple[pymunk.Body, Footprint]] = {}
        self._parked: set[str] = set()  # lifted by restore, and still part of the space for the next time
        # No convex block is thinner than its area over its diameter.
        thinness = (0.5 * item.area / item.bounding_radius for item in arrangement.objects)
        self._block_width = min(thinness, default=math.inf)
        middle = arrangement.centroids.mean(axis=0) if len(arrangement) else np.zeros(2)
        self.restore(frame or PlaneFrame(middle, 0.0, self.unit))
        part_overlapping(self._space, self._blocks, self.physics.slop)

    def restore(self, frame: PlaneFrame | None = None) -> None:
        """Put every block back to where it was at first, lift all pushers, forget every contact.

        Bit for bit a new world: impulses kept from an earlier push would move touching blocks (warm start).
        """
        for name, (body, _) in self._pushers.items():
            _set_pose(body, _FAR_AWAY)
            body.velocity, body.angular_velocity = (0.0, 0.0), 0.0
            self._parked.add(name)
        if frame is not None:
            self._frame = frame
        self._space.collision_persistence = 0  # the next step drops every contact, and moves nothing
        self._space.step(1e-300)
        self._space.collision_persistence = 3
        places = self._frame.inner(self._initial.centroids).tolist()
        for (_, body, _), (x, y) in zip(self._blocks, places, strict=True):
            body.position = x, y
            body.angle = -self._frame.heading
            body.velocity = 0.0, 0.0
            body.angular_velocity = 0.0
            self._space.reindex_shapes_for_body(body)

    def covered(self, footprint: Footprint, pose: ArrayLike) -> list[int]:
        """Ids of the blocks that the footprint at this pose overlaps (touching does not count)."""
        body, shapes = pusher_body(footprint, self.unit, self.physics)
        _set_pose(body, self._inner_pose(pose))
        below = {block for shape in shapes for block in standing_on(self._space, shape, TOUCHING)}
        return [block.id for block in self._blocks if block.shape in below]

    def place(self, name: str, footprint: Footprint, pose: ArrayLike) -> None:
        """Let a pusher down at x, y [m], heading [rad].

        Raises:
            SingulationError: ``PATH_BLOCKED`` if it would come down on blocks, listing them.
            InvalidInputError: a malformed pose.
        """
        below = self.covered(footprint, pose)
        if below:
            x, y, _ = np.asarray(pose, dtype=np.float64)
            raise SingulationError(
                ResultCode.PATH_BLOCKED,
                f"pusher {name!r} at x {x:.4f} m, y {y:.4f} m stands on object(s) {below}; it must start on free table",
            )
        if not (name in self._parked and self._pushers[name][1] is footprint):
            self._remove(name)
            body, shapes = pusher_body(footprint, self.unit, self.physics)
            self._space.add(body, *shapes)
            self._pushers[name] = (body, footprint)
        self._parked.discard(name)
        _set_pose(self._pushers[name][0], self._inner_pose(pose))

    def lift(self, name: str) -> None:
        """Take a pusher off the table; nothing happens if it is not down."""
        self._remove(name)

    def is_down(self, name: str) -> bool:
        """Whether a pusher of this name is on the table."""
        return name in self._pushers and name not in self._parked

    def move(self, poses: Mapping[str, ArrayLike]) -> None:
        """Move pushers to new poses x, y [m], heading [rad], all at once, in straight lines and short steps.

        Raises:
            InvalidInputError: a pusher that is not down, or a malformed pose.
            SingulationError: ``INTERNAL`` if the solver gives numbers that are not finite.
        """
        bodies = {name: self._down(name) for name in poses}
        targets = {name: self._inner_pose(pose) for name, pose in poses.items()}
        changes = {name: _difference(targets[name], bodies[name]) for name in targets}
        count = max((self._steps(name, change) for name, change in changes.items()), default=0)
        if count:
            self._drive(changes, count)
            self._stop(targets)

    def approach(self, name: str, pose: ArrayLike) -> None:
        """Move one pusher straight towards a pose until it touches a block, or gets there.

        Nothing happens on the way, so no time is spent on it, and the pusher meets the block where it is rather than up
        to a step later. Blocks must be at rest, and the pusher must keep its heading.

        Raises:
            InvalidInputError: as ``move``.
        """
        body = self._down(name)
        way = self._inner_pose(pose)[:2] - np.array(body.position)
        length = float(np.hypot(way[0], way[1]))
        if length > 0.0:
            # Half a slop further is a contact that the first step sees, and too shallow to be corrected.
            share = min(free_share(self._space, body, way) + max(0.5 * self.physics.slop, 1e-7) / length, 1.0)
            x, y = (share * way).tolist()
            body.position = body.position + (x, y)

    def wait(self, steps: int) -> None:
        """Let ``steps`` steps pass while no pusher moves: blocks coast, if they do."""
        for _ in range(steps):
            self._rest()
            self._space.step(self.physics.seconds_per_step)

    def settle(self) -> None:
        """Heal overlaps that the last steps of a push left, faster than a moving pusher would allow."""
        usual, self._space.collision_bias = self._space.collision_bias, 1.0 - HEALED
        for _ in range(self.physics.settle_steps):
            self._space.step(1.0)
        self._space.collision_bias = usual

    def poses(self) -> FloatArray:
        """(n, 3) x, y [m] of the centroids and the turn since the beginning [rad], in the order of the arrangement.

        Raises:
            SingulationError: ``INTERNAL``: the solver diverged.
        """
        inner = block_poses(self._blocks)
        if not np.isfinite(inner).all():
            raise SingulationError(
                ResultCode.INTERNAL,
                f"push world: the solver diverged (friction {self.physics.friction}, step {self.physics.step})",
            )
        return np.column_stack((self._frame.outer(inner[:, :2]), inner[:, 2] + self._frame.heading))

    def arrangement(self, stamp: float | None = None) -> Arrangement:
        """Where the blocks are now; a block that did not move is the same object as before."""
        return displaced(self._initial, self.poses(), stamp)

    def _down(self, name: str) -> pymunk.Body:
        if not self.is_down(name):
            down = sorted(set(self._pushers) - self._parked)
            raise InvalidInputError(f"push world: pusher {name!r} is not down; down are {down}")
        return self._pushers[name][0]

    def _remove(self, name: str) -> None:
        if name in self._pushers:
            body, _ = self._pushers.pop(name)
            self._parked.discard(name)
            self._space.remove(body, *body.shapes)

    def _inner_pose(self, pose: ArrayLike) -> FloatArray:
        given = np.asarray(pose, dtype=np.float64)
        if given.shape != (3,) or not np.isfinite(given).all():
            raise InvalidInputError(f"push world: pose {given.tolist()}, need three finite numbers x, y, heading")
        return np.array((*self._frame.inner(given[:2]), given[2] - self._frame.heading))

    def _steps(self, name: str, change: FloatArray) -> int:
        """Steps for a motion such that no point of the footprint goes further than a thin block or jaw allows."""
        footprint = self._pushers[name][1]
        step = self.physics.step
        if self.physics.velocity_kept == 0.0:
            thinnest = min(0.5 * footprint.thickness, 0.25 * self._block_width) / self.unit
            step = max(min(step, thinnest), 0.1 * step)
        way = math.hypot(change[0], change[1]) + abs(float(change[2])) * footprint.reach / self.unit
        return math.ceil(way / step - 1e-9)

    def _drive(self, changes: Mapping[str, FloatArray], count: int) -> None:
        """All steps but the last.

        Chipmunk moves first and solves afterwards. Pushers therefore start one step back: they touch where they are,
        the solver sees the velocity of the step to come, and pushers and blocks then move together.
        """
        seconds = self.physics.seconds_per_step
        for name, change in changes.items():
            body, advance = self._pushers[name][0], change / count
            _set_pose(body, np.array((*body.position, body.angle)) - advance)
            body.velocity = advance[0] / seconds, advance[1] / seconds
            body.angular_velocity = advance[2] / seconds
        for _ in range(count):
            self._space.step(seconds)

    def _stop(self, targets: Mapping[str, FloatArray]) -> None:
        """The last step: pushers stand at their targets, blocks go the last bit and meet them there."""
        for name, target in targets.items():
            body = self._pushers[name][0]
            body.velocity, body.angular_velocity = (0.0, 0.0), 0.0
            _set_pose(body, target)
        self._space.step(self.physics.seconds_per_step)
        self._rest()

    def _rest(self) -> None:
        """Without coasting, what is left of velocities is the solver's rest, not motion."""
        if self.physics.velocity_kept == 0.0:
            for _, body, _ in self._blocks:
                body.velocity, body.angular_velocity = (0.0, 0.0), 0.0


def unit_of(arrangement: Arrangement, unit: float | None) -> float:
    """The unit given, or the mean bounding radius [m].

    Raises:
        InvalidInputError: it is not a positive length.
    """
    if unit is None:
        unit = float(arrangement.bounding_radii.mean()) if len(arrangement) else 1.0
    if not (0.0 < unit < math.inf):
        raise InvalidInputError(f"push world: unit {unit} m, need a finite positive length")
    return unit


def _set_pose(body: pymunk.Body, pose: FloatArray) -> None:
    x, y, angle = pose.tolist()
    body.position, body.angle = (x, y), angle


def _difference(target: FloatArray, body: pymunk.Body) -> FloatArray:
    """Way from where the pusher is to the target, turning the short way round."""
    change = target - np.array((*body.position, body.angle))
    change[2] = math.remainder(change[2], 2.0 * math.pi)
    return np.asarray(change)
