"""An even subsample of a cloud: enough to find the table, the unit of length and the part of the image to look at."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from singulation_core import ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from singulation_core.transforms import inverse, transform_points

_POINTS = 32_000  # looked at; a plane fitted to them is good to about 1/100 of the noise
_FEWEST = 100
_METRES_LIMIT = 30.0  # [m] no sensor of this kind reaches farther
_EVERYWHERE = (-np.inf, np.inf, -np.inf, np.inf)

Workspace = tuple[float, float, float, float]
Window = tuple[int, int, int, int]

# One compiled form for any strides and for read-only clouds, else every kind of cloud would be compiled anew.
ANY_CLOUD = types.Array(types.float32, 3, "A", readonly=True, aligned=True)


@dataclass(frozen=True, eq=False)
class CloudSample:
    """Valid points of every ``step``-th row and column that lie inside the workspace.

    Args:
        located: (m, 3) in the given frame [m].
        window: rows and columns of the cloud that hold the workspace: first row, row after the last, first column,
            column after the last.
        distance: mean distance of the points to the camera [m].
    """

    located: FloatArray
    window: Window
    distance: float


def sample(points: NDArray[np.float32], frame: FloatArray, workspace: Workspace | None) -> CloudSample:
    """Looks at some points of an organized cloud.

    Args:
        points: (H, W, 3), any strides, camera frame [m].
        frame: 4x4 that takes them to the frame of the workspace.
        workspace: limits, or None.

    Raises:
        SingulationError: NO_POINTS if (almost) none is valid or none lies in the workspace, NOT_METRES.
    """
    height, width = points.shape[:2]
    row_step = max(1, int(np.sqrt(height * width / _POINTS))) if height > 1 else 1
    column_step = max(1, int(height * width / row_step / _POINTS))
    limits = np.array(workspace or _EVERYWHERE)
    located, rows, columns, valid = _compiled()(points, row_step, column_step, np.array(frame[:3]), limits)
    looked_at = -(-height // row_step) * -(-width // column_step)
    if valid < min(_FEWEST, looked_at):
        raise SingulationError(
            ResultCode.NO_POINTS,
            f"{valid} of {looked_at} sampled points are valid (finite and not 0 0 0); is the camera covered?",
        )
    if len(located) >= _FEWEST:
        distance = float(np.linalg.norm(transform_points(inverse(frame), located), axis=1).mean())
    else:  # in millimetres, everything lies far outside the workspace
        distance = _mean_distance(points[::row_step, ::column_step])
    if not (distance < _METRES_LIMIT):
        raise SingulationError(
            ResultCode.NOT_METRES,
            f"mean distance {distance:.0f}: the cloud looks like millimetres; clouds are in metres, divide by 1000",
        )
    window = (*_widened(rows, 2 * row_step, height), *_widened(columns, 2 * column_step, width))
    return CloudSample(located, window, distance)


def _mean_distance(points: NDArray[np.float32]) -> float:
    """Of the valid ones among (..., 3) points from the camera [m]."""
    flat = points.reshape(-1, 3).astype(np.float64)
    valid = np.isfinite(flat).all(axis=1) & (flat != 0.0).any(axis=1)
    return float(np.linalg.norm(flat[valid], axis=1).mean()) if valid.any() else 0.0


def _widened(limits: tuple[int, int], margin: int, size: int) -> tuple[int, int]:
    return max(0, limits[0] - margin), min(size, limits[1] + margin + 1)


@lru_cache(maxsize=1)
def _compiled() -> Any:
    pair = types.UniTuple(types.int64, 2)
    result = types.Tuple((types.float64[:, ::1], pair, pair, types.int64))
    return njit(result(ANY_CLOUD, types.int64, types.int64, types.float64[:, ::1], types.float64[::1]), cache=True)(
        _pick
    )


def _pick(
    points: NDArray[np.float32], row_step: int, column_step: int, frame: FloatArray, limits: FloatArray
) -> tuple[FloatArray, tuple[int, int], tuple[int, int], int]:
    height, width = points.shape[0], points.shape[1]
    located = np.empty(((height // row_step + 1) * (width // column_step + 1), 3))
    top, bottom, left, right = height, -1, width, -1
    count, valid = 0, 0
    for row in range(0, height, row_step):
        for column in range(0, width, column_step):
            a = np.float64(points[row, column, 0])
            b = np.float64(points[row, column, 1])
            c = np.float64(points[row, column, 2])
            if not (np.isfinite(a) and np.isfinite(b) and np.isfinite(c)) or (a == 0.0 and b == 0.0 and c == 0.0):
                continue
            valid += 1
            x = a * frame[0, 0] + b * frame[0, 1] + c * frame[0, 2] + frame[0, 3]
            y = a * frame[1, 0] + b * frame[1, 1] + c * frame[1, 2] + frame[1, 3]
            if limits[0] <= x <= limits[1] and limits[2] <= y <= limits[3]:
                located[count, 0], located[count, 1] = x, y
                located[count, 2] = a * frame[2, 0] + b * frame[2, 1] + c * frame[2, 2] + frame[2, 3]
                count += 1
                top, bottom = min(top, row), max(bottom, row)
                left, right = min(left, column), max(right, column)
    return located[:count], (top, bottom), (left, right), valid
