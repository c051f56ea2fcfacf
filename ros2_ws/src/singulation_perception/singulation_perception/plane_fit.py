"""Robust fit of a plane to points: the best of many three-point planes, then least squares on what lies near it."""

import math

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.jit import compiled_part, compiled_sums

_SCORED = 1_000  # points that score a hypothesis
_LEAST_CROSS = 1e-12  # [m^2] product of two vectors that span a plane
_HOLDS = 0.5  # share of the points near a plane that no other can have
_JUDGED = 4_000  # points that tell the scatter
_ROUNDS = 4
_TURNS = 3  # of the normal, in each round
_SETTLED = 0.02  # relative change of the noise that ends the fit


def best_plane(points: FloatArray, hypotheses: int, reach: float, first: FloatArray | None = None) -> FloatArray | None:
    """The plane through three of the points that has most of them near it.

    Args:
        points: (3, m) [m].
        hypotheses: how many to try.
        reach: distance that counts as near [m].
        first: a plane (4,) that is taken at once if more than half of the points lie near it.

    Returns:
        (4,) unit normal and offset, distance = normal . point + offset; None if the points lie on one line.
    """
    scored = np.ascontiguousarray(points[:, :: max(1, points.shape[1] // _SCORED)])
    if first is not None and np.count_nonzero(np.abs(first[:3] @ scored + first[3]) < reach) > _HOLDS * scored.shape[1]:
        return first
    plane, found = _best(scored, hypotheses, reach)
    return np.asarray(plane) if found else None


@compiled_sums
def _best(points: FloatArray, hypotheses: int, reach: float) -> tuple[FloatArray, bool]:
    """Plane through three of the (3, n) points with most of them within ``reach``; false if all lie on one line.

    The choice repeats itself (a linear congruential generator; Knuth, MMIX): equal clouds give equal planes.
    """
    best, most = np.zeros(4), -1
    size = points.shape[1]
    state = np.uint64(7)
    chosen = np.empty(3, dtype=np.int64)
    for _ in range(hypotheses):
        for corner in range(3):
            state = state * np.uint64(6364136223846793005) + np.uint64(1442695040888963407)
            chosen[corner] = np.int64((state >> np.uint64(33)) % np.uint64(size))
        i, j, k = chosen[0], chosen[1], chosen[2]
        x, y, z = points[0, i], points[1, i], points[2, i]
        ux, uy, uz = points[0, j] - x, points[1, j] - y, points[2, j] - z
        vx, vy, vz = points[0, k] - x, points[1, k] - y, points[2, k] - z
        a, b, c = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        length = math.sqrt(a * a + b * b + c * c)
        if not (length > _LEAST_CROSS):
            continue
        a, b, c = a / length, b / length, c / length
        d = -(a * x + b * y + c * z)
        near = 0
        for i in range(size):
            near += abs(points[0, i] * a + points[1, i] * b + points[2, i] * c + d) < reach
        if near > most:
            most = near
            best[0], best[1], best[2], best[3] = a, b, c, d
    return best, most >= 0


def refined_plane(points: FloatArray, plane: FloatArray, reach: float) -> tuple[FloatArray, float, float]:
    """Least squares on the points near the plane, repeated with the reach that their scatter asks for.

    Args:
        points: (3, m) [m].
        plane: (4,) to start from.
        reach: distance up to which points count at first [m].

    Returns:
        the plane (4,), robust standard deviation of the points about it and the reach that follows from it [m].
    """
    some = np.ascontiguousarray(points[:, :: max(1, points.shape[1] // _JUDGED)])
    noise = reach
    for _ in range(_ROUNDS):
        fitted, _, count = _fitted(points, plane, reach)
        if count < 10:
            break
        plane = fitted
        distance = np.abs(plane[:3] @ some + plane[3])
        near = distance[distance <= reach]
        before, noise = noise, _deviation(near) if len(near) else reach
        reach = max(3.5 * noise, 1e-6)
        if abs(noise - before) < _SETTLED * noise:
            break
    return plane, noise, reach


def _deviation(distance: FloatArray) -> float:
    """Robust standard deviation from the middle one of the distances."""
    middle = len(distance) // 2
    return 1.4826 * float(np.partition(distance, middle)[middle])


@compiled_sums
def _fitted(points: FloatArray, plane: FloatArray, reach: float) -> tuple[FloatArray, float, int]:
    """Plane (4,) fitted to those of the (3, n) points that lie within ``reach`` of another, their variance across the
    narrow direction in it, and how many they are.
    """
    a, b, c, d = plane[0], plane[1], plane[2], plane[3]
    x0, y0, z0 = points[0, 0], points[1, 0], points[2, 0]  # relative to a point, to keep the digits
    count, x, y, z = 0.0, 0.0, 0.0, 0.0
    xx, xy, xz, yy, yz, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(points.shape[1]):
        px, py, pz = points[0, i], points[1, i], points[2, i]
        near = 1.0 if abs(px * a + py * b + pz * c + d) <= reach else 0.0
        px, py, pz = (px - x0) * near, (py - y0) * near, (pz - z0) * near
        count, x, y, z = count + near, x + px, y + py, z + pz
        xx, xy, xz = xx + px * px, xy + px * py, xz + px * pz
        yy, yz, zz = yy + py * py, yz + py * pz, zz + pz * pz
    fitted, moments = plane.copy(), np.zeros((3, 3))
    if count > 0.0:
        x, y, z = x / count, y / count, z / count
        moments[0, 0], moments[1, 1], moments[2, 2] = xx / count - x * x, yy / count - y * y, zz / count - z * z
        moments[0, 1] = moments[1, 0] = xy / count - x * y
        moments[0, 2] = moments[2, 0] = xz / count - x * z
        moments[1, 2] = moments[2, 1] = yz / count - y * z
        _turn_to_least(moments, fitted)
        fitted[3] = -(fitted[0] * (x + x0) + fitted[1] * (y + y0) + fitted[2] * (z + z0))
    return fitted, _middle(moments, fitted), int(count)


@compiled_part
def _turn_to_least(moments: FloatArray, plane: FloatArray) -> None:
    """Turns the normal of a plane into the direction in which the moments are least, on the same side.

    Inverse iteration with the adjugate, which needs no division: each step leaves the ratio of the least to the middle
    moment of the error, a millionth for a table. Points on one line have no such direction: what comes out then has no
    spread, and is refused for that.
    """
    for _ in range(_TURNS):
        a, b, c = plane[0], plane[1], plane[2]
        x, y, z = 0.0, 0.0, 0.0
        for k in range(3):
            weight = plane[k]
            i, j = (k + 1) % 3, (k + 2) % 3
            x += weight * (moments[i, 1] * moments[j, 2] - moments[i, 2] * moments[j, 1])
            y += weight * (moments[i, 2] * moments[j, 0] - moments[i, 0] * moments[j, 2])
            z += weight * (moments[i, 0] * moments[j, 1] - moments[i, 1] * moments[j, 0])
        length = math.sqrt(x * x + y * y + z * z)
        if not (length > 0.0):
            return
        length = length if x * a + y * b + z * c >= 0.0 else -length
        plane[0], plane[1], plane[2] = x / length, y / length, z / length


@compiled_part
def _middle(moments: FloatArray, normal: FloatArray) -> float:
    """Middle one of the principal moments, where the least one is that along the normal; 0 for points on a line."""
    least, minors, trace = 0.0, 0.0, moments[0, 0] + moments[1, 1] + moments[2, 2]
    for i in range(3):
        j = (i + 1) % 3
        least += normal[i] * (moments[i, 0] * normal[0] + moments[i, 1] * normal[1] + moments[i, 2] * normal[2])
        minors += moments[i, i] * moments[j, j] - moments[i, j] * moments[i, j]
    both = trace - least
    product = minors - least * both
    return max(0.5 * (both - math.sqrt(max(both * both - 4.0 * product, 0.0))), 0.0)


def plane_spread(points: FloatArray, plane: FloatArray, reach: float) -> tuple[int, float]:
    """How many of the (3, n) points lie within ``reach`` of the plane, and their standard deviation across its narrow
    direction.
    """
    _, variance, count = _fitted(points, plane, reach)
    return int(count), math.sqrt(variance)
