"""One pass over the cloud: what stands on the table, in table coordinates, as runs along the rows of the image."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.byte_scan import end_of, repeated
from singulation_perception.cloud_sample import Workspace
from singulation_perception.coarse_look import BLOCK, HEIGHT, Marks, Values, coordinates, marked_blocks
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
    height, kind = np.empty(cloud.width + 2, dtype=np.float32), np.zeros((cloud.width + 7) // 8 * 8, dtype=np.uint8)
    bits, words, numbers = height.view(np.int32), kind.view(np.uint64), xyz.reshape(-1)
    count, run, outside = np.int64(0), np.int64(0), 0
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
            _classify(height, kind, stop - begin, lowest, pose[2, 3], step)
            size = np.uintp(stop - begin)
            first = end_of(words, np.uintp(0), size, _ALL_NOTHING)
            while first < size:
                end = first + np.uintp(1)
                if end < size:
                    end = end_of(words, end, size, _ALL_GO_ON)
                column, length = begin + np.int64(first), np.int64(end - first)
                inside = _locate(cloud, row, column, pose, limits, height, first, length, numbers, count)
                if inside == length:
                    _note(runs, spans, run, row, column, count, height, bits, first, length)
                    count, run = count + length, run + 1
                elif inside > 0:
                    count, run = _crop(
                        runs, spans, run, row, column, count, height, bits, first, length, numbers, limits
                    )
                outside += length - inside
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
    height: Values, kind: NDArray[np.uint8], size: int, lowest: np.float32, nowhere: np.float32, step: np.float32
) -> None:
    """Says of each point whether it may belong to an object, and whether to the run of the one before.

    Only ``nowhere``, the height of (0, 0, 0), is that high: what is not a point counts as low.
    """
    for k in range(size):
        i = np.uintp(k)
        kind[i] = np.uint8((height[i] > lowest) & (height[i] < _TOO_FAR) & (height[i] != nowhere))
    for k in range(size - 1):
        one, two = np.uintp(size - 2 - k), np.uintp(size - 1 - k)
        near = (kind[one] == _BEGINS) & (kind[two] == _BEGINS) & (abs(height[two] - height[one]) <= step)
        kind[two] += np.uint8(near)


@compiled_part_sums
def _locate(
    cloud: Raster,
    row: int,
    column: int,
    pose: NDArray[np.float32],
    limits: NDArray[np.float32],
    height: Values,
    first: np.uintp,
    length: int,
    numbers: Values,
    count: int,
) -> int:
    """Writes the points of a run, which begins at ``first`` among the heights, behind the ``count`` written ones; how
    many of them lie inside the workspace.

    Into a flat array and with a known step, which makes vector instructions of it.
    """
    seen, point_step = cloud.numbers, np.uintp(cloud.point_step)
    start, at = np.uintp(row * cloud.row_step + column * cloud.point_step), np.uintp(3 * count)
    one, two, three = np.uintp(1), np.uintp(2), np.uintp(3)
    xa, xb, xc, xd = pose[0, 0], pose[0, 1], pose[0, 2], pose[0, 3]  # read once: what is written might be theirs
    ya, yb, yc, yd = pose[1, 0], pose[1, 1], pose[1, 2], pose[1, 3]
    x_min, x_max, y_min, y_max = limits[0], limits[1], limits[2], limits[3]
    inside = 0
    if point_step == three:
        for k in range(length):
            i = np.uintp(k)
            p, to = start + three * i, at + three * i
            a, b, c = seen[p], seen[p + one], seen[p + two]
            x, y = a * xa + b * xb + c * xc + xd, a * ya + b * yb + c * yc + yd
            numbers[to], numbers[to + one], numbers[to + two] = x, y, height[first + i]
            inside += (x >= x_min) & (x <= x_max) & (y >= y_min) & (y <= y_max)
    else:
        for k in range(length):
            i = np.uintp(k)
            p, to = start + point_step * i, at + three * i
            a, b, c = seen[p], seen[p + one], seen[p + two]
            x, y = a * xa + b * xb + c * xc + xd, a * ya + b * yb + c * yc + yd
            numbers[to], numbers[to + one], numbers[to + two] = x, y, height[first + i]
            inside += (x >= x_min) & (x <= x_max) & (y >= y_min) & (y <= y_max)
    return inside


@compiled_part
def _is_inside(x: np.float32, y: np.float32, limits: NDArray[np.float32]) -> bool:
    return (x >= limits[0]) & (x <= limits[1]) & (y >= limits[2]) & (y <= limits[3])


@compiled_part
def _crop(
    runs: IntArray,
    spans: FloatArray,
    run: int,
    row: int,
    column: int,
    count: int,
    height: Values,
    bits: IntArray,
    first: np.uintp,
    length: int,
    numbers: Values,
    limits: NDArray[np.float32],
) -> tuple[int, int]:
    """Notes the parts of a written run that lie inside the workspace, their points moved together; how many points and
    runs there are then.
    """
    written, begun = count, np.int64(0)
    for k in range(length + 1):
        at = 3 * (written + k)
        if k < length and _is_inside(numbers[at], numbers[at + 1], limits):
            to = 3 * (count + k - begun)
            numbers[to], numbers[to + 1], numbers[to + 2] = numbers[at], numbers[at + 1], numbers[at + 2]
            continue
        if k > begun:
            _note(runs, spans, run, row, column + begun, count, height, bits, first + np.uintp(begun), k - begun)
            count, run = count + k - begun, run + 1
        begun = np.int64(k + 1)
    return count, run


@compiled_part_sums
def _note(
    runs: IntArray,
    spans: FloatArray,
    run: int,
    row: int,
    column: int,
    count: int,
    height: Values,
    bits: IntArray,
    first: np.uintp,
    length: int,
) -> None:
    """Writes a run and its span, with vector instructions: sums of small differences, which single precision holds, and
    least and greatest bits, for positive numbers are ordered as their bits. The last two places are worked in.
    """
    runs[run, ROW], runs[run, START], runs[run, STOP], runs[run, FIRST] = row, column, column + length, count
    level, total, squares = height[first], np.float32(0.0), np.float32(0.0)
    for k in range(length):
        more = height[first + np.uintp(k)] - level
        total += more
        squares += more * more
    low, high = bits[first], bits[first]
    for k in range(length):
        value = bits[first + np.uintp(k)]
        low, high = min(low, value), max(high, value)
    least, greatest = np.uintp(len(bits) - 2), np.uintp(len(bits) - 1)
    bits[least], bits[greatest] = low, high
    base = np.float64(level)
    spans[run, LOW], spans[run, HIGH], spans[run, SUM] = height[least], height[greatest], length * base + total
    spans[run, SQUARES] = length * base * base + 2.0 * base * total + squares


@compiled_part
def widen(spans: FloatArray, run: int, height: float) -> None:
    """Takes one more point into the span of a run."""
    spans[run, LOW], spans[run, HIGH] = min(spans[run, LOW], height), max(spans[run, HIGH], height)
    spans[run, SUM] += height
    spans[run, SQUARES] += height * height
