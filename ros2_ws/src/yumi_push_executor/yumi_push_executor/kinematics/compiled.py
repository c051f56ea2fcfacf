"""The compiled inner loops of ``chain``: scalars and arrays that the caller holds, so that compiling takes seconds.

Every array is C-contiguous float64; those of a ``Chain`` are read-only, all others writable. With that each function
is compiled once.
"""

from typing import NamedTuple

import numpy as np

from singulation_core.jit import compiled
from singulation_core.polygon import FloatArray

_PULL = 0.2  # share of the way to the rest posture that one iteration goes within the null space
_LARGEST_STEP = 0.4  # [m] and [rad]: beyond it the linear model no longer holds
_EXACT = 1e-9  # [m] and [rad]
_DAMPING = 1e-10  # keeps the linear system solvable where the arm is stretched


class Room(NamedTuple):
    """Arrays that an iteration writes to.

    Args:
        pose, links, jacobian: see ``place``.
        gram: (6, 7), see ``joint_step``.
        error: (6,) translation [m] and rotation vector [rad].
        drift, step: (7,) [rad].
    """

    pose: FloatArray
    links: FloatArray
    jacobian: FloatArray
    gram: FloatArray
    error: FloatArray
    drift: FloatArray
    step: FloatArray


@compiled
def place(frames: FloatArray, q: FloatArray, pose: FloatArray, links: FloatArray, jacobian: FloatArray) -> None:
    """Poses (3, 4) of ``tool0`` and (7, 3, 4) of the joints; Jacobian (6, 7), linear above angular; for (7,) angles."""
    for i in range(3):
        for j in range(4):
            pose[i, j] = 1.0 if i == j else 0.0
    for k in range(8):
        cosine, sine = 1.0, 0.0
        if k < 7:
            cosine, sine = np.cos(q[k]), np.sin(q[k])
        for i in range(3):
            a, b, c = pose[i, 0], pose[i, 1], pose[i, 2]
            x = a * frames[k, 0, 0] + b * frames[k, 1, 0] + c * frames[k, 2, 0]
            y = a * frames[k, 0, 1] + b * frames[k, 1, 1] + c * frames[k, 2, 1]
            pose[i, 2] = a * frames[k, 0, 2] + b * frames[k, 1, 2] + c * frames[k, 2, 2]
            pose[i, 3] += a * frames[k, 0, 3] + b * frames[k, 1, 3] + c * frames[k, 2, 3]
            pose[i, 0] = cosine * x + sine * y
            pose[i, 1] = cosine * y - sine * x
            if k < 7:
                links[k, i, 0], links[k, i, 1], links[k, i, 2] = pose[i, 0], pose[i, 1], pose[i, 2]
                links[k, i, 3] = pose[i, 3]
                jacobian[3 + i, k] = pose[i, 2]
    for k in range(7):
        x, y, z = pose[0, 3] - links[k, 0, 3], pose[1, 3] - links[k, 1, 3], pose[2, 3] - links[k, 2, 3]
        jacobian[0, k] = jacobian[4, k] * z - jacobian[5, k] * y
        jacobian[1, k] = jacobian[5, k] * x - jacobian[3, k] * z
        jacobian[2, k] = jacobian[3, k] * y - jacobian[4, k] * x


@compiled
def places(
    frames: FloatArray, postures: FloatArray, poses: FloatArray, links: FloatArray, jacobians: FloatArray
) -> None:
    """``place`` for every row of (n, 7) postures."""
    for k in range(len(postures)):
        place(frames, postures[k], poses[k], links[k], jacobians[k])


@compiled
def pose_error(target: FloatArray, pose: FloatArray, error: FloatArray) -> None:
    """(6,) translation [m] and rotation vector [rad], base frame, that carry ``pose`` to ``target`` (3, 4)."""
    trace, square = 0.0, 0.0
    for k in range(3):
        error[k] = target[k, 3] - pose[k, 3]
        i, j = (k + 1) % 3, (k + 2) % 3
        turn = 0.0
        for m in range(3):
            trace += target[k, m] * pose[k, m]
            turn += 0.5 * (target[j, m] * pose[i, m] - target[i, m] * pose[j, m])
        error[3 + k] = turn
        square += turn * turn
    sine = np.sqrt(square)
    angle = np.arctan2(sine, 0.5 * (trace - 1.0))
    # At half a turn the axis vanishes; any direction leads away from there, so turn about the tool's own x.
    for k in range(3):
        error[3 + k] = angle * pose[k, 0] if sine < 1e-12 else error[3 + k] * angle / sine


