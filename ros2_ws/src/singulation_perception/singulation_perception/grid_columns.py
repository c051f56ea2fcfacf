"""Grid of cells for Euclidean clustering: (x, y) columns, each with a short sorted list of z cells."""

import numpy as np
from numpy.typing import NDArray

from singulation_core import InvalidInputError
from singulation_perception.jit import compiled

IntArray = NDArray[np.int32]
Cloud = NDArray[np.float32]

_EDGE = 0.99999 / np.sqrt(3.0)  # a little under 1: float32 rounding must not part the points of a cell
PAD = 2  # cells farther apart than two hold no linked points
_DENSE = 4_000_000  # columns of a table that is looked up directly

# The half of the 5x5 neighbourhood that comes later, nearest first.
_LATER = np.array(
    ((1, 0), (0, 1), (1, 1), (-1, 1), (2, 0), (0, 2), (2, 1), (1, 2), (-1, 2), (-2, 1), (2, 2), (-2, 2)),
    dtype=np.int64,
)

Columns = tuple[Cloud, IntArray, IntArray, IntArray, IntArray]


def columns_of(cloud: Cloud, tolerance: float, low: NDArray[np.float64], high: NDArray[np.float64]) -> Columns:
    """Points sorted into columns of cells.

    Args:
        cloud: (n, 3) finite points, n > 0.
        tolerance: of the clustering [m].
        low: (3,) least coordinates.
        high: (3,) greatest coordinates.

    Returns:
        points in column order (n, 3), their z cells (n,), their places in ``cloud`` (n,), first point of each of the
        m columns (m + 1,), and the later neighbours of each column (12, m), -1 where there is none.

    Raises:
        InvalidInputError: the tolerance is so small that cells cannot be numbered.
    """
    edge = _EDGE * tolerance
    counts = np.floor((high - low) / edge) + 1 + 2 * PAD
    if not (counts.max() < 2**30):
        raise InvalidInputError(f"tolerance: {tolerance} m is too small for a cloud {(high - low).max():.3g} m wide")
    width, columns = int(counts[0]), int(counts[0] * counts[1])
    if columns <= _DENSE:
        key, depth = _dense_keys(cloud, low, 1.0 / edge, width)
        slot, starts = _occupied(key, columns)
        neighbours = _dense_neighbours(slot, len(starts) - 1, _LATER[:, 1] * width + _LATER[:, 0])
    else:
        wide, depth = _wide_keys(cloud, low, 1.0 / edge, width)
        kept, key, sizes = np.unique(wide, return_inverse=True, return_counts=True)
        key, slot = key.astype(np.int32), np.arange(len(kept), dtype=np.int32)
        starts = np.concatenate(([0], np.cumsum(sizes))).astype(np.int32)
        neighbours = _sought_neighbours(kept, _LATER[:, 1] * width + _LATER[:, 0])
    return *_in_order(cloud, key, slot, depth, starts), starts, neighbours


@compiled
def _dense_keys(cloud: Cloud, low: NDArray[np.float64], scale: float, width: int) -> tuple[IntArray, IntArray]:
    key = np.empty(len(cloud), dtype=np.int32)
    depth = np.empty(len(cloud), dtype=np.int32)
    for i in range(len(cloud)):
        x = int((cloud[i, 0] - low[0]) * scale) + PAD
        y = int((cloud[i, 1] - low[1]) * scale) + PAD
        key[i] = y * width + x
        depth[i] = int((cloud[i, 2] - low[2]) * scale)
    return key, depth


def _wide_keys(cloud: Cloud, low: NDArray[np.float64], scale: float, width: int) -> tuple[NDArray[np.int64], IntArray]:
    """The same for clouds too wide for a table of columns."""
    cells = ((cloud - low) * scale).astype(np.int64)
    return (cells[:, 1] + PAD) * width + cells[:, 0] + PAD, cells[:, 2].astype(np.int32)


@compiled
def _occupied(key: IntArray, columns: int) -> tuple[IntArray, IntArray]:
    """Number of each occupied column (-1 elsewhere) and the first point of each in column order."""
    slot = np.zeros(columns, dtype=np.int32)
    for i in range(len(key)):
        slot[key[i]] += 1
    starts = np.empty(len(key) + 1, dtype=np.int32)
    count, total = 0, 0
    for column in range(columns):
        size = slot[column]
        slot[column] = -1
        if size > 0:
            slot[column] = count
            starts[count] = total
            count += 1
            total += size
    starts[count] = total
    return slot, starts[: count + 1]


@compiled
def _dense_neighbours(slot: IntArray, count: int, offsets: NDArray[np.int64]) -> IntArray:
    neighbours = np.empty((len(offsets), count), dtype=np.int32)
    for column in range(len(slot)):
        if slot[column] >= 0:
            for j in range(len(offsets)):
                neighbours[j, slot[column]] = slot[column + offsets[j]]
    return neighbours


def _sought_neighbours(kept: NDArray[np.int64], offsets: NDArray[np.int64]) -> IntArray:
    wanted = kept + offsets[:, None]
    place = np.searchsorted(kept, wanted).clip(max=len(kept) - 1)
    return np.where(kept[place] == wanted, place, -1).astype(np.int32)


@compiled
def bounds(cloud: Cloud) -> tuple[NDArray[np.float64], NDArray[np.float64], bool]:
    """Least and greatest coordinates, (3,) each, and whether all are finite."""
    low, high = np.empty(3), np.empty(3)
    finite = True
    for axis in range(3):
        least, greatest, wrong = cloud[0, axis], cloud[0, axis], 0
        for i in range(len(cloud)):
            value = cloud[i, axis]
            least = value if value < least else least
            greatest = value if value > greatest else greatest
            wrong += not (abs(value) < np.inf)
        low[axis], high[axis] = least, greatest
        finite = finite and wrong == 0
    return low, high, finite


@compiled
def _in_order(
    cloud: Cloud, key: IntArray, slot: IntArray, depth: IntArray, starts: IntArray
) -> tuple[Cloud, IntArray, IntArray]:
    """Points sorted by column and, within a column, by z cell."""
    following = starts.copy()
    cells, places = np.empty(len(cloud), dtype=np.int32), np.empty(len(cloud), dtype=np.int32)
    for i in range(len(cloud)):
        column, cell = slot[key[i]], depth[i]
        at = following[column]
        following[column] += 1
        while at > starts[column] and cells[at - 1] > cell:
            cells[at], places[at] = cells[at - 1], places[at - 1]
            at -= 1
        cells[at], places[at] = cell, i
    points = np.empty((len(cloud), 3), dtype=np.float32)
    for at in range(len(cloud)):
        i = places[at]
        points[at, 0], points[at, 1], points[at, 2] = cloud[i, 0], cloud[i, 1], cloud[i, 2]
    return points, cells, places
