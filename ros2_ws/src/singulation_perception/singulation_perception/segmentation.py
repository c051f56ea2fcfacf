"""From one point cloud to the blocks on the table."""

import time
from dataclasses import dataclass, field

import cv2
import numpy as np
from numpy.typing import NDArray
from singulation_core import Arrangement, InvalidInputError, PlanarObject, ResultCode, SingulationError
from singulation_core.polygon import FloatArray

from singulation_perception.clustering import euclidean_clusters
from singulation_perception.outlines import outline_of
from singulation_perception.parameters import SegmentationParameters
from singulation_perception.table_plane import TablePlane, find_table

_DEFAULT = SegmentationParameters()


@dataclass(frozen=True, eq=False)
class Segmentation:
    """Everything seen in one cloud.

    Args:
        arrangement: the objects, in ``table``.
        labels: (N,) or (H, W) int32, id of the object a point belongs to, -1 for none.
        table: the fitted plane.
        dropped: what was left out, by reason.
        milliseconds: wall time by stage.
    """

    arrangement: Arrangement
    labels: NDArray[np.int32]
    table: TablePlane
    dropped: dict[str, int] = field(default_factory=dict)
    milliseconds: dict[str, float] = field(default_factory=dict)


def segment(points: NDArray[np.float32], parameters: SegmentationParameters = _DEFAULT) -> Arrangement:
    """Polygons of the blocks in a cloud.

    Args:
        points: (N, 3) or (H, W, 3) [m], camera frame; invalid points are NaN, infinite or (0, 0, 0).
        parameters: of table, workspace and blocks.

    Returns:
        The arrangement in ``table``; empty if the table is bare.

    Raises:
        SingulationError: NO_POINTS, NOT_METRES, NO_TABLE, WRONG_TABLE, CLOUD_TOO_LARGE.
        InvalidInputError: wrong shape.
    """
    return segment_cloud(points, parameters).arrangement


def segment_cloud(
    points: NDArray[np.float32],
    parameters: SegmentationParameters = _DEFAULT,
    previous_plane: TablePlane | None = None,
) -> Segmentation:
    """As ``segment``, with labels, plane, what was dropped and the time of each stage.

    Args:
        points: as for ``segment``.
        parameters: as for ``segment``.
        previous_plane: table of the last cloud from the same camera.
    """
    _require_cloud(points, parameters)
    started = time.perf_counter()
    table = find_table(points, parameters, previous_plane)
    planned = time.perf_counter()
    located = _located(points, table)
    labels, outlines, dropped = _objects(located, table, parameters)
    done = time.perf_counter()
    arrangement = Arrangement(outlines)
    times = {"table": 1e3 * (planned - started), "objects": 1e3 * (done - planned)}
    return Segmentation(arrangement, labels.reshape(points.shape[:-1]), table, dropped, times)


def warm_up() -> None:
    """Compiles everything, so that the first cloud is as fast as the second."""
    euclidean_clusters(np.zeros((1, 3), dtype=np.float32), 1.0)


def _require_cloud(points: NDArray[np.float32], parameters: SegmentationParameters) -> None:
    if points.ndim not in (2, 3) or points.shape[-1] != 3:
        raise InvalidInputError(f"points: shape {points.shape}, need (N, 3) or (H, W, 3)")
    count = points.size // 3
    if count == 0:
        raise SingulationError(ResultCode.NO_POINTS, f"points: shape {points.shape}, the cloud is empty")
    if count > parameters.max_points:
        raise SingulationError(
            ResultCode.CLOUD_TOO_LARGE, f"{count} points, at most {parameters.max_points} are taken (max_points)"
        )


