"""Which cells of the grid for Euclidean clustering hang together."""

import numpy as np
from numpy.typing import NDArray

from singulation_perception.grid_columns import PAD, Cells, Cloud, IntArray
from singulation_perception.jit import compiled, compiled_part, compiled_plain
from singulation_perception.union_find import find_root, single_sets, unite

_BESIDE = 4  # later neighbours that share an edge or a corner
_SEVERAL = -1  # instead of the set of a column whose cells belong to several


@compiled
def link_cells(cloud: Cloud, cells: Cells, squared: np.float32) -> tuple[IntArray, NDArray[np.int64]]:
    """Component of every run of points, in the order of their first points, and how many points each has.

    Cells side by side are linked first, one direction after another: nearly everything hangs together then. Columns
    of one component need not be compared.

    Args:
        cloud: (n, 3) points.
        cells: of the cloud.
        squared: square of the tolerance, exclusive [m^2].
    """
    parent = single_sets(len(cells.level))
    whole = np.empty(len(cells.column) - 1, dtype=np.int32)
    for reach in range(1, PAD + 1):
        for j in range(-1, _BESIDE if reach == 1 else len(cells.neighbours)):
            if reach == 1 or j <= 0:
                _flatten(parent, cells.column, whole)
            _link_columns(cloud, cells, max(j, 0), j < 0, reach, whole, parent, squared)
    return _numbered(parent, cells)


@compiled_part
def _numbered(parent: IntArray, cells: Cells) -> tuple[IntArray, NDArray[np.int64]]:
    numbers, sizes = np.full(len(parent), -1, dtype=np.int32), np.zeros(len(parent), dtype=np.int64)
    component = np.empty(len(cells.of_run), dtype=np.int32)
    count = 0
    for run in range(len(cells.of_run)):
        root = find_root(parent, np.int64(cells.of_run[run]))
        if numbers[root] < 0:
            numbers[root] = count
            count += 1
        component[run] = numbers[root]
        sizes[component[run]] += cells.begin[run + 1] - cells.begin[run]
    return component, sizes[:count]


@compiled
def labelled(begin: IntArray, component: IntArray, label: IntArray) -> IntArray:
    """(n,) label of each point from those of the components of the runs."""
    labels = np.empty(begin[-1], dtype=np.int32)
    for run in range(len(component)):
        for i in range(begin[run], begin[run + 1]):
            labels[i] = label[component[run]]
    return labels


@compiled_plain
def _flatten(parent: IntArray, column: IntArray, whole: IntArray) -> None:
    """Points every cell to its root, and notes the root of each column whose cells have one in common."""
    for k in range(len(whole)):
        for cell in range(column[k], column[k + 1]):
            parent[cell] = find_root(parent, np.int64(cell))
            whole[k] = parent[cell] if cell == column[k] or whole[k] == parent[cell] else _SEVERAL


@compiled_plain
def _link_columns(
    cloud: Cloud,
    cells: Cells,
    direction: int,
    within: bool,
    reach: int,
    whole: IntArray,
    parent: IntArray,
    squared: np.float32,
) -> None:
    """Unites the cells of each column with those of its neighbour, or of its own, at most ``reach`` levels apart."""
    for column in range(len(whole)):
        other = column if within else cells.neighbours[direction, column]
        if other < 0 or (whole[column] == whole[other] and whole[other] != _SEVERAL):
            continue
        end = cells.column[other + 1]
        for a in range(cells.column[column], cells.column[column + 1]):
            for b in range(a + 1 if within else cells.column[other], end):
                apart = cells.level[b] - cells.level[a]
                if apart > reach:
                    break
                if apart < -reach or parent[a] == parent[b]:
                    continue
                one, two = find_root(parent, np.int64(a)), find_root(parent, np.int64(b))
                if one != two and _touch(cloud, cells, a, b, squared):
                    unite(parent, one, two)


@compiled_plain
def _touch(cloud: Cloud, cells: Cells, a: int, b: int, squared: np.float32) -> bool:
    """Whether two cells have points nearer than the tolerance."""
    for at in range(cells.first[a], cells.first[a + 1]):
        one = cells.order[at]
        for facing in range(cells.first[b], cells.first[b + 1]):
            two = cells.order[facing]
            for i in range(cells.begin[one], cells.begin[one + 1]):
                for j in range(cells.begin[two], cells.begin[two + 1]):
                    dx = cloud[i, 0] - cloud[j, 0]
                    dy = cloud[i, 1] - cloud[j, 1]
                    dz = cloud[i, 2] - cloud[j, 2]
                    if dx * dx + dy * dy + dz * dz < squared:
                        return True
    return False
