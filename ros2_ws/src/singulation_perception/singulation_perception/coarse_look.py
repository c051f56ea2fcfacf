"""A look at every few rows of a cloud: where something may stand on the table.

Reading a cloud of millions of points takes longer than all that is done with it, and most of it is bare table. Every
``stride``-th row is read first; between these rows only the surroundings of what they show are read. What is missed is
less than ``stride`` rows high and more than a block of columns away from everything that the looked-at rows show:
with the stride chosen here it is narrower than the narrowest block, which is dropped as a sliver anyway.
"""

import numpy as np
from numpy.typing import NDArray

from singulation_perception.jit import compiled_part_sums, compiled_sums
from singulation_perception.prefetch import LINE, prefetch
from singulation_perception.raster import Raster

BLOCK = 16  # columns that are looked at together
_MOST = 6  # rows: more would hardly save any reading
_SHARE = 0.5  # of the least width of a block between two rows that are looked at

Values = NDArray[np.float32]
Marks = NDArray[np.uint8]


def rows_between(cloud: Raster, pitch: float, min_width: float) -> int:
    """How far apart the rows of the first look may be.

    Args:
        cloud: camera frame [m].
        pitch: distance of neighbouring points, rather too large than too small [m].
        min_width: of the narrowest block [m].
    """
    if cloud.height == 1:
        return 1
    return max(1, min(_MOST, int(_SHARE * min_width / pitch))) if pitch > 0.0 else 1


def marked_blocks(
    cloud: Raster, columns: NDArray[np.int32], pose: NDArray[np.float32], lowest: float, stride: int
) -> Marks:
    """Which blocks of which bands of rows have to be looked at.

    Args:
        cloud: camera frame [m].
        columns: (H, 2) first column and column after the last to look at, in each row.
        pose: (3, 4) of the camera in ``table``.
        lowest: height from which a point belongs to an object [m].
        stride: rows of a band; the first of each is looked at.

    Returns:
        (bands, blocks) 1 where to look.
    """
    bands, blocks = -(-cloud.height // stride), -(-cloud.width // BLOCK)
    marks = np.zeros((bands + 2, blocks + 2), dtype=np.uint8)
    if stride == 1:
        marks[:] = 1
        return marks[1:-1, 1:-1]
    _mark(cloud, columns, pose, np.float32(lowest), stride, marks)
    below = marks[1:-1] | marks[2:]  # a band lies between its first row and that of the next
    return below[:, :-2] | below[:, 1:-1] | below[:, 2:]


@compiled_sums
def _mark(
    cloud: Raster,
    columns: NDArray[np.int32],
    pose: NDArray[np.float32],
    lowest: np.float32,
    stride: int,
    marks: Marks,
) -> None:
    """Sets the marks, one row and one column further on, of the blocks that show something."""
    levels = np.empty(cloud.width + BLOCK, dtype=np.float32)
    nowhere = pose[2, 3]  # height of (0, 0, 0), which is no point
    for row in range(0, cloud.height, stride):
        first = np.int64(columns[row, 0]) // BLOCK  # whole blocks: a known length makes vector instructions
        count = np.int64(columns[row, 1]) - first * BLOCK
        ahead = min(row + stride, cloud.height - 1) * cloud.row_step + first * BLOCK * cloud.point_step
        for at in range(0, count * cloud.point_step, LINE):
            prefetch(cloud.numbers, ahead + at)
        heights(cloud, row, first * BLOCK, pose, levels, count)
        for i in range(count, -(-count // BLOCK) * BLOCK):
            levels[i] = -np.inf
        for block in range(-(-count // BLOCK)):
            some, base = 0, np.uintp(block * BLOCK)
            for i in range(BLOCK):
                level = levels[base + np.uintp(i)]
                some += (level > lowest) & (level != nowhere)
            if some > 0:
                marks[row // stride + 1, first + block + 1] = 1


@compiled_part_sums
def heights(cloud: Raster, row: int, first: int, pose: NDArray[np.float32], values: Values, count: int) -> None:
    """Heights above ``table`` of ``count`` points of a row.

    A known step makes vector instructions of it.
    """
    start = row * cloud.row_step + first * cloud.point_step
    if cloud.point_step == 3:
        _levels(cloud.numbers, np.uintp(start), np.uintp(3), pose, values, count)
    else:
        _levels(cloud.numbers, np.uintp(start), np.uintp(cloud.point_step), pose, values, count)


@compiled_part_sums
def _levels(
    numbers: Values, start: np.uintp, point_step: np.uintp, pose: NDArray[np.float32], values: Values, count: int
) -> None:
    a, b, c, d = pose[2, 0], pose[2, 1], pose[2, 2], pose[2, 3]
    one, two = np.uintp(1), np.uintp(2)
    for i in range(count):
        at = start + point_step * np.uintp(i)
        values[i] = numbers[at] * a + numbers[at + one] * b + numbers[at + two] * c + d
