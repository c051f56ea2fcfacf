"""Table and blocks as one cloud shows them, without knowing where the camera is."""

import dataclasses
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core import CellGeometry
from singulation_core.polygon import FloatArray
from singulation_perception import SegmentationParameters, segment_cloud

_FARTHEST_OFF = 0.15  # m; a calibration farther off is not checked but made anew
_MOST_TILTED = np.radians(15.0)


@dataclass(frozen=True, eq=False)
class SeenTable:
    """What one cloud shows.

    Args:
        plane_from_camera: 4x4; z = 0 on the table, up; x and y as the fit has them, or as the given pose does.
        noise: robust standard deviation of the cloud about the plane [m].
        centres: (m, 2) of the blocks in that frame [m].
        heights: (m,) of their top faces above the table [m].
        offset: height of the plane over the one of the given pose [m], 0 without one.
        tilt: angle to it [rad], 0 without one.
    """

    plane_from_camera: FloatArray
    noise: float
    centres: FloatArray
    heights: FloatArray
    offset: float
    tilt: float


def see_table(points: NDArray[np.float32], cell: CellGeometry | None = None) -> SeenTable:
    """Fit the table and find the blocks.

    Args:
        points: (H, W, 3) or (N, 3), camera frame [m].
        cell: where the camera is believed to be; the plane is looked for near its table, inside its workspace. None:
            the largest plane of the cloud is the table.

    Raises:
        SingulationError: perception's codes: no points, no table, or, with ``cell``, a table that is far away.
    """
    found = segment_cloud(points, _parameters(cell))
    objects = found.arrangement.objects
    table = found.table
    return SeenTable(
        table.table_from_camera,
        table.noise,
        found.arrangement.centroids,
        np.array([item.height for item in objects]),
        table.offset,
        table.tilt,
    )


def _parameters(cell: CellGeometry | None) -> SegmentationParameters:
    if cell is None:
        return SegmentationParameters()
    return dataclasses.replace(
        SegmentationParameters(),
        table_from_camera=cell.table_from_camera,
        workspace=cell.workspace,
        max_table_offset=_FARTHEST_OFF,
        max_table_tilt=float(_MOST_TILTED),
    )
