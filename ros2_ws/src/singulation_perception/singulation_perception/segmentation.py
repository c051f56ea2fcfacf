"""From one point cloud to the blocks on the table."""

import time
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from singulation_core import Arrangement, InvalidInputError, ResultCode, SingulationError
from singulation_perception.block_search import Blocks, blocks_of
from singulation_perception.coarse_look import rows_between
from singulation_perception.flat_clouds import FlatCloud, flat_cloud
from singulation_perception.hidden import View
from singulation_perception.object_points import ObjectPoints
from singulation_perception.parameters import SegmentationParameters
from singulation_perception.point_collection import object_points
from singulation_perception.point_labels import labels_in_image
from singulation_perception.raster import raster_of
from singulation_perception.surfaces import surfaces_of
from singulation_perception.table_plane import TablePlane, find_table

_DEFAULT = SegmentationParameters()
_LOWEST_IN_NOISE = 6.0
_STEP_IN_NOISE, _LEAST_STEP = 7.0, 0.0015  # neighbours differ by 1.4 times the noise


@dataclass(frozen=True, eq=False)
class Segmentation:
    """Everything seen in one cloud.

    Args:
        arrangement: the objects, in ``table``.
        table: the fitted plane.
        dropped: how much was left out, by reason: ``outside`` (points above the table but outside the workspace),
            ``small`` (points of surfaces too small for a block), ``large`` (faces with too many points), ``tall``
            (surfaces that reach above ``max_height``), ``sliver`` (faces too narrow for a block), ``shapeless``
            (faces whose rim gives no polygon), ``stacked`` (faces on top of another block).
        milliseconds: wall time by stage.
    """

    arrangement: Arrangement
    table: TablePlane
    dropped: dict[str, int]
    milliseconds: dict[str, float]
    _seen: "_Seen" = field(repr=False)

    @cached_property
    def labels(self) -> NDArray[np.int32]:
        """(N,) or (H, W) id of the object that each point belongs to, -1 for none; painted when first asked for."""
        return self._seen.labels()


@dataclass(frozen=True, eq=False)
class _Seen:
    """What labels are painted from."""

    shape: tuple[int, ...]
    points: ObjectPoints
    blocks: Blocks
    flat: FlatCloud | None

    def labels(self) -> NDArray[np.int32]:
        if self.flat is None:
            return labels_in_image(self.shape, self.points, self.blocks)
        return self.flat.labels(labels_in_image(self.flat.shape, self.points, self.blocks), self.shape[0])


def segment(points: NDArray[np.float32], parameters: SegmentationParameters = _DEFAULT) -> Arrangement:
    """Polygons of the blocks in a cloud.

    Args:
        points: (N, 3) or (H, W, 3) [m], camera frame; invalid points are NaN, infinite or (0, 0, 0). Clouds in image
            order (H, W) are faster and keep narrower gaps apart.
        parameters: of table, workspace and blocks.

    Returns:
        The arrangement in ``table``; empty if the table is bare.

    Raises:
        SingulationError: NO_POINTS, NOT_METRES, NO_TABLE, WRONG_TABLE, CLOUD_TOO_LARGE.
        InvalidInputError: wrong shape or type.
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
    clock = _Clock()
    image = _image(points, parameters)
    cloud = raster_of(image)
    table = find_table(cloud, parameters, previous_plane)
    clock.lap("table")
    step = parameters.height_step or max(_STEP_IN_NOISE * table.noise, _LEAST_STEP)
    lowest = max(parameters.min_height, _LOWEST_IN_NOISE * table.noise)
    stride = rows_between(cloud, table.pitch, parameters.min_width)
    seen = object_points(cloud, table.table_from_camera, parameters.workspace, table.columns, lowest, step, stride)
    clock.lap("points")
    flat = None
    if image.shape[0] == 1:
        flat = flat_cloud(seen, parameters, step)
        seen = flat.seen
        clock.lap("clusters")
    surfaces = surfaces_of(seen, step, None if flat is None else flat.cluster)
    clock.lap("surfaces")
    view = View(
        np.ascontiguousarray(table.table_from_camera[:3, 3]), table.camera_plane, cloud if flat is None else None
    )
    blocks = blocks_of(seen, surfaces, parameters, table.noise, view)
    clock.lap("outlines")
    dropped = {"outside": seen.outside, **blocks.dropped}
    if flat is not None:
        dropped["small"] += flat.small
    shape = points.shape[:-1]
    return Segmentation(Arrangement(blocks.objects), table, dropped, clock.laps, _Seen(shape, seen, blocks, flat))


class _Clock:
    """Wall time of consecutive stages [ms]."""

    def __init__(self) -> None:
        self.laps: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        now = time.perf_counter()
        self.laps[name] = 1e3 * (now - self._last)
        self._last = now


def _image(points: NDArray[np.float32], parameters: SegmentationParameters) -> NDArray[np.float32]:
    """The cloud as (H, W, 3) float32; H = 1 if it has no image order.

    Raises:
        InvalidInputError: not points.
        SingulationError: NO_POINTS if there are none at all, CLOUD_TOO_LARGE.
    """
    if not isinstance(points, np.ndarray) or points.ndim not in (2, 3) or points.shape[-1] != 3:
        raise InvalidInputError(f"points: shape {np.shape(points)}, need an array (N, 3) or (H, W, 3)")
    if points.dtype.kind != "f":
        raise InvalidInputError(f"points: type {points.dtype}, need float32 (or float64) metres")
    count = points.size // 3
    if count == 0:
        raise SingulationError(ResultCode.NO_POINTS, f"points: shape {points.shape}, the cloud is empty")
    if count > parameters.max_points:
        raise SingulationError(
            ResultCode.CLOUD_TOO_LARGE, f"{count} points, at most {parameters.max_points} are taken (max_points)"
        )
    native = points if points.dtype == np.float32 and points.flags.aligned else points.astype(np.float32)
    if native.ndim == 3 and min(native.shape[:2]) > 1:
        return native
    return native.reshape(1, -1, 3)
