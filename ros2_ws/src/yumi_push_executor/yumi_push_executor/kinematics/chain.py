"""Kinematics of one seven-joint chain: forward, Jacobian, damped inverse, straight lines.

A push needs several hundred solutions of neighbouring poses within milliseconds; calling a general library from
Python for each takes longer than the whole motion may, so the inner loops are compiled. The constants come from the
URDF through Pinocchio, and the tests hold the results against Pinocchio's.
"""

from typing import NamedTuple

import numpy as np

from singulation_core.polygon import FloatArray
from yumi_push_executor.kinematics import compiled

_JOINTS = 7
_SAMPLES = 25  # postures at which the speed of the tips is looked at


class Chain(NamedTuple):
    """Constants of seven revolute joints about their own z, C-contiguous and read-only.

    Args:
        frames: (8, 3, 4) poses: of each joint frame in the one before it at zero angle, then of ``tool0`` in the last.
        limits: (2, 7) lower and upper joint limits [rad].
    """

    frames: FloatArray
    limits: FloatArray


class Places(NamedTuple):
    """Where the parts of an arm are in n postures.

    Args:
        poses: (n, 3, 4) of ``tool0`` in the base frame.
        links: (n, 7, 3, 4) of the joints, turned with them.
        jacobians: (n, 6, 7) of ``tool0``, linear above angular, base frame.
    """

    poses: FloatArray
    links: FloatArray
    jacobians: FloatArray

    def tips(self, offset: float) -> FloatArray:
        """(n, 3) points ``offset`` below ``tool0`` along the tool axis [m]."""
        return np.asarray(self.poses[:, :, 3] + offset * self.poses[:, :, 2])


def places(chain: Chain, postures: FloatArray) -> Places:
    """Forward kinematics of (n, 7) postures."""
    rows = np.array(postures, dtype=np.float64, order="C")
    n = len(rows)
    found = Places(np.empty((n, 3, 4)), np.empty((n, _JOINTS, 3, 4)), np.empty((n, 6, _JOINTS)))
    compiled.places(chain.frames, rows, *found)
    return found


def tips(chain: Chain, postures: FloatArray, offset: float) -> FloatArray:
    """(n, 3) positions of the tip, ``offset`` below ``tool0``, for (n, 7) postures."""
    return places(chain, postures).tips(offset)


def longest_step(chain: Chain, postures: FloatArray, offset: float) -> float:
    """Furthest that any joint or the tip moves between two of (n, 7) neighbouring postures [m]."""
    found = places(chain, postures)
    points = np.concatenate((found.links[:, :, :, 3], found.tips(offset)[:, None]), axis=1)
    return float(np.sqrt((np.diff(points, axis=0) ** 2).sum(axis=2)).max(initial=0.0))


def tip_way(chain: Chain, start: FloatArray, end: FloatArray, offset: float) -> float:
    """Largest derivative of the tip position along ``start + s (end - start)`` at equally spaced s in 0..1 [m]."""
    found = places(chain, np.linspace(start, end, _SAMPLES))
    twists = found.jacobians @ (end - start)
    velocities = twists[:, :3] + np.cross(twists[:, 3:], offset * found.poses[:, :, 2])
    return float(np.sqrt((velocities**2).sum(axis=1)).max())


def solve(
    chain: Chain, seed: FloatArray, target: FloatArray, rest: FloatArray, iterations: int
) -> tuple[FloatArray, float, float]:
    """Bring ``tool0`` onto a pose (4, 4): damped least squares, the spare joint drawn towards ``rest``.

    The last six iterations no longer draw, so that they converge. Every iterate stays within the limits.

    Returns:
        (7,) angles [rad], and what is left: translation [m] and rotation [rad].
    """
    q, room = _row(seed), _room()
    compiled.solve(chain.frames, chain.limits, _pose(target), _row(rest), iterations, q, room)
    return q, float(np.linalg.norm(room.error[:3])), float(np.linalg.norm(room.error[3:]))


def follow_line(
    chain: Chain, q: FloatArray, direction: FloatArray, distances: FloatArray, rest: FloatArray, draw: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Carry ``tool0`` from its pose at ``q`` along a straight line without turning it.

    Args:
        chain: of the arm.
        q: (7,) angles at the beginning.
        direction: (3,) unit vector in the base frame.
        distances: (n,) ascending, measured from the beginning [m].
        rest: (7,) posture towards which the spare joint is drawn.
        draw: share of the way to it per metre.

    Returns:
        (n, 7) angles [rad]; (n, 7) their change per metre; (n,) by how much each way-point is missed, metres and
        radians in one norm.
    """
    gone = _row(distances)
    angles, rates, misses = np.empty((len(gone), _JOINTS)), np.empty((len(gone), _JOINTS)), np.empty(len(gone))
    angles[0] = q
    target = _pose(places(chain, angles[:1]).poses[0])
    compiled.follow_line(
        chain.frames, _row(direction), gone, _row(rest), float(draw), angles, rates, misses, target, _room()
    )
    return angles, rates, misses


def _row(values: FloatArray) -> FloatArray:
    """A copy that compiled code may write to."""
    return np.array(values, dtype=np.float64)


def _pose(matrix: FloatArray) -> FloatArray:
    return np.array(matrix[:3, :4], dtype=np.float64, order="C")


def _room() -> compiled.Room:
    shapes = ((3, 4), (_JOINTS, 3, 4), (6, _JOINTS), (6, _JOINTS), 6, _JOINTS, _JOINTS)
    return compiled.Room(*(np.empty(shape) for shape in shapes))
