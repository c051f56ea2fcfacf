"""Euclidean clustering alone: the same points for everybody, partitions compared member by member."""

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from benchmarks.perception.open3d_rival import clusters as open3d_clusters
from benchmarks.perception.pcl_rival import PclRival
from benchmarks.perception.scenes import AREA, Scene, make_scene
from benchmarks.perception.speed import RESOLUTIONS, SEED
from benchmarks.perception.tables import Table
from numpy.typing import NDArray

from singulation_core import SingulationError
from singulation_core.polygon import FloatArray
from singulation_core.transforms import transform_points
from singulation_perception import segment_cloud
from singulation_perception.cloud_files import read_cloud_file
from singulation_perception.clustering import euclidean_clusters
from singulation_perception.decoding import decode_points

TOLERANCES = (0.002, 0.003, 0.005)
_CAMERA_NOISE = 0.010  # m, tolerance that suits the noise of time-of-flight and infrared-pattern cameras
_LOWEST, _HIGHEST = 0.003, 0.10  # m above the table

_COLUMNS = ["points of", "points", "tolerance mm", "clusters", "ours ms", "PCL ms", "PCL sorted ms", "Open3D ms"]
_RATIOS = ["times ours: PCL", "PCL sorted", "Open3D", "as PCL", "as Open3D"]


def run_clusters(count: int, rounds: int, pcl: PclRival, clouds: list[Path]) -> list[Table]:
    """On synthetic scenes, and on the given cloud files."""
    notes = [
        "Processor milliseconds, median over the rounds, smallest cluster 1 point. PCL: building the search tree and "
        "extracting, with an unsorted tree (the faster setting) and with the default, sorted one. Open3D: DBSCAN. "
        "`as PCL`: every cluster has the same members."
    ]
    synthetic = Table("clusters", "Euclidean clusters", [*_COLUMNS, *_RATIOS], notes=notes)
    for name, sensor in RESOLUTIONS.items():
        for number in range(count):
            points = above_table(*_scene_points(make_scene(SEED + number, sensor)))
            named = f"{name}, scene {number}"
            synthetic.rows.extend(_row(named, points, one, rounds, pcl) for one in TOLERANCES)
    tables = [synthetic]
    if clouds:
        real = Table("clusters_real", "Euclidean clusters, recorded clouds", [*_COLUMNS, *_RATIOS], notes=notes)
        for path in clouds:
            points = recorded_points(path)
            tolerances = (*TOLERANCES, _CAMERA_NOISE)
            real.rows.extend(_row(path.stem, points, one, min(rounds, 2), pcl) for one in tolerances)
        tables.append(real)
    return tables


def _scene_points(scene: Scene) -> tuple[NDArray[np.float32], FloatArray, tuple[float, ...] | None]:
    return scene.points, scene.table_from_camera, AREA


def recorded_points(path: Path) -> NDArray[np.float32]:
    """What stands on the largest plane of a cloud file; all valid points if it shows none."""
    cloud = read_cloud_file(path)
    points = decode_points(cloud.data, cloud.layout)
    try:
        pose = segment_cloud(points).table.table_from_camera
    except SingulationError:
        flat = points.reshape(-1, 3)
        return flat[np.isfinite(flat).all(axis=1)]
    return above_table(points, pose, None)


def above_table(
    points: NDArray[np.float32], pose: FloatArray, workspace: tuple[float, ...] | None
) -> NDArray[np.float32]:
    """(N, 3) points above the table, in the camera frame."""
    flat = points.reshape(-1, 3)
    flat = flat[np.isfinite(flat).all(axis=1) & (flat != 0.0).any(axis=1)]
    x, y, z = transform_points(pose, flat.astype(np.float64)).T
    chosen = (z > _LOWEST) & (z < _HIGHEST if workspace else np.isfinite(z))
    if workspace:
        chosen &= (x >= workspace[0]) & (x <= workspace[1]) & (y >= workspace[2]) & (y <= workspace[3])
    return np.ascontiguousarray(flat[chosen])


def _row(name: str, points: NDArray[np.float32], tolerance: float, rounds: int, pcl: PclRival) -> list[object]:
    pcl.load(points)
    measured = np.array([list(_times(points, tolerance, pcl)) for _ in range(rounds)])
    ours, *theirs = np.median(measured, axis=0)
    labels = euclidean_clusters(points, tolerance)
    equal = [_same(labels, pcl.clusters(tolerance, sorted_tree=False)[2])]
    equal.append(_same(labels, open3d_clusters(points, tolerance)[2]))
    ratios = [float(one / ours) for one in theirs]
    cells = [float(one) for one in (ours, *theirs)]
    return [name, len(points), f"{1e3 * tolerance:.0f}", int(labels.max(initial=-1)) + 1, *cells, *ratios, *equal]


def _times(points: NDArray[np.float32], tolerance: float, pcl: PclRival) -> Iterator[float]:
    own = []
    for _ in range(3):
        start = time.process_time()
        euclidean_clusters(points, tolerance)
        own.append(1e3 * (time.process_time() - start))
    yield float(np.median(own))
    yield pcl.clusters(tolerance, sorted_tree=False)[0]
    yield pcl.clusters(tolerance, sorted_tree=True)[0]
    yield open3d_clusters(points, tolerance)[0]


def _same(one: NDArray[np.int32], two: NDArray[np.int32]) -> str:
    """Whether both partitions have the same members, whatever the numbers of the labels."""
    return "identical" if np.array_equal(_first_members(one), _first_members(two)) else "DIFFERENT"


def _first_members(labels: NDArray[np.int32]) -> NDArray[np.intp]:
    """For each point the first point of its cluster."""
    _, first, number = np.unique(labels, return_index=True, return_inverse=True)
    return np.asarray(first[number])
