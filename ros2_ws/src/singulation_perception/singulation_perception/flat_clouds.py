"""Clouds without image order: Euclidean clusters, drawn on a raster so that the rest can treat them as images."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.clustering import euclidean_clusters
from singulation_perception.jit import compiled_maker
from singulation_perception.object_points import FIRST, HIGH, LOW, START, STOP, IntArray, ObjectPoints, widen
from singulation_perception.parameters import SegmentationParameters

Points = NDArray[np.float32]

_SPACINGS_PER_CELL = 1.5  # a lattice at any angle then leaves no cell of a face empty
_TOLERANCE_IN_SPACINGS = 4.0
_MOST_CELLS = 20_000_000
_PROBE = 0.005  # [m] first cell in which points are counted
_ENOUGH = 12  # points in a cell that tell the spacing


@dataclass(frozen=True, eq=False)
class FlatCloud:
    """Object points of an unordered cloud on a raster.

    Args:
        seen: the highest point of each cell, as an image.
        cluster: (m,) cluster of each run.
        shape: of the image.
        cell: (n,) cell of each object point that is in a cluster, -1 for the others.
        place: (n,) number of each object point in the cloud.
        small: points of clusters that are too small or too large.
    """

    seen: ObjectPoints
    cluster: IntArray
    shape: tuple[int, int]
    cell: NDArray[np.int64]
    place: IntArray
    small: int

    def labels(self, image: IntArray, size: int) -> IntArray:
        """(size,) labels of the points of the cloud from those of the cells."""
        labels = np.full(size, -1, dtype=np.int32)
        kept = self.cell >= 0
        labels[self.place[kept]] = image.ravel()[self.cell[kept]]
        return labels


def flat_cloud(seen: ObjectPoints, parameters: SegmentationParameters, step: float) -> FlatCloud:
    """Clusters object points that have no neighbours in an image and gives them some.

    Args:
        seen: object points of a cloud with one row.
        parameters: tolerance and sizes of the clusters.
        step: height difference at which a run ends [m].
    """
    spacing = point_spacing(seen.xyz)
    tolerance = parameters.tolerance or _TOLERANCE_IN_SPACINGS * spacing
    clusters = euclidean_clusters(seen.xyz, tolerance, parameters.min_size, parameters.max_size)
    kept = clusters >= 0
    cell, shape = _cells(seen.xyz, kept, _SPACINGS_PER_CELL * spacing)
    xyz, runs, spans, cluster = _drawn(seen.xyz, clusters, cell, shape[0], shape[1], np.float32(step))
    place = _places(seen.runs, len(seen.xyz))
    return FlatCloud(
        ObjectPoints(xyz, runs, spans, seen.outside), cluster, shape, cell, place, int(np.count_nonzero(~kept))
    )


def point_spacing(xyz: Points) -> float:
    """Typical distance of neighbouring points, from how many share a square of the plane [m]."""
    size = _PROBE
    while len(xyz):
        columns = np.floor((xyz[:, :2] - xyz[:, :2].min(axis=0)) / size).astype(np.int64)
        counts = np.unique(columns[:, 0] * (int(columns[:, 1].max()) + 1) + columns[:, 1], return_counts=True)[1]
        usual = float(np.median(counts))
        if usual >= _ENOUGH or len(counts) == 1:
            return size / float(np.sqrt(usual))
        size *= 2.0
    return _PROBE


def _cells(xyz: Points, kept: NDArray[np.bool_], size: float) -> tuple[NDArray[np.int64], tuple[int, int]]:
    """Cell of each point that is kept, -1 for the others, and the shape of the raster."""
    cell = np.full(len(xyz), -1, dtype=np.int64)
    if not kept.any():
        return cell, (1, 1)
    plane = xyz[kept, :2].astype(np.float64)
    low, extent = plane.min(axis=0), np.ptp(plane, axis=0)
    size = max(size, float(np.sqrt(extent[0] * extent[1] / _MOST_CELLS)), float(extent.max()) / _MOST_CELLS)
    place = ((plane - low) / size).astype(np.int64)
    rows, columns = int(place[:, 1].max()) + 1, int(place[:, 0].max()) + 1
    cell[kept] = place[:, 1] * columns + place[:, 0]
    return cell, (rows, columns)


@compiled_maker
def _drawn(
    xyz: Points, clusters: IntArray, cell: NDArray[np.int64], rows: int, columns: int, step: np.float32
) -> tuple[Points, IntArray, FloatArray, IntArray]:
    """Highest point of each cell, the runs of them, their heights, and the cluster of each run."""
    best = np.full(rows * columns, -1, dtype=np.int32)
    for i in range(len(xyz)):
        if cell[i] >= 0 and (best[cell[i]] < 0 or xyz[i, 2] > xyz[best[cell[i]], 2]):
            best[cell[i]] = i
    points = np.empty((len(xyz), 3), dtype=np.float32)
    runs = np.empty((len(xyz), 4), dtype=np.int32)
    spans = np.zeros((len(xyz), 4))
    cluster = np.empty(len(xyz), dtype=np.int32)
    count, run, before = 0, -1, -1
    for at in range(rows * columns):
        i = best[at]
        if i >= 0:
            new = before < 0 or at % columns == 0 or clusters[before] != clusters[i]
            if new or abs(xyz[before, 2] - xyz[i, 2]) > step:
                run += 1
                runs[run, 0], runs[run, 1], runs[run, 3] = at // columns, at % columns, count
                spans[run, LOW], spans[run, HIGH] = xyz[i, 2], xyz[i, 2]
                cluster[run] = clusters[i]
            runs[run, 2] = at % columns + 1
            widen(spans, np.int64(run), np.float64(xyz[i, 2]))
            points[count, 0], points[count, 1], points[count, 2] = xyz[i, 0], xyz[i, 1], xyz[i, 2]
            count += 1
        before = i
    return points[:count], runs[: run + 1], spans[: run + 1], cluster[: run + 1]


@compiled_maker
def _places(runs: IntArray, count: int) -> IntArray:
    places = np.empty(count, dtype=np.int32)
    for run in range(len(runs)):
        for column in range(runs[run, START], runs[run, STOP]):
            places[runs[run, FIRST] + column - runs[run, START]] = column
    return places
