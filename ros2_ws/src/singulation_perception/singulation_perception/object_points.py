"""One pass over the cloud: what stands on the table, in table coordinates, as runs along the rows of the image."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.cloud_sample import ANY_CLOUD, Window, Workspace

IntArray = NDArray[np.int32]
Heights = NDArray[np.float32]

ROW, START, STOP, FIRST = 0, 1, 2, 3  # columns of a table of runs

_TOO_FAR = 100.0  # [m] above the table: an infinite or absurd point


@dataclass(frozen=True, eq=False)
class ObjectPoints:
    """Points above the table, in the order of the image.

    Args:
        xyz: (n, 3) float32 in ``table`` [m].
        runs: (m, 4) int32: row, first column, column after the last, number of the first point. Neighbours inside a
            run differ by at most the height step.
        outside: object points left out because they lie outside the workspace.
    """

    xyz: NDArray[np.float32]
    runs: IntArray
    outside: int


def object_points(
    points: NDArray[np.float32],
    table_from_camera: FloatArray,
    workspace: Workspace | None,
    window: Window,
    lowest: float,
    step: float,
) -> ObjectPoints:
    """Collects what is higher than ``lowest`` and inside the workspace.

    Args:
        points: (H, W, 3) float32, any strides, camera frame [m].
        table_from_camera: 4x4 of the fitted table.
        workspace: limits in ``table``, or None.
        window: part of the image that is looked at.
        lowest: height from which a point belongs to an object [m].
        step: height difference at which a run ends [m].
    """
    limits = np.array(workspace or (-np.inf, np.inf, -np.inf, np.inf), dtype=np.float32)
    pose = table_from_camera[:3].astype(np.float32)
    top, bottom, left, right = window
    points = points[top:bottom, left:right]
    size = points.shape[0] * points.shape[1]
    xyz = np.empty((size, 3), dtype=np.float32)  # untouched pages cost nothing
    runs = np.empty((size // 2 + points.shape[0], 4), dtype=np.int32)
    count, run_count, outside = _compiled()(points, pose, limits, np.float32(lowest), np.float32(step), xyz, runs)
    runs = runs[:run_count].copy()
    runs[:, ROW] += top
    runs[:, START : STOP + 1] += left
    return ObjectPoints(xyz[:count].copy(), runs, outside)


@lru_cache(maxsize=1)
def _compiled() -> Any:
    """Compiled once for any strides and for read-only clouds, else every kind of cloud would compile anew."""
    signature = types.UniTuple(types.int64, 3)(
        ANY_CLOUD, types.float32[:, ::1], types.float32[::1], types.float32, types.float32,
        types.float32[:, ::1], types.int32[:, ::1],
    )  # fmt: skip
    return njit(signature, cache=True)(_collect)


def _collect(
    points: NDArray[np.float32],
    pose: NDArray[np.float32],
    limits: NDArray[np.float32],
    lowest: np.float32,
    step: np.float32,
    xyz: NDArray[np.float32],
    runs: IntArray,
) -> tuple[int, int, int]:
    height, width = points.shape[0], points.shape[1]
    (ax, bx, cx, dx), (ay, by, cy, dy), (az, bz, cz, dz) = _row(pose, 0), _row(pose, 1), _row(pose, 2)
    x_min, x_max, y_min, y_max = limits[0], limits[1], limits[2], limits[3]
    levels = np.empty(width, dtype=np.float32)
    count, run, outside = 0, -1, 0
    for row in range(height):
        for column in range(width):  # on its own, because the compiler makes vector instructions of it
            a, b, c = points[row, column, 0], points[row, column, 1], points[row, column, 2]
            levels[column] = a * az + b * bz + c * cz + dz
        last = -2
        for column in range(width):
            level = levels[column]
            if not (level > lowest):
                continue
            a, b, c = points[row, column, 0], points[row, column, 1], points[row, column, 2]
            x, y = a * ax + b * bx + c * cx + dx, a * ay + b * by + c * cy + dy
            if not (x_min <= x <= x_max and y_min <= y <= y_max):
                outside += 1
                continue
            if not (level < _TOO_FAR) or (a == 0.0 and b == 0.0 and c == 0.0):
                continue
            if last != column - 1 or not (abs(level - levels[last]) <= step):
                run += 1
                runs[run, 0], runs[run, 1], runs[run, 3] = row, column, count
            last = column
            runs[run, 2] = column + 1
            xyz[count, 0], xyz[count, 1], xyz[count, 2] = x, y, level
            count += 1
    return count, run + 1, outside


@njit(inline="always")
def _row(pose: NDArray[np.float32], row: int) -> tuple[float, float, float, float]:
    """Numbers of their own: array elements would be read again after every point that is written."""
    return pose[row, 0], pose[row, 1], pose[row, 2], pose[row, 3]
