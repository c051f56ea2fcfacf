"""Grid of cells for Euclidean clustering: a table of (x, y) columns, each with a short chain of z cells.

Clouds come row by row, and neighbours in a row mostly share a cell. So runs of points, not points, are put into cells.
Nothing is sorted: cells are numbered as they appear. The points before a new cell and beside it lie in cells already
there, mostly near it, and are linked with it at once: a few distances connect nearly everything.

Surfaces have few cells in a column. Where a cloud fills a volume, layers cut columns into short ones.
"""

from typing import NamedTuple

import numpy as np

from singulation_core import InvalidInputError
from singulation_perception.cell_runs import PAD, Cloud, FloatArray, IntArray, Keys, near, runs_of
from singulation_perception.jit import compiled_inline, compiled_maker
from singulation_perception.union_find import find_root, unite

_EDGE = 0.99999 / np.sqrt(3.0)  # a little under 1: float32 rounding must not part the points of a cell
_PLACES = 4  # of the table for each run: with fewer, too many columns share one
_UNCUT, _CUT = 30, 1  # binary logarithm of the levels in a layer; linked cells lie at most one layer apart
_TALL, _FULL = 32, 4  # levels, and runs in the mean column, beyond which columns are cut

# A column itself and the half of the 5x5 neighbourhood that comes later, nearest first; the first and last of its rows.
_LATER = ((0, 0), (1, 0), (0, 1), (1, 1), (-1, 1), (2, 0), (0, 2), (2, 1), (1, 2), (-1, 2), (-2, 1), (2, 2), (-2, 2))
_RIM = tuple((x, y) for y in range(PAD + 1) for x in (-PAD, PAD))


class Grid(NamedTuple):
    """How columns are numbered: that of the next column in x is 1 more.

    Args:
        width: that of the next column in y is so much more.
        bits: binary logarithm of the levels in a layer.
        later: (3, 13) what to add to the number of a column for those of itself and of its later neighbours: in the
            layer below its own, in its own, and in the layer above.
        rim: (3, 6) the same for the first and last columns of the three rows in which they lie.
    """

    width: int
    bits: int
    later: Keys
    rim: Keys


class Cells(NamedTuple):
    """Points of a cloud in c cells, in the order of their first points; a named tuple, because compiled code takes it.

    Args:
        begin: (r + 1,) first point of each run of points that follow each other in one cell.
        of_run: (r,) cell of each run.
        earlier: (r,) run before each in the same cell, -1 for the first.
        last: (c,) last run of each cell.
        size: (c,) points in each cell.
        key: (c,) number of the column of each cell.
        level: (c,) place of each cell in z.
        chained: (c,) next cell in the chain of each, -1 for the last.
        table: (2^k,) first cell of a chain, which holds all columns whose numbers end in the same k bits; -1 for none.
        parent: (c,) trees of cells that are known to hang together; no parent is greater than its child.
        grid: in which they lie.
    """

    begin: IntArray
    of_run: IntArray
    earlier: IntArray
    last: IntArray
    size: IntArray
    key: Keys
    level: IntArray
    chained: IntArray
    table: IntArray
    parent: IntArray
    grid: Grid


def cells_of(cloud: Cloud, tolerance: float, squared: np.float32, low: FloatArray, high: FloatArray) -> Cells:
    """Puts points into cells that hold only points nearer to one another than the tolerance.

    Args:
        cloud: (n, 3) finite points, n > 0.
        tolerance: of the clustering [m].
        squared: its square, exclusive [m^2].
        low: (3,) least coordinates.
        high: (3,) greatest coordinates.

    Raises:
        InvalidInputError: the tolerance is so small that cells cannot be numbered.
    """
    edge = _EDGE * tolerance
    counts = np.floor((high - low) / edge) + 1 + 2 * PAD
    if not (counts.max() < 2**30):
        raise InvalidInputError(f"tolerance: {tolerance} m is too small for a cloud {(high - low).max():.3g} m wide")
    width = int(counts[0]) | 1  # odd, so that the last bits of the keys differ from row to row
    layer, levels, bits = width * int(counts[1]), int(counts[2]), _UNCUT
    begin, key, depth = runs_of(cloud, low, 1.0 / edge, width)
    if levels > _TALL and len(key) > _FULL * layer and layer * levels < 2**62:
        bits = _CUT
        key += layer * (depth.astype(np.int64) >> bits)
    places = min(layer * ((levels >> bits) + 1), _PLACES * len(key))
    table = np.full(1 << places.bit_length(), -1, dtype=np.int32)
    grid = Grid(width, bits, _offsets(_LATER, width, layer), _offsets(_RIM, width, layer))
    cells: Cells = _cells(cloud, begin, key, depth, table, grid, squared)
    return cells


def _offsets(columns: tuple[tuple[int, int], ...], width: int, layer: int) -> Keys:
    return np.array([[x + y * width + z * layer for x, y in columns] for z in (-1, 0, 1)], dtype=np.int64)


@compiled_maker
def _cells(
    cloud: Cloud, begin: IntArray, key: Keys, depth: IntArray, table: IntArray, grid: Grid, squared: np.float32
) -> Cells:
    of_run, earlier = np.empty(len(key), dtype=np.int32), np.empty(len(key), dtype=np.int32)
    last, size = np.empty(len(key), dtype=np.int32), np.empty(len(key), dtype=np.int32)
    keys, level = np.empty(len(key), dtype=np.int64), np.empty(len(key), dtype=np.int32)
    chained, parent = np.empty(len(key), dtype=np.int32), np.empty(len(key), dtype=np.int32)
    mask, count, before = len(table) - 1, np.int64(0), np.int64(-1)
    for k in range(len(key)):
        run = np.uintp(k)
        column, z, place = key[run], depth[run], np.uintp(key[run] & mask)
        cell = np.int64(table[place])
        while cell >= 0 and (level[np.uintp(cell)] != z or keys[np.uintp(cell)] != column):
            cell = np.int64(chained[np.uintp(cell)])
        if cell < 0:
            cell = count
            keys[cell], level[cell], chained[cell] = column, z, table[place]
            last[cell], size[cell], table[place] = -1, 0, cell
            _begin_tree(cloud, begin, last, parent, table, column, k, cell, before, grid.width, squared)
            count += np.int64(1)
        at = np.uintp(cell)
        of_run[run], earlier[run], last[at] = cell, last[at], run
        size[at] += begin[k + 1] - begin[k]
        before = cell
    last, size, keys, level = last[:count], size[:count], keys[:count], level[:count]
    return Cells(begin, of_run, earlier, last, size, keys, level, chained[:count], table, parent[:count], grid)


@compiled_inline
def _begin_tree(
    cloud: Cloud,
    begin: IntArray,
    last: IntArray,
    parent: IntArray,
    table: IntArray,
    column: int,
    run: int,
    cell: np.int64,
    before: np.int64,
    width: int,
    squared: np.float32,
) -> None:
    """Links a new cell with that of the point before and with some beside it, looking at one point of each.

    Args:
        column: of the new cell.
        run: with which it begins.
        before: the cell of the run before, -1 for none.
    """
    point = np.int64(begin[run])
    parent[cell] = cell
    if before >= 0 and near(cloud, point, point - 1, squared):
        parent[cell] = find_root(parent, before)
    for offset in (-width, width, -1, 1):
        beside = np.int64(table[(column + offset) & (len(table) - 1)])
        if beside < 0 or parent[beside] == parent[cell]:
            continue
        if near(cloud, point, np.int64(begin[last[beside]]), squared):
            unite(parent, cell, beside)
