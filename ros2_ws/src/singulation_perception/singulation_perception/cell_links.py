"""Which cells of the grid for Euclidean clustering hang together."""

import numpy as np
from numpy.typing import NDArray

from singulation_perception.cell_runs import PAD, Cloud, IntArray, Keys, near
from singulation_perception.grid_columns import Cells
from singulation_perception.jit import compiled_inline, compiled_maker, compiled_part, compiled_part_maker
from singulation_perception.union_find import find_root, unite

_NOTHING, _SEVERAL = -1, -2  # instead of the component of a patch
_PATCH = 2  # binary logarithm of the columns in a patch, side by side in x; two patches hold any 2 * PAD + 1 columns
_LABELS = 8  # that are written at once; most runs are shorter


@compiled_maker
def link_cells(cloud: Cloud, cells: Cells, squared: np.float32) -> tuple[IntArray, NDArray[np.int64]]:
    """Component of every cell, in the order of their first points, and how many points each has.

    Nearly all cells of a component hang together from the start. Those with nothing else around them are left alone.

    Args:
        cloud: (n, 3) points.
        cells: of the cloud.
        squared: square of the tolerance, exclusive [m^2].
    """
    patches = _patches(cells.parent, cells.key, len(cells.table) >> _PATCH)
    _link(cloud, cells, patches, squared)
    return _numbered(cells.parent, cells.size)


@compiled_part_maker
def _patches(parent: IntArray, key: Keys, places: int) -> IntArray:
    """Root of the cells in each patch of columns; points every cell to its root."""
    patches = np.full(places, _NOTHING, dtype=np.int32)
    for k in range(len(parent)):
        cell, place = np.uintp(k), np.uintp((key[np.uintp(k)] >> _PATCH) & (places - 1))
        parent[cell] = parent[np.uintp(parent[cell])]  # which comes earlier, and so points to its root already
        root, found = parent[cell], patches[place]
        patches[place] = root if (found == _NOTHING) | (found == root) else _SEVERAL
    return patches


@compiled_part
def _link(cloud: Cloud, cells: Cells, patches: IntArray, squared: np.float32) -> None:
    """Unites the cells that touch one of their column or of the later neighbours."""
    parent, key, level, table, chained = cells.parent, cells.key, cells.level, cells.table, cells.chained
    bits, later, rim = cells.grid.bits, cells.grid.later, cells.grid.rim
    for a in range(len(parent)):
        own = level[a] >> bits
        layers = ((level[a] - PAD) >> bits) - own + 1, ((level[a] + PAD) >> bits) - own + 2
        if _alone(patches, key[a], rim, layers, parent[a]):
            continue
        for layer in range(layers[0], layers[1]):
            for k in range(later.shape[1]):
                b = np.int64(table[np.uintp((key[a] + later[layer, k]) & (len(table) - 1))])
                while b >= 0:
                    if abs(level[b] - level[a]) <= PAD and parent[a] != parent[b]:
                        one, two = find_root(parent, np.int64(a)), find_root(parent, b)
                        if one != two and _touch(cloud, cells, a, b, squared):
                            unite(parent, one, two)
                    b = np.int64(chained[np.uintp(b)])


@compiled_inline
def _alone(patches: IntArray, key: int, rim: Keys, layers: tuple[int, int], root: int) -> bool:
    """Whether a column and its later neighbours have cells of one component only, in these layers."""
    for layer in range(layers[0], layers[1]):
        for k in range(rim.shape[1]):
            found = patches[np.uintp(((key + rim[layer, k]) >> _PATCH) & (len(patches) - 1))]
            if (found != root) & (found != _NOTHING):
                return False
    return True


@compiled_inline
def _touch(cloud: Cloud, cells: Cells, a: int, b: np.int64, squared: np.float32) -> bool:
    """Whether two cells have points nearer than the tolerance."""
    begin, earlier = cells.begin, cells.earlier
    one = np.int64(cells.last[a])
    while one >= 0:
        two = np.int64(cells.last[b])
        while two >= 0:
            for i in range(begin[one], begin[one + 1]):
                for j in range(begin[two], begin[two + 1]):
                    if near(cloud, i, j, squared):
                        return True
            two = np.int64(earlier[two])
        one = np.int64(earlier[one])
    return False


@compiled_part_maker
def _numbered(parent: IntArray, size: IntArray) -> tuple[IntArray, NDArray[np.int64]]:
    component, sizes = np.empty(len(parent), dtype=np.int32), np.zeros(len(parent), dtype=np.int64)
    count = 0
    for cell in range(len(parent)):
        if parent[cell] == cell:
            component[cell] = count
            count += 1
        else:  # the parent comes earlier
            component[cell] = component[parent[cell]]
        sizes[component[cell]] += size[cell]
    return component, sizes[:count]


@compiled_maker
def labelled(begin: IntArray, of_run: IntArray, component: IntArray, label: IntArray) -> IntArray:
    """(n,) label of each point from those of the components of the cells."""
    labels = np.empty(begin[-1] + _LABELS, dtype=np.int32)
    for run in range(len(of_run)):
        at, end, here = np.uintp(begin[run]), np.uintp(begin[run + 1]), label[component[of_run[run]]]
        while at < end:  # the next run writes over what is too much
            for k in range(_LABELS):
                labels[at + np.uintp(k)] = here
            at += np.uintp(_LABELS)
    return labels[: begin[-1]]
