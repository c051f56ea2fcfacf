"""Euclidean clustering alone: the same points for everybody, partitions compared member by member."""

import time
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
from singulation_node.large_messages import keep_memory
from singulation_perception import segment_cloud
from singulation_perception.cloud_files import read_cloud_file
from singulation_perception.clustering import euclidean_clusters
from singulation_perception.decoding import decode_points

TOLERANCES = (0.002, 0.003, 0.005)
_CAMERA_NOISE = 0.010  # m, tolerance that suits the noise of time-of-flight and infrared-pattern cameras
_OWN = 5  # runs of ours in each round
_LOWEST, _HIGHEST = 0.003, 0.10  # m above the table

_COLUMNS = ["points of", "points", "tolerance mm", "clusters", "ours ms", "PCL ms", "PCL sorted ms", "Open3D ms"]
_RATIOS = ["times ours: PCL", "PCL sorted", "Open3D", "as PCL", "as Open3D"]


def run_clusters(count: int, rounds: int, pcl: PclRival, clouds: list[Path], resolutions: list[str]) -> list[Table]:
    """On synthetic scenes, and on the given cloud files."""
    keep_memory()  # as every node of the suite does
    notes = [
        "Processor milliseconds, median over the rounds, smallest cluster 1 point. PCL: building the search tree and "
        "extracting, with an unsorted tree (the faster setting) and with the default, sorted one. Open3D: DBSCAN. "
        "`as PCL`: every cluster has the same members."
    ]
    synthetic = Table("clusters", "Euclidean clusters", [*_COLUMNS, *_RATIOS], notes=notes)
    for name in resolutions:
        for number in range(count):
            points = above_table(*_scene_points(make_scene(SEED + number, RESOLUTIONS[name])))
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
    turns = [_turn(points, tolerance, pcl) for _ in range(rounds)]
    ours, *theirs = (float(one) for one in np.median([times for times, _ in turns], axis=0))
    labels, *others = turns[-1][1]
    ratios = [one / ours for one in theirs]
    count = int(labels.max(initial=-1)) + 1
    equal = [_same(labels, other) for other in others]
    return [name, len(points), f"{1e3 * tolerance:.0f}", count, ours, *theirs, *ratios, *equal]


def _turn(
    points: NDArray[np.float32], tolerance: float, pcl: PclRival
) -> tuple[list[float], tuple[NDArray[np.int32], ...]]:
    """Processor milliseconds of ours, PCL, PCL with a sorted tree, Open3D; labels of ours, PCL and Open3D."""
    own = []
    for _ in range(_OWN):
        start = time.process_time()
        labels = euclidean_clusters(points, tolerance)
        own.append(1e3 * (time.process_time() - start))
    plain, _, pcl_labels = pcl.clusters(tolerance, sorted_tree=False)
    ordered, _, _ = pcl.clusters(tolerance, sorted_tree=True)
    open3d, _, open3d_labels = open3d_clusters(points, tolerance)
    return [float(np.median(own)), plain, ordered, open3d], (labels, pcl_labels, open3d_labels)


def _same(one: NDArray[np.int32], two: NDArray[np.int32]) -> str:
    """Whether both partitions have the same members, whatever the numbers of the labels."""
    return "identical" if np.array_equal(_first_members(one), _first_members(two)) else "DIFFERENT"


def _first_members(labels: NDArray[np.int32]) -> NDArray[np.intp]:
    """For each point the first point of its cluster."""
    _, first, number = np.unique(labels, return_index=True, return_inverse=True)
    return np.asarray(first[number])
