"""One pass over the cloud: what stands on the table, in table coordinates, as runs along the rows of the image."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.cloud_sample import Workspace
from singulation_perception.jit import compiled_sums
from singulation_perception.raster import Raster

IntArray = NDArray[np.int32]
Heights = NDArray[np.float32]

ROW, START, STOP, FIRST = 0, 1, 2, 3  # columns of a table of runs

_BLOCK = 32  # points of a row that are passed over together if none of them is high enough
_ROOM = 800_000  # points at first: usual scenes need less, and fresh memory costs more than looking at the points
_TOO_FAR = 100.0  # [m] above the table: an infinite or absurd point


@dataclass(frozen=True, eq=False)
class ObjectPoints:
    """Points above the table, in the order of the image.

    Args:
        xyz: (n, 3) float32 in ``table`` [m].
        runs: (m, 4) int32: row, first column, column after the last, number of the first point. Neighbours inside a
            run differ by at most the height step.
        spans: (m, 2) least and greatest height in each run [m].
        outside: object points left out because they lie outside the workspace.
    """

    xyz: NDArray[np.float32]
    runs: IntArray
    spans: NDArray[np.float32]
    outside: int


def object_points(
    cloud: Raster,
    table_from_camera: FloatArray,
    workspace: Workspace | None,
    columns: IntArray,
    lowest: float,
    step: float,
) -> ObjectPoints:
    """Collects what is higher than ``lowest`` and inside the workspace.

    Args:
        cloud: camera frame [m].
        table_from_camera: 4x4 of the fitted table.
        workspace: limits in ``table``, or None.
        columns: (H, 2) first column and column after the last to look at, in each row.
        lowest: height from which a point belongs to an object [m].
        step: height difference at which a run ends [m].
    """
    limits = np.array(workspace or (-np.inf, np.inf, -np.inf, np.inf), dtype=np.float32)
    pose = table_from_camera[:3].astype(np.float32)
    most = int((columns[:, 1] - columns[:, 0]).sum())
    sizes = min(most, _ROOM), min(most // 2 + len(columns), _ROOM // 8)
    while True:
        xyz = np.empty((sizes[0], 3), dtype=np.float32)
        runs = np.empty((sizes[1], 4), dtype=np.int32)
        spans = np.empty((sizes[1], 2), dtype=np.float32)
        count, run_count, outside = _collect(
            cloud, columns, pose, limits, np.float32(lowest), np.float32(step), xyz, runs, spans
        )
        if count >= 0:
            return ObjectPoints(xyz[:count], runs[:run_count], spans[:run_count], outside)
        sizes = most, most // 2 + len(columns)


@compiled_sums
def _collect(
    cloud: Raster,
    columns: IntArray,
    pose: NDArray[np.float32],
    limits: NDArray[np.float32],
    lowest: np.float32,
    step: np.float32,
    xyz: NDArray[np.float32],
    runs: IntArray,
    spans: NDArray[np.float32],
) -> tuple[int, int, int]:
    """Numbers of points and runs written, and of points outside; -1 points if there is no room for all."""
    numbers, point_step = cloud.numbers, np.uintp(cloud.point_step)
    # Numbers of their own: array elements would be read again after every point that is written.
    ax, bx, cx, dx = pose[0, 0], pose[0, 1], pose[0, 2], pose[0, 3]
    ay, by, cy, dy = pose[1, 0], pose[1, 1], pose[1, 2], pose[1, 3]
    x_min, x_max, y_min, y_max = limits[0], limits[1], limits[2], limits[3]
    levels = np.empty(cloud.width, dtype=np.float32)
    count, run, outside = 0, -1, 0
    before, stop, low, high = lowest, 0, lowest, lowest
    for row in range(cloud.height):
        left, width = int(columns[row, 0]), int(columns[row, 1] - columns[row, 0])
        start = np.uintp(row * cloud.row_step + left * cloud.point_step)
        if count + width > len(xyz) or run + width // 2 + 2 > len(runs):
            return -1, 0, 0
        _heights(numbers, start, point_step, pose, levels, width)
        last = -2
        for begin in range(0, width, _BLOCK):
            end = min(begin + _BLOCK, width)
            some = 0
            for column in range(begin, end):
                some += levels[column] > lowest
            if some == 0:
                continue
            for column in range(begin, end):
                level = levels[column]
                if not (level > lowest):
                    continue
                at = start + np.uintp(column) * point_step
                a, b, c = numbers[at], numbers[at + np.uintp(1)], numbers[at + np.uintp(2)]
                x, y = a * ax + b * bx + c * cx + dx, a * ay + b * by + c * cy + dy
                if not (x_min <= x <= x_max and y_min <= y <= y_max):
                    outside += 1
                    continue
                if not (level < _TOO_FAR) or (a == 0.0 and b == 0.0 and c == 0.0):
                    continue
                if last != column - 1 or not (abs(level - before) <= step):
                    if run >= 0:
                        runs[run, 2], spans[run, 0], spans[run, 1] = stop, low, high
                    run += 1
                    runs[run, 0], runs[run, 1], runs[run, 3] = row, left + column, count
                    low, high = level, level
                last, before, stop = column, level, left + column + 1
                low, high = min(low, level), max(high, level)
                xyz[count, 0], xyz[count, 1], xyz[count, 2] = x, y, level
                count += 1
    if run >= 0:
        runs[run, 2], spans[run, 0], spans[run, 1] = stop, low, high
    return count, run + 1, outside


@compiled_sums
def _heights(
    numbers: NDArray[np.float32],
    start: int,
    point_step: int,
    pose: NDArray[np.float32],
    levels: NDArray[np.float32],
    width: int,
) -> None:
    """Heights of the points of one row; unsigned indices and a known step, because that makes vector instructions."""
    a, b, c, d = pose[2, 0], pose[2, 1], pose[2, 2], pose[2, 3]
    one, two, three = np.uintp(1), np.uintp(2), np.uintp(3)
    if point_step == three:
        for column in range(width):
            at = start + three * np.uintp(column)
            levels[column] = numbers[at] * a + numbers[at + one] * b + numbers[at + two] * c + d
    else:
        for column in range(width):
            at = start + point_step * np.uintp(column)
            levels[column] = numbers[at] * a + numbers[at + one] * b + numbers[at + two] * c + d
