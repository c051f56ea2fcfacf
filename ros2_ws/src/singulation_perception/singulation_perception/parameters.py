"""What the segmentation may assume about table, blocks and sensor."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from singulation_core import InvalidInputError
from singulation_core.polygon import FloatArray


@dataclass(frozen=True, eq=False)
class SegmentationParameters:
    """Lengths in metres. ``None`` means: measured on the cloud itself.

    Args:
        table_from_camera: 4x4 pose of the camera in ``table``; the plane fit refines its height and tilt. None: the
            table is the cloud's largest plane and the frame comes from the fit alone: origin below the camera on the
            table, z up towards the camera, x along the camera's x axis.
        workspace: (x_min, x_max, y_min, y_max) in ``table``; points outside are ignored. None: no crop.
        tolerance: points closer than this belong together (Euclidean clustering). None: four point spacings.
        min_size: fewest points of an object.
        max_size: most points of an object; larger ones are dropped and counted.
        min_height: lowest top face above the table; raised to six times the noise of the table if that is more.
        max_height: highest top face; what reaches above (an arm) is dropped and counted.
        min_width: narrower objects are slivers, dropped and counted.
        max_extent: diameter of the bounding circle of the largest block there is; larger outlines are doubted, because
            blocks flush along a whole edge leave no trace. None: outlines are doubted that are one and a half times as
            long as is usual in the cloud.
        outline_tolerance: of Douglas-Peucker. None: four point spacings.
        edge_growth: what the sensor loses at an edge, in point spacings, added on every side of an outline.
            A constant of the sensor; calibrate it with a block of known size.
        height_step: neighbouring points that differ more lie on different faces. None: from the noise of the table.
        split_touching: cut merged blocks where the cloud shows a seam.
        max_table_offset: how far the table may be from where ``table_from_camera`` has it, at the workspace's middle.
        max_table_tilt: the same for its inclination [rad].
        min_table_share: least share of the points inside the workspace that lie on the table.
        max_points: larger clouds are refused.

    Raises:
        InvalidInputError: naming the parameter.
    """

    table_from_camera: FloatArray | None = None
    workspace: tuple[float, float, float, float] | None = None
    tolerance: float | None = None
    min_size: int = 60
    max_size: int = 2_000_000
    min_height: float = 0.004
    max_height: float = 0.10
    min_width: float = 0.006
    max_extent: float | None = None
    outline_tolerance: float | None = None
    edge_growth: float = 0.5
    height_step: float | None = None
    split_touching: bool = True
    max_table_offset: float = 0.010
    max_table_tilt: float = math.radians(2.0)
    min_table_share: float = 0.15
    max_points: int = 16_000_000

    def __post_init__(self) -> None:
        if self.table_from_camera is not None:
            object.__setattr__(self, "table_from_camera", _pose(self.table_from_camera))
        if self.workspace is not None:
            object.__setattr__(self, "workspace", _workspace(self.workspace))
        for name in ("tolerance", "max_extent", "outline_tolerance", "height_step"):
            value = getattr(self, name)
            if value is not None and not (0.0 < value < math.inf):
                raise InvalidInputError(f"{name}: {value} m, need a finite positive length or none")
        for name in ("min_height", "min_width", "max_table_offset", "max_table_tilt"):
            if not (0.0 < getattr(self, name) < math.inf):
                raise InvalidInputError(f"{name}: {getattr(self, name)}, need a finite positive number")
        if not (self.min_height < self.max_height < math.inf):
            raise InvalidInputError(f"max_height: {self.max_height} m, need more than min_height {self.min_height} m")
        if not (1 <= self.min_size <= self.max_size):
            raise InvalidInputError(f"min_size, max_size: {self.min_size}, {self.max_size}; need 1 <= min <= max")
        if not (0.0 <= self.edge_growth <= 5.0):
            raise InvalidInputError(f"edge_growth: {self.edge_growth} point spacings, need 0..5")
        if not (0.0 < self.min_table_share < 1.0):
            raise InvalidInputError(f"min_table_share: {self.min_table_share}, need more than 0 and less than 1")
        if not (self.max_points >= 1):
            raise InvalidInputError(f"max_points: {self.max_points}, need at least 1")


def _pose(value: ArrayLike) -> FloatArray:
    pose = np.array(value, dtype=np.float64)
    if pose.shape != (4, 4) or not np.isfinite(pose).all():
        raise InvalidInputError(f"table_from_camera: shape {pose.shape}, need a finite 4x4 matrix")
    rotation = pose[:3, :3]
    error = float(np.abs(rotation @ rotation.T - np.eye(3)).max())
    if not (error < 1e-3 and np.linalg.det(rotation) > 0.0 and np.array_equal(pose[3], (0.0, 0.0, 0.0, 1.0))):
        raise InvalidInputError("table_from_camera: not a rigid transform (right-handed rotation, last row 0 0 0 1)")
    pose.setflags(write=False)
    return pose


def _workspace(value: ArrayLike) -> tuple[float, float, float, float]:
    limits = np.asarray(value, dtype=np.float64)
    if limits.shape != (4,) or not np.isfinite(limits).all() or not (limits[0] < limits[1] and limits[2] < limits[3]):
        raise InvalidInputError(
            f"workspace: {value!r}, need finite x_min < x_max, y_min < y_max in the frame of the table [m]"
        )
    x_min, x_max, y_min, y_max = (float(limit) for limit in limits)
    return x_min, x_max, y_min, y_max