def _located(points: NDArray[np.float32], table: TablePlane) -> NDArray[np.float32]:
    """(N, 3) in ``table``, invalid points NaN."""
    flat = points.reshape(-1, 3).astype(np.float32)
    pose = table.table_from_camera.astype(np.float32)
    with np.errstate(invalid="ignore"):
        located = flat @ pose[:3, :3].T + pose[:3, 3]
    located[~np.isfinite(flat).all(axis=1) | (flat == 0.0).all(axis=1)] = np.nan
    return np.asarray(located)


def _objects(
    located: NDArray[np.float32], table: TablePlane, parameters: SegmentationParameters
) -> tuple[NDArray[np.int32], list[PlanarObject], dict[str, int]]:
    low = max(parameters.min_height, 6.0 * table.noise)
    wanted = (located[:, 2] > low) & (located[:, 2] < parameters.max_height)
    if parameters.workspace is not None:
        x_min, x_max, y_min, y_max = parameters.workspace
        x, y = located[:, 0], located[:, 1]
        wanted &= (x >= x_min) & (x <= x_max) & (y >= y_min) & (y <= y_max)
    places = np.flatnonzero(wanted)
    cloud = located[places]
    pitch = _pitch(cloud)
    clusters = euclidean_clusters(cloud, parameters.tolerance or 4.0 * pitch, parameters.min_size, parameters.max_size)
    labels = np.full(len(located), -1, dtype=np.int32)
    objects: list[PlanarObject] = []
    dropped = {"small": int((clusters < 0).sum()), "sliver": 0}
    for cluster in range(clusters.max(initial=-1) + 1):
        members = np.flatnonzero(clusters == cluster)
        item = _object(len(objects), cloud[members], table, pitch, parameters)
        if item is None:
            dropped["sliver"] += 1
            continue
        labels[places[members]] = item.id
        objects.append(item)
    return labels, objects, dropped


def _pitch(cloud: NDArray[np.float32]) -> float:
    """Typical distance of neighbouring points, from the area that the points cover on a 5 mm raster [m]."""
    if not len(cloud):
        return 0.001
    cells = np.unique(np.floor(cloud[:, :2] / 0.005).astype(np.int64), axis=0, return_counts=True)[1]
    return float(np.sqrt(0.005**2 / max(1.0, float(np.median(cells)))))


def _object(
    number: int, cloud: NDArray[np.float32], table: TablePlane, pitch: float, parameters: SegmentationParameters
) -> PlanarObject | None:
    """The block whose points these are, from its top face."""
    height = _top(cloud[:, 2], max(4.0 * table.noise, 0.001))
    face = cloud[np.abs(cloud[:, 2] - height) < max(4.0 * table.noise, 0.001)]
    outline = outline_of(
        _rim(face[:, :2].astype(np.float64), pitch),
        parameters.outline_tolerance or 4.0 * pitch,
        parameters.edge_growth * pitch,
    )
    if outline is None or len(outline) < 3:
        return None
    if cv2.minAreaRect(outline.astype(np.float32))[1][0] < parameters.min_width:
        return None
    return PlanarObject(number, outline, max(height, 0.0), len(cloud))


def _top(heights: NDArray[np.float32], width: float) -> float:
    """Height of the highest level that holds many points [m]."""
    low = float(heights.min())
    counts = np.bincount(((heights - low) / width).astype(np.int64))
    level = np.flatnonzero(counts > 0.5 * counts.max())[-1]
    near = heights[np.abs(heights - (low + (level + 0.5) * width)) < width]
    return float(np.median(near))


def _rim(face: FloatArray, pitch: float) -> FloatArray:
    """Outermost points of a face in every direction of a raster: both ends of every row and column."""
    rims = []
    for axis in (0, 1):
        row = np.floor(face[:, axis] / pitch).astype(np.int64)
        order = np.lexsort((face[:, 1 - axis], row))
        change = np.flatnonzero(np.diff(row[order])) + 1
        rims += [order[np.concatenate(([0], change))], order[np.concatenate((change - 1, [len(order) - 1]))]]
    return np.asarray(face[np.unique(np.concatenate(rims))])
