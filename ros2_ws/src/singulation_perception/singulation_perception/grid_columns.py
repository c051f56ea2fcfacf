"""Grid of cells for Euclidean clustering: (x, y) columns, each with a short sorted list of z cells.

Clouds come row by row, and neighbours in a row mostly share a cell. So runs of points, not points, are sorted.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from singulation_core import InvalidInputError
from singulation_perception.jit import compiled

IntArray = NDArray[np.int32]
Keys = NDArray[np.int64]
Cloud = NDArray[np.float32]

_EDGE = 0.99999 / np.sqrt(3.0)  # a little under 1: float32 rounding must not part the points of a cell
PAD = 2  # cells farther apart than two hold no linked points
_DENSE = 4_000_000  # columns of a table that is looked up directly
_CHUNK = 96  # numbers that are compared with the bounds at once; a multiple of three

# The half of the 5x5 neighbourhood that comes later, nearest first.
_LATER = np.array(
    ((1, 0), (0, 1), (1, 1), (-1, 1), (2, 0), (0, 2), (2, 1), (1, 2), (-1, 2), (-2, 1), (2, 2), (-2, 2)),
    dtype=np.int64,
)


class Cells(NamedTuple):
    """Points of a cloud in c cells of m columns; a named tuple, because compiled code takes it.

    Args:
        begin: (r + 1,) first point of each run of points that follow each other in one cell.
        order: (r,) runs by column and z.
        of_run: (r,) cell of each run.
        first: (c + 1,) first of the runs of each cell, in ``order``.
        level: (c,) place of each cell in z.
        column: (m + 1,) first cell of each column.
        neighbours: (12, m) later neighbours of each column, nearest first, -1 where there is none.
    """

    begin: IntArray
    order: IntArray
    of_run: IntArray
    first: IntArray
    level: IntArray
    column: IntArray
    neighbours: IntArray


def cells_of(cloud: Cloud, tolerance: float, low: NDArray[np.float64], high: NDArray[np.float64]) -> Cells:
    """Sorts points into cells that hold only points nearer to one another than the tolerance.

    Args:
        cloud: (n, 3) finite points, n > 0.
        tolerance: of the clustering [m].
        low: (3,) least coordinates.
        high: (3,) greatest coordinates.

    Raises:
        InvalidInputError: the tolerance is so small that cells cannot be numbered.
    """
    edge = _EDGE * tolerance
    counts = np.floor((high - low) / edge) + 1 + 2 * PAD
    if not (counts.max() < 2**30):
        raise InvalidInputError(f"tolerance: {tolerance} m is too small for a cloud {(high - low).max():.3g} m wide")
    width, columns = int(counts[0]), int(counts[0] * counts[1])
    begin, key, depth = _runs(cloud, low, 1.0 / edge, width)
    offsets = _LATER[:, 1] * width + _LATER[:, 0]
    if columns <= _DENSE:
        number, starts, kept, slot = _numbered(key, columns)
        neighbours = _looked_up(kept, slot, offsets)
    else:
        kept, number, sizes = np.unique(key, return_inverse=True, return_counts=True)
        number, starts = number.astype(np.int32), np.concatenate(([0], np.cumsum(sizes))).astype(np.int32)
        neighbours = _sought(kept, offsets)
    order = _in_order(number, depth, starts)
    of_run, first, level, column = _cells(order, depth, starts)
    return Cells(begin, order, of_run, first, level, column, neighbours)


@compiled
def _runs(cloud: Cloud, low: NDArray[np.float64], scale: float, width: int) -> tuple[IntArray, Keys, IntArray]:
    """First point of each run, and its column and place in z."""
    begin = np.empty(len(cloud) + 1, dtype=np.int32)
    key, depth = np.empty(len(cloud) + 1, dtype=np.int64), np.empty(len(cloud) + 1, dtype=np.int32)
    x0, y0, z0 = low[0], low[1], low[2]
    count, last_column, last_level = 0, np.int64(-1), np.int64(-1)
    for i in range(len(cloud)):
        x, y = np.int64((cloud[i, 0] - x0) * scale) + PAD, np.int64((cloud[i, 1] - y0) * scale) + PAD
        column, level = y * width + x, np.int64((cloud[i, 2] - z0) * scale)
        begin[count], key[count], depth[count] = i, column, level  # without a branch: the next run writes over it
        count += (column != last_column) | (level != last_level)
        last_column, last_level = column, level
    begin[count] = len(cloud)
    return begin[: count + 1], key[:count], depth[:count]


@compiled
def _numbered(key: Keys, columns: int) -> tuple[IntArray, IntArray, Keys, IntArray]:
    """Number of each run's column among the m that are occupied, (m + 1,) how many runs come before each column, key
    of each column, and the number of every column, -1 where there is nothing.
    """
    slot = np.zeros(columns, dtype=np.int32)
    for i in range(len(key)):
        slot[key[i]] += 1
    starts, kept = np.empty(len(key) + 1, dtype=np.int32), np.empty(len(key), dtype=np.int64)
    count, total = 0, 0
    for column in range(columns):
        size = slot[column]
        slot[column] = -1
        if size > 0:
            slot[column], starts[count], kept[count] = count, total, column
            count += 1
            total += size
    starts[count] = total
    number = np.empty(len(key), dtype=np.int32)
    for i in range(len(key)):
        number[i] = slot[key[i]]
    return number, starts[: count + 1], kept[:count], slot


@compiled
def _looked_up(kept: Keys, slot: IntArray, offsets: Keys) -> IntArray:
    neighbours = np.empty((len(offsets), len(kept)), dtype=np.int32)
    for j in range(len(offsets)):
        for i in range(len(kept)):
            neighbours[j, i] = slot[kept[i] + offsets[j]]
    return neighbours


def _sought(kept: Keys, offsets: Keys) -> IntArray:
    """The same for clouds too wide for a table of columns."""
    wanted = kept + offsets[:, None]
    place = np.searchsorted(kept, wanted).clip(max=len(kept) - 1)
    return np.where(kept[place] == wanted, place, -1).astype(np.int32)


@compiled
def _in_order(number: IntArray, depth: IntArray, starts: IntArray) -> IntArray:
    """Runs sorted by column and, within a column, by z; those of one cell stay in their order."""
    following = starts.copy()
    order, levels = np.empty(len(number), dtype=np.int32), np.empty(len(number), dtype=np.int32)
    for i in range(len(number)):
        level, begin = depth[i], starts[number[i]]
        at = following[number[i]]
        following[number[i]] += 1
        while at > begin and levels[at - 1] > level:
            levels[at], order[at] = levels[at - 1], order[at - 1]
            at -= 1
        levels[at], order[at] = level, i
    return order


@compiled
def _cells(order: IntArray, depth: IntArray, starts: IntArray) -> tuple[IntArray, IntArray, IntArray, IntArray]:
    """Cell of each run, first run and place in z of each cell, first cell of each column."""
    of_run = np.empty(len(order), dtype=np.int32)
    first, level = np.empty(len(order) + 1, dtype=np.int32), np.empty(len(order), dtype=np.int32)
    column = np.empty(len(starts), dtype=np.int32)
    count = 0
    for k in range(len(starts) - 1):
        column[k] = count
        for at in range(starts[k], starts[k + 1]):
            run = order[at]
            if at == starts[k] or depth[run] != level[count - 1]:
                first[count], level[count] = at, depth[run]
                count += 1
            of_run[run] = count - 1
    column[len(starts) - 1], first[count] = count, len(order)
    return of_run, first[: count + 1], level[:count], column


@compiled
def bounds(cloud: Cloud) -> tuple[NDArray[np.float64], NDArray[np.float64], bool]:
    """Least and greatest coordinates, (3,) each, and whether all are finite.

    Most points lie within the bounds of those before; whether a chunk of them does is counted without a branch.
    """
    numbers = cloud.reshape(-1)
    least, greatest = np.empty(_CHUNK, dtype=np.float32), np.empty(_CHUNK, dtype=np.float32)
    for k in range(_CHUNK):
        least[k], greatest[k] = numbers[k % 3], numbers[k % 3]
    finite = True
    for begin in range(0, len(numbers), _CHUNK):
        size, within = min(_CHUNK, len(numbers) - begin), 0
        for k in range(size):
            value = numbers[np.uintp(begin) + np.uintp(k)]
            within += (value >= least[k]) & (value <= greatest[k])
        if within == size:
            continue
        for k in range(size):
            value = numbers[begin + k]
            least[k % 3], greatest[k % 3] = min(least[k % 3], value), max(greatest[k % 3], value)
            finite = finite and abs(value) < np.inf
        for k in range(3, _CHUNK):
            least[k], greatest[k] = least[k % 3], greatest[k % 3]
    low, high = least[:3].astype(np.float64), greatest[:3].astype(np.float64)
    for axis in range(3):
        finite = finite and abs(low[axis]) < np.inf and abs(high[axis]) < np.inf
    return low, high, finite