@compiled
def norm(vector: FloatArray, first: int, last: int) -> float:
    """Euclidean length of the elements from ``first`` to before ``last``."""
    square = 0.0
    for k in range(first, last):
        square += vector[k] * vector[k]
    return float(np.sqrt(square))


@compiled
def joint_step(
    jacobian: FloatArray, error: FloatArray, drift: FloatArray, damping: float, gram: FloatArray, step: FloatArray
) -> None:
    """(7,) joint step that removes ``error`` and goes along ``drift`` as far as that leaves the tool alone.

    Solves ``(J J^T + damping) w = error - J drift`` by Cholesky's factors; ``gram`` (6, 7) is room for both sides.
    """
    for i in range(6):
        gram[i, 6] = error[i]
        for k in range(7):
            gram[i, 6] -= jacobian[i, k] * drift[k]
        for j in range(i + 1):
            total = damping if i == j else 0.0
            for k in range(7):
                total += jacobian[i, k] * jacobian[j, k]
            for k in range(j):
                total -= gram[i, k] * gram[j, k]
            gram[i, j] = np.sqrt(total) if i == j else total / gram[j, j]
    for i in range(6):
        for k in range(i):
            gram[i, 6] -= gram[i, k] * gram[k, 6]
        gram[i, 6] /= gram[i, i]
    for i in range(5, -1, -1):
        for k in range(i + 1, 6):
            gram[i, 6] -= gram[k, i] * gram[k, 6]
        gram[i, 6] /= gram[i, i]
    for k in range(7):
        step[k] = drift[k]
        for i in range(6):
            step[k] += jacobian[i, k] * gram[i, 6]


@compiled
def solve(
    frames: FloatArray,
    limits: FloatArray,
    target: FloatArray,
    rest: FloatArray,
    iterations: int,
    q: FloatArray,
    room: Room,
) -> None:
    """Move ``q`` onto ``target``; see ``chain.solve``. What is left stays in ``room.error``."""
    for iteration in range(iterations + 1):
        place(frames, q, room.pose, room.links, room.jacobian)
        pose_error(target, room.pose, room.error)
        size = norm(room.error, 0, 6)
        drawn = iteration < iterations - 6
        if iteration == iterations or (size < _EXACT and not drawn):
            break
        scale = min(1.0, _LARGEST_STEP / max(size, _EXACT))
        for k in range(7):
            room.drift[k] = _PULL * (rest[k] - q[k]) if drawn else 0.0
        for i in range(6):
            room.error[i] *= scale
        damping = _DAMPING + 1e-3 * min(size * size, 0.1)
        joint_step(room.jacobian, room.error, room.drift, damping, room.gram, room.step)
        for k in range(7):
            q[k] = min(max(q[k] + room.step[k], limits[0, k]), limits[1, k])


@compiled
def follow_line(
    frames: FloatArray,
    direction: FloatArray,
    distances: FloatArray,
    rest: FloatArray,
    draw: float,
    angles: FloatArray,
    rates: FloatArray,
    misses: FloatArray,
    target: FloatArray,
    room: Room,
) -> None:
    """Fill ``angles``, ``rates`` and ``misses`` (n,) along a straight line; see ``chain.follow_line``.

    ``target`` (3, 4) is the pose at the beginning, where the first row of ``angles`` has to stand already.
    """
    x, y, z, before = target[0, 3], target[1, 3], target[2, 3], 0.0
    for n in range(len(distances)):
        gone = distances[n]
        target[0, 3], target[1, 3], target[2, 3] = (
            x + gone * direction[0],
            y + gone * direction[1],
            z + gone * direction[2],
        )
        for k in range(7):
            if n > 0:
                angles[n, k] = angles[n - 1, k] + (gone - before) * rates[n - 1, k]
            room.drift[k] = 0.0
        before = gone
        # Four corrections, then the rate at which the line goes on.
        for iteration in range(5):
            place(frames, angles[n], room.pose, room.links, room.jacobian)
            pose_error(target, room.pose, room.error)
            misses[n] = norm(room.error, 0, 6)
            last = iteration == 4 or misses[n] < _EXACT
            if last:
                for k in range(7):
                    room.drift[k] = draw * (rest[k] - angles[n, k])
                for i in range(3):
                    room.error[i], room.error[3 + i] = direction[i], 0.0
            joint_step(room.jacobian, room.error, room.drift, _DAMPING, room.gram, room.step)
            if last:
                break
            for k in range(7):
                angles[n, k] += room.step[k]
        for k in range(7):
            rates[n, k] = room.step[k]
