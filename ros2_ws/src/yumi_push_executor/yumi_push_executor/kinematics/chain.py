"""Compiled kinematics of one seven-joint chain: forward, Jacobian, damped inverse, straight lines.

A push needs several hundred solutions of neighbouring poses within milliseconds; calling a general library from
Python for each takes longer than the whole motion may. The constants come from the URDF through Pinocchio, and the
tests hold the results against Pinocchio's.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from singulation_core.polygon import FloatArray

_PULL = 0.2  # share of the way to the rest posture that one iteration goes within the null space
_LARGEST_STEP = 0.4  # [m] and [rad]: beyond it the linear model no longer holds
_EXACT = 1e-9  # [m] and [rad]


class Chain(NamedTuple):
    """Constants of seven revolute joints about their own z, in a form that compiled code takes.

    Args:
        rotations: (7, 3, 3) of each joint frame in the one before it, at zero angle.
        translations: (7, 3) [m].
        tool: (4, 4) pose of ``tool0`` in the frame of the last joint.
        lower, upper: (7,) joint limits [rad].
    """

    rotations: FloatArray
    translations: FloatArray
    tool: FloatArray
    lower: FloatArray
    upper: FloatArray


@njit(cache=True)
def _attach(pose: FloatArray, rotation: FloatArray, translation: FloatArray) -> None:
    """Replace ``pose`` (4, 4) by itself times the given transform."""
    for i in range(3):
        a, b, c = pose[i, 0], pose[i, 1], pose[i, 2]
        pose[i, 3] += a * translation[0] + b * translation[1] + c * translation[2]
        for j in range(3):
            pose[i, j] = a * rotation[0, j] + b * rotation[1, j] + c * rotation[2, j]


@njit(cache=True)
def forward(chain: Chain, q: FloatArray, jacobian: FloatArray) -> FloatArray:
    """4x4 pose of ``tool0`` for (7,) angles; fills the (6, 7) Jacobian (linear above angular, base frame)."""
    pose = np.eye(4)
    origins = np.empty((7, 3))
    for k in range(7):
        _attach(pose, chain.rotations[k], chain.translations[k])
        cosine, sine = np.cos(q[k]), np.sin(q[k])
        for i in range(3):
            x, y = pose[i, 0], pose[i, 1]
            pose[i, 0] = cosine * x + sine * y
            pose[i, 1] = cosine * y - sine * x
            origins[k, i] = pose[i, 3]
            jacobian[3 + i, k] = pose[i, 2]
    _attach(pose, chain.tool, chain.tool[:3, 3])
    for k in range(7):
        for i in range(3):
            j, m = (i + 1) % 3, (i + 2) % 3
            lever_m, lever_j = pose[m, 3] - origins[k, m], pose[j, 3] - origins[k, j]
            jacobian[i, k] = jacobian[3 + j, k] * lever_m - jacobian[3 + m, k] * lever_j
    return pose


@njit(cache=True)
def pose_error(target: FloatArray, pose: FloatArray) -> FloatArray:
    """(6,) translation [m] and rotation vector [rad], base frame, that carry ``pose`` to ``target``."""
    error = np.zeros(6)
    trace = 0.0
    for k in range(3):
        error[k] = target[k, 3] - pose[k, 3]
        i, j = (k + 1) % 3, (k + 2) % 3
        for m in range(3):
            trace += target[k, m] * pose[k, m]
            error[3 + k] += 0.5 * (target[j, m] * pose[i, m] - target[i, m] * pose[j, m])
    sine = np.sqrt(error[3] ** 2 + error[4] ** 2 + error[5] ** 2)
    angle = np.arctan2(sine, 0.5 * (trace - 1.0))
    # At half a turn the axis vanishes; any direction leads away from there, so turn about the tool's own x.
    if sine < 1e-12:
        error[3:] = angle * pose[:3, 0]
    else:
        error[3:] *= angle / sine
    return error


@njit(cache=True)
def _step(jacobian: FloatArray, error: FloatArray, drift: FloatArray, damping: float) -> FloatArray:
    """(7,) joint step that removes ``error`` and goes along ``drift`` as far as that leaves the tool alone."""
    gram = np.empty((6, 6))
    rest = error.copy()
    for i in range(6):
        for k in range(7):
            rest[i] -= jacobian[i, k] * drift[k]
        for j in range(6):
            total = 0.0
            for k in range(7):
                total += jacobian[i, k] * jacobian[j, k]
            gram[i, j] = total
        gram[i, i] += damping
    weights = np.linalg.solve(gram, rest)
    step = drift.copy()
    for k in range(7):
        for i in range(6):
            step[k] += jacobian[i, k] * weights[i]
    return step


@njit(cache=True)
def solve(chain: Chain, q: FloatArray, target: FloatArray, rest: FloatArray, iterations: int) -> tuple[float, float]:
    """Move ``q`` (in place) onto ``target``: damped least squares, the spare joint drawn towards ``rest``.

    The last six iterations no longer draw, so that they converge. Returns what is left: translation [m] and rotation
    [rad]. Every iterate stays within the limits.
    """
    jacobian = np.empty((6, 7))
    drift = np.zeros(7)
    for iteration in range(iterations):
        error = pose_error(target, forward(chain, q, jacobian))
        size = np.sqrt((error**2).sum())
        if iteration < iterations - 6:
            drift = _PULL * (rest - q)
        else:
            drift[:] = 0.0
            if size < _EXACT:
                break
        if size > _LARGEST_STEP:
            error *= _LARGEST_STEP / size
        q += _step(jacobian, error, drift, 1e-10 + 1e-3 * min(size * size, 0.1))
        q[:] = np.minimum(np.maximum(q, chain.lower), chain.upper)
    error = pose_error(target, forward(chain, q, jacobian))
    return np.sqrt((error[:3] ** 2).sum()), np.sqrt((error[3:] ** 2).sum())


@njit(cache=True)
def follow_line(
    chain: Chain,
    q: FloatArray,
    direction: FloatArray,
    distances: FloatArray,
    rest: FloatArray,
    draw: float,
    angles: FloatArray,
    rates: FloatArray,
) -> tuple[int, float]:
    """Carry ``tool0`` from its pose at ``q`` along a straight line without turning it.

    Args:
        chain: of the arm.
        q: (7,) angles at the beginning.
        direction: (3,) unit vector in the base frame.
        distances: (n,) ascending, measured from the beginning [m].
        rest: (7,) posture towards which the spare joint is drawn.
        draw: share of the way to it per metre.
        angles: (n, 7) result [rad].
        rates: (n, 7) result, change of the angles per metre.

    Returns:
        Index of the way-point that is missed furthest and by how much, metres and radians in one norm.
    """
    jacobian = np.empty((6, 7))
    target = forward(chain, q, jacobian)
    origin = target[:3, 3].copy()
    motion, zero = np.zeros(6), np.zeros(7)
    motion[:3] = direction
    now, before, worst, miss = q.copy(), 0.0, 0, 0.0
    rate = _step(jacobian, motion, draw * (rest - now), 1e-10)
    for k in range(len(distances)):
        now = now + (distances[k] - before) * rate
        before = distances[k]
        target[:3, 3] = origin + distances[k] * direction
        for _ in range(4):
            error = pose_error(target, forward(chain, now, jacobian))
            size = np.sqrt((error**2).sum())
            if size < _EXACT:
                break
            now = now + _step(jacobian, error, zero, 1e-10)
        if not (size <= miss):
            worst, miss = k, size
        rate = _step(jacobian, motion, draw * (rest - now), 1e-10)
        angles[k] = now
        rates[k] = rate
    return worst, miss


@njit(cache=True)
def tip_way(chain: Chain, start: FloatArray, end: FloatArray, offset: float, samples: int) -> float:
    """Largest derivative of the tip position along ``start + s (end - start)`` at equally spaced s in 0..1 [m]."""
    jacobian = np.empty((6, 7))
    way, largest = end - start, 0.0
    for sample in range(samples + 1):
        pose = forward(chain, start + way * (sample / samples), jacobian)
        twist = jacobian @ way
        velocity = twist[:3] + np.cross(twist[3:], offset * pose[:3, 2])
        largest = max(largest, np.sqrt((velocity**2).sum()))
    return largest


@njit(cache=True)
def skeleton(chain: Chain, q: FloatArray, offset: float) -> FloatArray:
    """(8, 3) origins of the seven joints and the tip, ``offset`` below ``tool0``, in the base frame [m]."""
    pose = np.eye(4)
    points = np.empty((8, 3))
    for k in range(7):
        _attach(pose, chain.rotations[k], chain.translations[k])
        points[k] = pose[:3, 3]
        cosine, sine = np.cos(q[k]), np.sin(q[k])
        for i in range(3):
            x, y = pose[i, 0], pose[i, 1]
            pose[i, 0] = cosine * x + sine * y
            pose[i, 1] = cosine * y - sine * x
    _attach(pose, chain.tool, chain.tool[:3, 3])
    points[7] = pose[:3, 3] + offset * pose[:3, 2]
    return points


@njit(cache=True)
def longest_step(chain: Chain, postures: FloatArray, offset: float) -> float:
    """Furthest that any joint or the tip moves between two of (n, 7) neighbouring postures [m]."""
    before = skeleton(chain, postures[0], offset)
    longest = 0.0
    for k in range(1, len(postures)):
        after = skeleton(chain, postures[k], offset)
        longest = max(longest, np.sqrt(((after - before) ** 2).sum(axis=1)).max())
        before = after
    return longest


@njit(cache=True)
def tips(chain: Chain, postures: FloatArray, offset: float) -> FloatArray:
    """(n, 3) positions of the tip, ``offset`` below ``tool0``, for (n, 7) postures."""
    jacobian = np.empty((6, 7))
    result = np.empty((len(postures), 3))
    for k in range(len(postures)):
        pose = forward(chain, postures[k], jacobian)
        result[k] = pose[:3, 3] + offset * pose[:3, 2]
    return result
