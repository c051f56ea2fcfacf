"""Which cells of the grid for Euclidean clustering hang together."""

import numpy as np
from numpy.typing import NDArray

from singulation_perception.grid_columns import PAD, Cloud, IntArray
from singulation_perception.jit import compiled, compiled_part, compiled_plain
from singulation_perception.union_find import find_root, numbered_roots, single_sets, unite

_BESIDE = 4  # later neighbours that share an edge or a corner


@compiled
def link_cells(
    points: Cloud, depth: IntArray, starts: IntArray, neighbours: IntArray, squared: np.float32
) -> tuple[IntArray, IntArray, int]:
    """Component number of every cell.

    Cells side by side are linked first, one direction after another: nearly everything hangs together then, and
    cells of one component need not be compared.

    Args:
        points, depth, starts, neighbours: from ``columns_of``.
        squared: square of the tolerance, exclusive [m^2].

    Returns:
        number of each of the c cells (c,), first point of each (c + 1,), how many components there are.
    """
    first, level, cell_of_column = _cells(depth, starts)
    parent = single_sets(len(level))
    for reach in range(1, PAD + 1):
        for cell in range(len(parent)):
            parent[cell] = find_root(parent, np.int64(cell))  # two cells of one component are known at a glance then
        for j in range(-1, _BESIDE if reach == 1 else len(neighbours)):
            _link_columns(points, level, first, cell_of_column, neighbours[max(j, 0)], j < 0, reach, parent, squared)
    numbers, count = numbered_roots(parent)
    return numbers, first, count


@compiled
def labelled(places: IntArray, first: IntArray, label: IntArray) -> IntArray:
    """(n,) label of the cell of each point, in the order of the original cloud."""
    labels = np.empty(len(places), dtype=np.int32)
    for cell in range(len(label)):
        for i in range(first[cell], first[cell + 1]):
            labels[places[i]] = label[cell]
    return labels


@compiled_part
def _cells(depth: IntArray, starts: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """First point of every cell, its place in z, first cell of every column."""
    level, first = np.empty(len(depth), dtype=np.int32), np.empty(len(depth) + 1, dtype=np.int32)
    cell_of_column = np.empty(len(starts), dtype=np.int32)
    count = 0
    for column in range(len(starts) - 1):
        cell_of_column[column] = count
        for i in range(starts[column], starts[column + 1]):
            if i == starts[column] or depth[i] != depth[i - 1]:
                first[count], level[count] = i, depth[i]
                count += 1
    cell_of_column[len(starts) - 1] = count
    first[count] = len(depth)
    return first[: count + 1], level[:count], cell_of_column


@compiled_plain
def _link_columns(
    points: Cloud,
    level: IntArray,
    first: IntArray,
    cell_of_column: IntArray,
    neighbour: NDArray[np.int32],
    within: bool,
    reach: int,
    parent: IntArray,
    squared: np.float32,
) -> None:
    """Unites the cells of each column with those of its neighbour, or of its own, at most ``reach`` levels apart."""
    for column in range(len(neighbour)):
        other = column if within else neighbour[column]
        if other < 0:
            continue
        end = cell_of_column[other + 1]
        for a in range(cell_of_column[column], cell_of_column[column + 1]):
            for b in range(a + 1 if within else cell_of_column[other], end):
                apart = level[b] - level[a]
                if apart > reach:
                    break
                if apart < -reach or parent[a] == parent[b]:
                    continue
                one, two = find_root(parent, np.int64(a)), find_root(parent, np.int64(b))
                if one != two and _touch(points, first[a], first[a + 1], first[b], first[b + 1], squared):
                    unite(parent, one, two)


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
