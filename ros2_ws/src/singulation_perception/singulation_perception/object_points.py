"""One pass over the cloud: what stands on the table, in table coordinates, as runs along the rows of the image."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.byte_scan import end_of, repeated
from singulation_perception.cloud_sample import Workspace
from singulation_perception.coarse_look import BLOCK, HEIGHT, Marks, Values, X, Y, coordinates, marked_blocks
from singulation_perception.jit import compiled_part, compiled_part_sums, compiled_sums
from singulation_perception.prefetch import LINE, prefetch
from singulation_perception.raster import Raster

IntArray = NDArray[np.int32]
Points = NDArray[np.float32]

ROW, START, STOP, FIRST = 0, 1, 2, 3  # columns of a table of runs
LOW, HIGH, SUM, SQUARES = 0, 1, 2, 3  # columns of the spans of runs

_ROOM = 800_000  # points at first: usual scenes need less, and fresh memory costs more than looking at the points
_NOTHING, _BEGINS, _GOES_ON = np.uint8(0), np.uint8(1), np.uint8(2)  # kinds of points: an object's begin a run or go on
_ALL_NOTHING, _ALL_GO_ON = repeated(0), repeated(2)
_AHEAD = 4  # rows: without, it takes a third longer where the cloud is in no cache; 1 to 8 differ little
_TOO_FAR = 100.0  # [m] above the table: an infinite or absurd point


@dataclass(frozen=True, eq=False)
class ObjectPoints:
    """Points above the table, in the order of the image.

    Args:
        xyz: (n, 3) float32 in ``table`` [m].
        runs: (m, 4) int32: row, first column, column after the last, number of the first point. Neighbours inside a
            run differ by at most the height step.
        spans: (m, 4) least and greatest height in each run [m], sum of the heights [m] and of their squares [m^2].
        outside: object points left out because they lie outside the workspace.
    """

    xyz: NDArray[np.float32]
    runs: IntArray
    spans: FloatArray
    outside: int


def object_points(
    cloud: Raster,
    table_from_camera: FloatArray,
    workspace: Workspace | None,
    columns: IntArray,
    lowest: float,
    step: float,
    stride: int = 1,
) -> ObjectPoints:
    """Collects what is higher than ``lowest`` and inside the workspace.

    Args:
        cloud: camera frame [m].
        table_from_camera: 4x4 of the fitted table.
        workspace: limits in ``table``, or None.
        columns: (H, 2) first column and column after the last to look at, in each row.
        lowest: height from which a point belongs to an object [m].
        step: height difference at which a run ends [m].
        stride: rows between two that are looked at to find out where the others are, see ``coarse_look``.
    """
    limits = np.array(workspace or (-np.inf, np.inf, -np.inf, np.inf), dtype=np.float32)
    pose = table_from_camera[:3].astype(np.float32)
    most = int((columns[:, 1] - columns[:, 0]).sum())
    sizes = min(most, _ROOM), min(most, _ROOM // 8)
    marks = marked_blocks(cloud, columns, pose, lowest, stride)
    while True:
        xyz = np.empty((sizes[0], 3), dtype=np.float32)
        runs = np.empty((sizes[1], 4), dtype=np.int32)
        spans = np.empty((sizes[1], 4))
        count, run_count, outside = _collect(
            cloud, columns, marks, stride, pose, limits, np.float32(lowest), np.float32(step), xyz, runs, spans
        )
        if count >= 0:
            return ObjectPoints(xyz[:count], runs[:run_count], spans[:run_count], outside)
        sizes = most, most


@compiled_sums
def _collect(
    cloud: Raster,
    columns: IntArray,
    marks: Marks,
    stride: int,
    pose: NDArray[np.float32],
    limits: NDArray[np.float32],
    lowest: np.float32,
    step: np.float32,
    xyz: NDArray[np.float32],
    runs: IntArray,
    spans: FloatArray,
) -> tuple[int, int, int]:
    """Numbers of points and runs written, and of points outside; -1 points if there is no room for all."""
    x, y = np.empty(cloud.width, dtype=np.float32), np.empty(cloud.width, dtype=np.float32)
    height, kind = np.empty(cloud.width, dtype=np.float32), np.zeros((cloud.width + 7) // 8 * 8, dtype=np.uint8)
    words, numbers = kind.view(np.uint64), xyz.reshape(-1)
    count, run, outside = 0, 0, 0
    for row in range(cloud.height):
        stop, right = np.int64(columns[row, 0]), np.int64(columns[row, 1])
        if count + right - stop > len(xyz) or run + right - stop > len(runs):
            return -1, 0, 0
        while stop < right:
            begin, stop = _marked(marks[row // stride], stop, right)
            if begin == stop:
                continue
            ahead = min(row + _AHEAD, cloud.height - 1) * cloud.row_step
            for at in range(begin * cloud.point_step, stop * cloud.point_step, LINE):
                prefetch(cloud.numbers, ahead + at)
            coordinates(cloud, row, begin, pose, HEIGHT, height, stop - begin)
            coordinates(cloud, row, begin, pose, X, x, stop - begin)
            coordinates(cloud, row, begin, pose, Y, y, stop - begin)
            outside += _classify(x, y, height, kind, stop - begin, limits, lowest, pose[2, 3], step)
            size = np.uintp(stop - begin)
            first = end_of(words, np.uintp(0), size, _ALL_NOTHING)
            while first < size:
                end = first + np.uintp(1)
                if end < size:
                    end = end_of(words, end, size, _ALL_GO_ON)
                runs[run, ROW], runs[run, FIRST] = row, count
                runs[run, START], runs[run, STOP] = begin + first, begin + end
                count = _take(x, y, height, first, end, numbers, np.int64(count), spans, np.int64(run))
                run += 1
                first = end_of(words, end, size, _ALL_NOTHING) if end < size else size
    return count, run, outside


@compiled_part
def _marked(marks: Marks, begin: int, right: int) -> tuple[int, int]:
    """The next columns to look at from ``begin`` on, as far as they hang together; none: ``right`` twice."""
    while begin < right and marks[begin // BLOCK] == 0:
        begin = (begin // BLOCK + 1) * BLOCK
    begin = min(begin, right)
    stop = begin
    while stop < right and marks[stop // BLOCK] != 0:
        stop = (stop // BLOCK + 1) * BLOCK
    return begin, min(stop, right)


@compiled_part_sums
def _classify(
    x: Values,
    y: Values,
    height: Values,
    kind: NDArray[np.uint8],
    size: int,
    limits: NDArray[np.float32],
    lowest: np.float32,
    nowhere: np.float32,
    step: np.float32,
) -> int:
    """Says of each point whether it belongs to an object, and whether to the run of the one before; how many would but
    for the workspace.

    Only ``nowhere``, the height of (0, 0, 0), is that high: what is not a point counts as low.
    """
    x_min, x_max, y_min, y_max = limits[0], limits[1], limits[2], limits[3]
    outside = 0
    for k in range(size):
        i = np.uintp(k)
        high = (height[i] > lowest) & (height[i] < _TOO_FAR) & (height[i] != nowhere)
        inside = (x[i] >= x_min) & (x[i] <= x_max) & (y[i] >= y_min) & (y[i] <= y_max)
        kind[i] = np.uint8(high & inside)
        outside += high & ~inside
    for k in range(size - 1):
        one, two = np.uintp(size - 2 - k), np.uintp(size - 1 - k)
        near = (kind[one] == _BEGINS) & (kind[two] == _BEGINS) & (abs(height[two] - height[one]) <= step)
        kind[two] += np.uint8(near)
    return outside


@compiled_part_sums
def _take(
    x: Values,
    y: Values,
    height: Values,
    first: np.uintp,
    end: np.uintp,
    numbers: Values,
    count: int,
    spans: FloatArray,
    run: int,
) -> np.int64:
    """Writes the points of a run and its span; how many points are written then.

    In a flat array, because a known step makes vector instructions; so do sums of small differences, which single
    precision holds.
    """
    at = np.uintp(3 * count)
    one, two, three = np.uintp(1), np.uintp(2), np.uintp(3)
    for k in range(end - first):
        i = np.uintp(k)
        numbers[at + three * i], numbers[at + three * i + one] = x[first + i], y[first + i]
        numbers[at + three * i + two] = height[first + i]
    level, total, squares = height[first], np.float32(0.0), np.float32(0.0)
    for k in range(end - first):
        more = height[first + np.uintp(k)] - level
        total += more
        squares += more * more
    low, high = level, level
    for k in range(end - first):
        value = height[first + np.uintp(k)]
        low, high = min(low, value), max(high, value)
    count_of_run, base = np.float64(end - first), np.float64(level)
    spans[run, LOW], spans[run, HIGH], spans[run, SUM] = low, high, count_of_run * base + total
    spans[run, SQUARES] = count_of_run * base * base + 2.0 * base * total + squares
    return count + np.int64(end - first)


@compiled_part
def widen(spans: FloatArray, run: int, height: float) -> None:
    """Takes one more point into the span of a run."""
    spans[run, LOW], spans[run, HIGH] = min(spans[run, LOW], height), max(spans[run, HIGH], height)
    spans[run, SUM] += height
    spans[run, SQUARES] += height * height
