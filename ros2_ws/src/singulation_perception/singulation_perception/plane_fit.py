"""Robust fit of a plane to points: the best of many three-point planes, then least squares on what lies near it."""

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.jit import compiled, compiled_sums

_SCORED = 2_000  # points that score a hypothesis
_HOLDS = 0.5  # share of the points near a plane that no other can have
_ROUNDS = 4
_SETTLED = 0.02  # relative change of the noise that ends the fit


def best_plane(points: FloatArray, hypotheses: int, reach: float, first: FloatArray | None = None) -> FloatArray | None:
    """The plane through three of the points that has most of them near it.

    Args:
        points: (m, 3) [m].
        hypotheses: how many to try.
        reach: distance that counts as near [m].
        first: a plane (4,) that is taken at once if more than half of the points lie near it.

    Returns:
        (4,) unit normal and offset, distance = normal . point + offset; None if the points lie on one line.
    """
    random = np.random.default_rng(7)  # equal clouds give equal planes
    scored = np.ascontiguousarray(points[random.integers(0, len(points), _SCORED)].T)
    if first is not None and np.count_nonzero(np.abs(first[:3] @ scored + first[3]) < reach) > _HOLDS * _SCORED:
        return first
    corners = points[random.integers(0, len(points), (hypotheses, 3))]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    usable = lengths > 1e-12
    normals = normals[usable] / lengths[usable, None]
    planes = np.column_stack((normals, -(normals * corners[usable, 0]).sum(axis=1)))
    if not len(planes):
        return None
    return np.asarray(planes[_best(planes, scored, reach)])


@compiled
def _best(planes: FloatArray, points: FloatArray, reach: float) -> int:
    """Plane with most of the (3, n) points within ``reach``."""
    best, most = 0, -1
    for k in range(len(planes)):
        a, b, c, d = planes[k, 0], planes[k, 1], planes[k, 2], planes[k, 3]
        near = 0
        for i in range(points.shape[1]):
            near += abs(points[0, i] * a + points[1, i] * b + points[2, i] * c + d) < reach
        if near > most:
            best, most = k, near
    return best


def refined_plane(points: FloatArray, plane: FloatArray, reach: float) -> tuple[FloatArray, float, float]:
    """Least squares on the points near the plane, repeated with the reach that their scatter asks for.

    Args:
        points: (m, 3) [m].
        plane: (4,) to start from.
        reach: distance up to which points count at first [m].

    Returns:
        the plane (4,), robust standard deviation of the points about it and the reach that follows from it [m].
    """
    noise = reach
    for _ in range(_ROUNDS):
        centre, moments, count = _moments(points, plane, reach)
        if count < 10:
            break
        normal = np.linalg.eigh(moments)[1][:, 0]
        normal = normal if normal @ plane[:3] > 0.0 else -normal
        plane = np.append(normal, -normal @ centre)
        some = np.abs(points[:: max(1, len(points) // 4000)] @ normal + plane[3])
        near = some[some <= reach]
        before, noise = noise, 1.4826 * float(np.median(near)) if len(near) else reach
        reach = max(3.5 * noise, 1e-6)
        if abs(noise - before) < _SETTLED * noise:
            break
    return plane, noise, reach


@compiled_sums
def _moments(points: FloatArray, plane: FloatArray, reach: float) -> tuple[FloatArray, FloatArray, int]:
    """Mean, (3, 3) second moments about it, and number of the points within ``reach``."""
    total, products = np.zeros(3), np.zeros((3, 3))
    count = 0
    for i in range(len(points)):
        if abs(points[i, 0] * plane[0] + points[i, 1] * plane[1] + points[i, 2] * plane[2] + plane[3]) <= reach:
            count += 1
            for j in range(3):
                total[j] += points[i, j] - points[0, j]  # relative, to keep the digits
                for k in range(j, 3):
                    products[j, k] += (points[i, j] - points[0, j]) * (points[i, k] - points[0, k])
    if count == 0:
        return total, products, count
    for j in range(3):
        total[j] /= count
    for j in range(3):
        for k in range(j, 3):
            products[j, k] = products[j, k] / count - total[j] * total[k]
            products[k, j] = products[j, k]
    for j in range(3):
        total[j] += points[0, j]
    return total, products, count


def plane_spread(points: FloatArray, plane: FloatArray, reach: float) -> tuple[int, float]:
    """How many points lie within ``reach`` of the plane, and their standard deviation across its narrow direction."""
    _, moments, count = _moments(points, plane, reach)
    return int(count), float(np.sqrt(max(np.linalg.eigvalsh(moments)[1], 0.0)))
