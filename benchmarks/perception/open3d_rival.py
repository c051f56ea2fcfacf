"""Open3D as a rival: crop, thin out, table plane, DBSCAN. It has no polygons of clusters, so it stops before them."""

import time

import numpy as np
import open3d
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_core.transforms import transform_points

_PLANE_DISTANCE, _PLANE_ITERATIONS = 0.003, 100
_BELOW, _ABOVE = -0.02, 0.10  # m about the table, as in the PCL program


class Open3dRival:
    """Keeps one cloud, as a program would that got it from a driver of Open3D's own."""

    def __init__(self) -> None:
        self._cloud = open3d.geometry.PointCloud()
        self._box = open3d.geometry.OrientedBoundingBox()

    def load(self, points: NDArray[np.float32], workspace: tuple[float, ...], pose: FloatArray) -> None:
        """Take (..., 3) points [m]; the conversion is not part of the measurement."""
        flat = points.reshape(-1, 3)
        self._cloud.points = open3d.utility.Vector3dVector(flat[np.isfinite(flat[:, 2])].astype(np.float64))
        x_min, x_max, y_min, y_max = workspace
        middle = np.array(((x_min + x_max) / 2, (y_min + y_max) / 2, (_BELOW + _ABOVE) / 2))
        inverse = np.linalg.inv(pose)
        extent = np.array((x_max - x_min, y_max - y_min, _ABOVE - _BELOW))
        centre = transform_points(inverse, middle[None])[0]
        self._box = open3d.geometry.OrientedBoundingBox(centre, inverse[:3, :3], extent)

    def pipeline(self, leaf: float, tolerance: float, min_size: int) -> tuple[float, float, int]:
        """Processor milliseconds of all threads, wall milliseconds, number of clusters."""
        processor, wall = time.process_time(), time.perf_counter()
        cloud = self._cloud.crop(self._box)
        if leaf > 0.0:
            cloud = cloud.voxel_down_sample(leaf)
        _, table = cloud.segment_plane(_PLANE_DISTANCE, 3, _PLANE_ITERATIONS)
        above = cloud.select_by_index(table, invert=True)
        labels = np.asarray(above.cluster_dbscan(tolerance, 1))
        found = int((np.bincount(labels[labels >= 0]) >= min_size).sum())
        return 1e3 * (time.process_time() - processor), 1e3 * (time.perf_counter() - wall), found


def clusters(points: NDArray[np.float32], tolerance: float) -> tuple[float, float, NDArray[np.int32]]:
    """DBSCAN with one point as the smallest core: processor and wall milliseconds, labels (N,)."""
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points.astype(np.float64)))
    processor, wall = time.process_time(), time.perf_counter()
    labels = np.asarray(cloud.cluster_dbscan(tolerance, 1), dtype=np.int32)
    return 1e3 * (time.process_time() - processor), 1e3 * (time.perf_counter() - wall), labels
