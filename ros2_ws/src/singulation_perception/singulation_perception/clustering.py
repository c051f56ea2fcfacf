"""Euclidean clustering: the partition of PCL's EuclideanClusterExtraction, found on a grid.

Points closer than the tolerance are linked; a cluster is what links connect. Cells of edge tolerance / sqrt(3) hold
only points that are linked with one another, so cells, not points, are united, and two cells are compared only as long
as they are not yet connected. Distances are float32 sums, exclusive of the tolerance, as in PCL's search tree, so that
ties fall alike.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from singulation_core import InvalidInputError
from singulation_perception.cell_links import labelled, link_cells
from singulation_perception.cell_runs import bounds
from singulation_perception.grid_columns import cells_of

IntArray = NDArray[np.int32]

_ALL = 2_147_483_647


def euclidean_clusters(points: ArrayLike, tolerance: float, min_size: int = 1, max_size: int = _ALL) -> IntArray:
    """Labels of the clusters of an unordered cloud.

    Args:
        points: (N, 3) [m]; rows that are not finite belong to no cluster.
        tolerance: largest distance of linked points, exclusive [m].
        min_size: smaller clusters are labelled -1.
        max_size: larger clusters are labelled -1.

    Returns:
        (N,) int32: 0, 1, ... in the order of decreasing size (equal sizes: of the first point), -1 for none.

    Raises:
        InvalidInputError: wrong shape, or a tolerance or size that makes no sense.
    """
    cloud = np.ascontiguousarray(points, dtype=np.float32)
    if cloud.ndim != 2 or cloud.shape[1] != 3:
        raise InvalidInputError(f"points: shape {cloud.shape}, need (N, 3)")
    if not (0.0 < tolerance < float("inf")):
        raise InvalidInputError(f"tolerance: {tolerance} m, need a finite positive length")
    if not (1 <= min_size <= max_size):
        raise InvalidInputError(f"min_size, max_size: {min_size}, {max_size}; need 1 <= min <= max")
    if not len(cloud):
        return np.empty(0, dtype=np.int32)
    low, high, finite = bounds(cloud)
    if finite:
        return _clusters(cloud, tolerance, low, high, (min_size, max_size))
    kept = np.isfinite(cloud).all(axis=1)
    labels = np.full(len(cloud), -1, dtype=np.int32)
    if kept.any():
        cloud = cloud[kept]
        low, high, _ = bounds(cloud)
        labels[kept] = _clusters(cloud, tolerance, low, high, (min_size, max_size))
    return labels


def _clusters(
    cloud: NDArray[np.float32],
    tolerance: float,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    sizes: tuple[int, int],
) -> IntArray:
    """Labels of finite points between ``low`` and ``high``."""
    squared = np.float32(tolerance * tolerance)
    cells = cells_of(cloud, tolerance, squared, low, high)
    component, count = link_cells(cloud, cells, squared)
    return np.asarray(labelled(cells.begin, cells.of_run, component, _ranks(count, *sizes)))


def _ranks(points: NDArray[np.int64], min_size: int, max_size: int) -> IntArray:
    """Numbers of components by decreasing size; -1 for those of a wrong size."""
    order = np.argsort(-points, kind="stable")
    order = order[(points[order] >= min_size) & (points[order] <= max_size)]
    numbers = np.full(len(points), -1, dtype=np.int32)
    numbers[order] = np.arange(len(order), dtype=np.int32)
    return numbers
