"""One pass over the cloud that collects the object points."""

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.byte_scan import end_of, repeated
from singulation_perception.cloud_sample import Workspace
from singulation_perception.coarse_look import BLOCK, Marks, Values, heights, marked_blocks
from singulation_perception.jit import compiled_part, compiled_part_sums, compiled_sums
from singulation_perception.object_points import IntArray, ObjectPoints
from singulation_perception.point_runs import crop, locate, note
from singulation_perception.prefetch import LINE, prefetch
from singulation_perception.raster import Raster

_ROOM = 800_000  # points at first: usual scenes need less, and fresh memory costs more than looking at the points
_BEGINS = np.uint8(1)  # kind of a point that begins a run; others are no object's (0) or go on with a run (2)
_ALL_NOTHING, _ALL_GO_ON = repeated(0), repeated(2)
_AHEAD = 4  # rows: without, it takes a third longer where the cloud is in no cache; 1 to 8 differ little
_TOO_FAR = 100.0  # [m] above the table: an infinite or absurd point


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
        lowest: height from which a point belongs to an object, more than 0 [m].
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
            heights(cloud, row, begin, pose, height, stop - begin)
            _classify(height, kind, stop - begin, lowest, pose[2, 3], step)
            size = np.uintp(stop - begin)
            first = end_of(words, np.uintp(0), size, _ALL_NOTHING)
            while first < size:
                end = first + np.uintp(1)
                if end < size:
                    end = end_of(words, end, size, _ALL_GO_ON)
                column, length = begin + np.int64(first), np.int64(end - first)
                inside = locate(cloud, row, column, pose, limits, height, first, length, numbers, count)
                if inside == length:
                    note(runs, spans, run, row, column, count, height, bits, first, length)
                    count, run = count + length, run + 1
                elif inside > 0:
                    count, run = crop(
                        runs, spans, run, row, column, count, height, bits, first, length, numbers, limits
                    )
                outside += length - inside
                first = end_of(words, end, size, _ALL_NOTHING) if end < size else size
    return int(count), int(run), outside


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
