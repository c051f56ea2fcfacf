"""Rigid transforms as 4x4 float64 matrices; ``a_from_b @ point_b`` is the point in frame a. Quaternions: x, y, z, w."""

import numpy as np
from numpy.typing import ArrayLike

from singulation_core.errors import InvalidInputError
from singulation_core.polygon import FloatArray


def pose_matrix(position: ArrayLike, quaternion: ArrayLike = (0.0, 0.0, 0.0, 1.0)) -> FloatArray:
    """4x4 matrix of a pose: position (3,) [m], unit quaternion (4,) x, y, z, w.

    Raises:
        InvalidInputError: wrong sizes, not finite, or a quaternion whose length is not 1 (within 1e-3).
    """
    origin = np.asarray(position, dtype=np.float64)
    rotation = np.asarray(quaternion, dtype=np.float64)
    if origin.shape != (3,) or rotation.shape != (4,) or not np.isfinite([*origin, *rotation]).all():
        raise InvalidInputError(f"pose: position {position!r}, quaternion {quaternion!r}; need 3 and 4 finite numbers")
    length = float(np.linalg.norm(rotation))
    if not (abs(length - 1.0) <= 1e-3):
        raise InvalidInputError(f"pose: quaternion {rotation.tolist()} has length {length:.4f}, need 1")
    x, y, z, w = rotation / length
    matrix = np.eye(4)
    matrix[:3, :3] = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    matrix[:3, 3] = origin
    return matrix


def quaternion_of(matrix: FloatArray) -> FloatArray:
    """Unit quaternion (4,) x, y, z, w with w >= 0 of a rotation or pose matrix."""
    m = matrix[:3, :3]
    # The eigenvector of the largest eigenvalue is the best unit quaternion, free of case distinctions.
    k = np.array(
        (
            (m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[2, 0] + m[0, 2], m[2, 1] - m[1, 2]),
            (m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]),
            (m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]),
            (m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m[0, 0] + m[1, 1] + m[2, 2]),
        )
    )
    best = np.linalg.eigh(k)[1][:, -1]
    return np.asarray(-best if best[3] < 0.0 else best)


def inverse(matrix: FloatArray) -> FloatArray:
    """Inverse of a rigid 4x4 transform."""
    result = np.eye(4)
    result[:3, :3] = matrix[:3, :3].T
    result[:3, 3] = -matrix[:3, :3].T @ matrix[:3, 3]
    return result


def transform_points(matrix: FloatArray, points: FloatArray) -> FloatArray:
    """(..., 3) points moved by a 4x4 transform."""
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])
