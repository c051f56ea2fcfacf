"""Grid of cells for Euclidean clustering: (x, y) columns, each with a short sorted list of z cells."""

import numpy as np
from numpy.typing import NDArray

from singulation_core import InvalidInputError
from singulation_perception.jit import compiled, compiled_part, compiled_plain
from singulation_perception.union_find import find_root, numbered_roots, single_sets, unite

IntArray = NDArray[np.int32]
Cloud = NDArray[np.float32]

_EDGE = 0.99999 / np.sqrt(3.0)  # a little under 1: float32 rounding must not part the points of a cell
_PAD = 2  # cells farther apart than two hold no linked points
_DENSE = 4_000_000  # columns of a table that is looked up directly

# The half of the 5x5 neighbourhood that comes later, nearest first: near cells make the far ones needless.
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
        m columns (m + 1,), and the later neighbours of each column (m, 12), -1 where there is none.

    Raises:
        InvalidInputError: the tolerance is so small that cells cannot be numbered.
    """
    edge = _EDGE * tolerance
    counts = np.floor((high - low) / edge) + 1 + 2 * _PAD
    if not (counts.max() < 2**30):
        raise InvalidInputError(f"tolerance: {tolerance} m is too small for a cloud {(high - low).max():.3g} m wide")
    width, columns = int(counts[0]), int(counts[0] * counts[1])
    if columns <= _DENSE:
        key, depth = _dense_keys(cloud, low, 1.0 / edge, width)
        slot, starts = _occupied(key, columns)
        neighbours = _dense_neighbours(slot, len(starts) - 1, _LATER[:, 1] * width + _LATER[:, 0])
        key = slot[key]
    else:
        wide, depth = _wide_keys(cloud, low, 1.0 / edge, width)
        kept, key, sizes = np.unique(wide, return_inverse=True, return_counts=True)
        key = key.astype(np.int32)
        starts = np.concatenate(([0], np.cumsum(sizes))).astype(np.int32)
        neighbours = _sought_neighbours(kept, _LATER[:, 1] * width + _LATER[:, 0])
    return *_in_order(cloud, key, depth, starts), starts, neighbours


@compiled
def _dense_keys(cloud: Cloud, low: NDArray[np.float64], scale: float, width: int) -> tuple[IntArray, IntArray]:
    key = np.empty(len(cloud), dtype=np.int32)
    depth = np.empty(len(cloud), dtype=np.int32)
    for i in range(len(cloud)):
        x = int((cloud[i, 0] - low[0]) * scale) + _PAD
        y = int((cloud[i, 1] - low[1]) * scale) + _PAD
        key[i] = y * width + x
        depth[i] = int((cloud[i, 2] - low[2]) * scale)
    return key, depth


def _wide_keys(cloud: Cloud, low: NDArray[np.float64], scale: float, width: int) -> tuple[NDArray[np.int64], IntArray]:
    """The same for clouds too wide for a table of columns."""
    cells = ((cloud - low) * scale).astype(np.int64)
    return (cells[:, 1] + _PAD) * width + cells[:, 0] + _PAD, cells[:, 2].astype(np.int32)


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
    neighbours = np.empty((count, len(offsets)), dtype=np.int32)
    for column in range(len(slot)):
        if slot[column] >= 0:
            for j in range(len(offsets)):
                neighbours[slot[column], j] = slot[column + offsets[j]]
    return neighbours


def _sought_neighbours(kept: NDArray[np.int64], offsets: NDArray[np.int64]) -> IntArray:
    wanted = kept[:, None] + offsets
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
def _in_order(cloud: Cloud, key: IntArray, depth: IntArray, starts: IntArray) -> tuple[Cloud, IntArray, IntArray]:
    """Points sorted by column and, within a column, by z cell."""
    following = starts.copy()
    cells, places = np.empty(len(cloud), dtype=np.int32), np.empty(len(cloud), dtype=np.int32)
    for i in range(len(cloud)):
        column, cell = key[i], depth[i]
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


@compiled
def link_cells(
    points: Cloud, depth: IntArray, places: IntArray, starts: IntArray, neighbours: IntArray, squared: np.float32
) -> IntArray:
    """Component number of every point, in the order of the original cloud.

    Args:
        points, depth, places, starts, neighbours: from ``columns_of``.
        squared: square of the tolerance, exclusive [m^2].
    """
    cell, first, level, cell_of_column = _cells(depth, starts)
    parent = single_sets(len(level))
    for column in range(len(starts) - 1):
        for a in range(np.int64(cell_of_column[column]), np.int64(cell_of_column[column + 1])):
            root = find_root(parent, a)
            end = np.int64(cell_of_column[column + 1])
            root = _link_within(points, level, first, a, root, a + 1, end, parent, squared)
            for j in range(neighbours.shape[1]):
                other = neighbours[column, j]
                if other >= 0:
                    begin, end = np.int64(cell_of_column[other]), np.int64(cell_of_column[other + 1])
                    root = _link_within(points, level, first, a, root, begin, end, parent, squared)
    numbers, _ = numbered_roots(parent)
    components = np.empty(len(points), dtype=np.int32)
    for i in range(len(points)):
        components[places[i]] = numbers[cell[i]]
    return components


@compiled_part
def _cells(depth: IntArray, starts: IntArray) -> tuple[IntArray, IntArray, IntArray, IntArray]:
    """Cell of every point, first point of every cell, its place in z, first cell of every column."""
    cell, level = np.empty(len(depth), dtype=np.int32), np.empty(len(depth), dtype=np.int32)
    first = np.empty(len(depth) + 1, dtype=np.int32)
    cell_of_column = np.empty(len(starts), dtype=np.int32)
    count = 0
    for column in range(len(starts) - 1):
        cell_of_column[column] = count
        for i in range(starts[column], starts[column + 1]):
            if i == starts[column] or depth[i] != depth[i - 1]:
                first[count], level[count] = i, depth[i]
                count += 1
            cell[i] = count - 1
    cell_of_column[len(starts) - 1] = count
    first[count] = len(depth)
    return cell, first, level[:count], cell_of_column


@compiled_plain
def _link_within(
    points: Cloud,
    level: IntArray,
    first: IntArray,
    a: int,
    root: int,
    begin: int,
    end: int,
    parent: IntArray,
    squared: np.float32,
) -> int:
    """Unites cell ``a``, whose root is given, with the cells of one column that it touches; its root then."""
    for b in range(begin, end):
        apart = level[b] - level[a]
        if parent[b] == root or apart < -_PAD or apart > _PAD:
            continue
        other = find_root(parent, b)
        if other != root and _touch(points, first[a], first[a + 1], first[b], first[b + 1], squared):
            unite(parent, root, other)
            root = min(root, other)
    return root


@compiled_plain
def _touch(points: Cloud, a: int, a_end: int, b: int, b_end: int, squared: np.float32) -> bool:
    for i in range(a, a_end):
        for j in range(b, b_end):
            dx = points[i, 0] - points[j, 0]
            dy = points[i, 1] - points[j, 1]
            dz = points[i, 2] - points[j, 2]
            if dx * dx + dy * dy + dz * dz < squared:
                return True
    return False
