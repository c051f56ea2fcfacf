"""The straight parts of a push on one branch of one arm: down, push, up."""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from singulation_core import Push, ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics import BRANCHES, TIP_OFFSET, YumiArm, chain
from yumi_push_executor.motion.jaws import tool_pose
from yumi_push_executor.motion.parameters import MotionParameters
from yumi_push_executor.motion.timing import KNOT_STEP, backwards, slowdown, slowed
from yumi_push_executor.motion.trapezoid import Trapezoid
from yumi_push_executor.supervision.trajectory import Trajectory

_DRAW = 1.0  # share of the way to the rest posture per metre
_MISS = 1e-6  # [m] and [rad]
_ITERATIONS = 40


@dataclass(frozen=True, eq=False)
class Lines:
    """Down to the start, along the push, up from the end; one branch, jaws vertical.

    Args:
        arm: that moves.
        branch: number of the posture they were solved from.
        heading: of the jaws' closing direction in ``table`` [rad].
        down, push, up: trajectories, each from rest to rest.
    """

    arm: YumiArm
    branch: int
    heading: float
    down: Trajectory
    push: Trajectory
    up: Trajectory

    @cached_property
    def positions(self) -> FloatArray:
        """(n, 7) way-points of all three [rad]."""
        return np.concatenate((self.down.positions, self.push.positions, self.up.positions))

    @cached_property
    def _extremes(self) -> FloatArray:
        """(2, 7) lowest and highest angle of each joint [rad]."""
        return np.array((self.positions.min(axis=0), self.positions.max(axis=0)))

    def turns(self, heading: float, margin: float) -> FloatArray:
        """(k,) angles by which the last joint may turn to bring the jaws to a heading [rad].

        The last joint's axis is the tool's: turning it turns the jaws and moves nothing else. More than one whole turn
        fits into its limits less ``margin`` [rad].
        """
        (low, high), turn = self._extremes[:, 6], self.heading - heading
        lowest = np.ceil((self.arm.lower[6] + margin - low - turn) / (2.0 * np.pi))
        highest = np.floor((self.arm.upper[6] - margin - high - turn) / (2.0 * np.pi))
        return np.asarray(turn + 2.0 * np.pi * np.arange(lowest, highest + 1.0))

    def turned(self, turn: float) -> "Lines":
        """The same lines with the last joint turned [rad]."""
        down, push, up = (_turned(part, turn) for part in (self.down, self.push, self.up))
        return Lines(self.arm, self.branch, self.heading - turn, down, push, up)

    def room(self, turn: float = 0.0) -> tuple[float, int]:
        """Smallest distance of any joint to its limits [rad], and which joint (1..7 from the shoulder)."""
        lowest, highest = self._extremes.copy()
        lowest[6] += turn
        highest[6] += turn
        room = np.minimum(lowest - self.arm.lower, self.arm.upper - highest)
        return float(room.min()), int(room.argmin()) + 1


def solve_lines(
    arm: YumiArm, branch: int, push: Push, body_from_table: FloatArray, height: float, parameters: MotionParameters
) -> Lines:
    """Lines of a push on one branch, at whatever heading comes naturally; ``height`` [m] is that of travelling.

    Raises:
        SingulationError: ``UNREACHABLE`` with the way-point that is missed.
    """
    rest = BRANCHES[branch][arm.name]
    closing = body_from_table[:3, :3].T @ arm.forward(rest)[:3, 0]
    heading = float(np.arctan2(closing[1], closing[0]))
    pose = tool_pose(body_from_table, push.start, parameters.tip_height, heading, TIP_OFFSET)
    q, distance, angle = chain.solve(arm.chain, rest, pose, rest, _ITERATIONS)
    if not (max(distance, angle) <= _MISS):
        raise SingulationError(
            ResultCode.UNREACHABLE,
            f"{arm.name} arm: the start of the push is missed by {distance * 1e3:.1f} mm and "
            f"{np.rad2deg(angle):.1f} degrees",
        )
    up = np.asarray(body_from_table[:3, 2])
    along = body_from_table[:3, :2] @ push.direction
    rise = height - parameters.tip_height
    to_start = straight_line(arm, q, up, rise, parameters.vertical_speed, parameters, rest, "above the start")
    pushing = straight_line(arm, q, along, push.length, parameters.push_speed, parameters, rest, "push")
    away = straight_line(arm, pushing.end, up, rise, parameters.vertical_speed, parameters, rest, "above the end")
    return Lines(arm, branch, heading, backwards(to_start), pushing, away)


def straight_line(
    arm: YumiArm,
    q: FloatArray,
    direction: FloatArray,
    distance: float,
    speed: float,
    parameters: MotionParameters,
    rest: FloatArray | None,
    name: str,
) -> Trajectory:
    """Tool straight along a direction without turning, from rest to rest.

    Args:
        arm: that moves.
        q: (7,) angles at the beginning.
        direction: (3,) unit vector in ``yumi_body``.
        distance: to go [m].
        speed: of the tool [m/s]; lower where the joints cannot follow.
        parameters: acceleration and joint limits.
        rest: posture towards which the spare joint is drawn, None for the least motion.
        name: for the error text.

    Raises:
        SingulationError: ``UNREACHABLE`` with the way-point that is missed furthest.
    """
    times, gone, rate = _profile(distance, speed, parameters.linear_acceleration)
    draw = 0.0 if rest is None else _DRAW
    angles, rates, misses = chain.follow_line(arm.chain, q, direction, gone, q if rest is None else rest, draw)
    worst = int(misses.argmax())  # NaN counts as the largest
    if not (misses[worst] <= _MISS):
        raise SingulationError(
            ResultCode.UNREACHABLE,
            f"{arm.name} arm, {name}: way-point {worst} of {len(times)}, {gone[worst] * 1e3:.0f} mm along the line, is "
            f"missed by {misses[worst] * 1e3:.1f} mm",
        )
    _require_within_limits(arm, angles, parameters.limit_margin, name)
    trajectory = Trajectory(times, angles, rates * rate[:, None])
    return slowed(trajectory, slowdown(trajectory, arm, parameters))


@lru_cache(maxsize=64)  # the same for every branch of both arms
def _profile(distance: float, speed: float, acceleration: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times [s], ways [m] and speeds [m/s] of the knots of a line, from rest to rest."""
    profile = Trapezoid(distance, speed, acceleration)
    times = profile.knots(KNOT_STEP)
    return (times, *profile.at(times))


def _require_within_limits(arm: YumiArm, angles: FloatArray, margin: float, name: str) -> None:
    """All joints but the last, which may still be turned as a whole."""
    room = np.minimum(angles - arm.lower, arm.upper - angles)[:, :6] - margin
    point, joint = (int(one) for one in np.unravel_index(room.argmin(), room.shape))
    if not (room[point, joint] >= 0.0):
        raise SingulationError(
            ResultCode.UNREACHABLE,
            f"{arm.name} arm, {name}: way-point {point} of {len(angles)} brings joint {joint + 1} to "
            f"{angles[point, joint]:.3f} rad, its limits are {arm.lower[joint]:.3f} to {arm.upper[joint]:.3f} rad "
            f"with a margin of {margin} rad",
        )


def _turned(trajectory: Trajectory, by: float) -> Trajectory:
    positions = trajectory.positions.copy()
    positions[:, 6] += by
    return Trajectory(trajectory.times, positions, trajectory.velocities)
