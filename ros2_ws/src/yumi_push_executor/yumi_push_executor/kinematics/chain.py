"""Compiled forward kinematics, Jacobian and damped inverse kinematics of one seven-joint chain.

A push needs several hundred solutions of neighbouring poses within milliseconds; calling a general library from
Python for each takes longer than the whole motion may. The constants come from the URDF through Pinocchio, and the
tests hold the results against Pinocchio's.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from singulation_core.polygon import FloatArray

_PULL = 0.1  # share of the way to the rest posture that one iteration goes within the null space


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
def forward(chain: Chain, q: FloatArray, jacobian: FloatArray) -> FloatArray:
    """4x4 pose of the tool for (7,) angles; fills the (6, 7) Jacobian (linear above angular, base frame)."""
    rotation = np.eye(3)
    position = np.zeros(3)
    origins = np.empty((7, 3))
    for k in range(7):
        position = position + rotation @ chain.translations[k]
        rotation = rotation @ chain.rotations[k]
        cosine, sine = np.cos(q[k]), np.sin(q[k])
        turned = rotation.copy()
        turned[:, 0] = cosine * rotation[:, 0] + sine * rotation[:, 1]
        turned[:, 1] = cosine * rotation[:, 1] - sine * rotation[:, 0]
        rotation = turned
        origins[k] = position
        jacobian[3:, k] = rotation[:, 2]
    pose = np.eye(4)
    pose[:3, 3] = position + rotation @ np.ascontiguousarray(chain.tool[:3, 3])
    pose[:3, :3] = rotation @ np.ascontiguousarray(chain.tool[:3, :3])
    for k in range(7):
        jacobian[:3, k] = np.cross(jacobian[3:, k], pose[:3, 3] - origins[k])
    return pose


@njit(cache=True)
def pose_error(target: FloatArray, pose: FloatArray) -> FloatArray:
    """(6,) translation [m] and rotation vector [rad], base frame, that carry ``pose`` to ``target``."""
    error = np.empty(6)
    error[:3] = target[:3, 3] - pose[:3, 3]
    r = np.ascontiguousarray(target[:3, :3]) @ np.ascontiguousarray(pose[:3, :3]).T
    axis = np.array((r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]))
    sine = 0.5 * np.sqrt((axis**2).sum())
    angle = np.arctan2(sine, 0.5 * (np.trace(r) - 1.0))
    # At half a turn the axis vanishes; any direction leads away from there, so turn about the tool's own x.
    if sine < 1e-9:
        error[3:] = angle * pose[:3, 0]
    else:
        error[3:] = axis * (0.5 * angle / sine)
    return error


@njit(cache=True)
def solve(chain: Chain, q: FloatArray, target: FloatArray, rest: FloatArray, iterations: int) -> tuple[float, float]:
    """Move ``q`` (in place) onto ``target``: damped least squares, the spare joint drawn towards ``rest``.

    Returns what is left: translation [m] and rotation [rad]. Every iterate stays within the limits.
    """
    jacobian = np.empty((6, 7))
    for _ in range(iterations):
        error = pose_error(target, forward(chain, q, jacobian))
        size = np.sqrt((error**2).sum())
        if size < 1e-8:
            break
        if size > 0.4:  # far steps leave the range where the linear model holds
            error *= 0.4 / size
        gram = jacobian @ jacobian.T
        damping = 1e-9 + 1e-3 * min(size * size, 0.1)
        for i in range(6):
            gram[i, i] += damping
        home = _PULL * (rest - q) if size > 1e-3 else np.zeros(7)
        step = home + jacobian.T @ np.linalg.solve(gram, error - jacobian @ home)
        q[:] = np.minimum(np.maximum(q + step, chain.lower), chain.upper)
    error = pose_error(target, forward(chain, q, jacobian))
    return np.sqrt((error[:3] ** 2).sum()), np.sqrt((error[3:] ** 2).sum())
