"""Where table and camera stand, from touched points and clouds."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from singulation_bringup.calibration.cell_file import cell_with
from singulation_bringup.calibration.matching import match_planar
from singulation_bringup.calibration.seen_table import SeenTable
from singulation_bringup.calibration.table_frame import TouchedTable, touched_table
from singulation_bringup.calibration.touched_points import TouchedPoints
from singulation_core import CellGeometry
from singulation_core.polygon import FloatArray
from singulation_core.transforms import inverse, transform_points


@dataclass(frozen=True, eq=False)
class Calibration:
    """A calibrated cell and how well the measurements agree with it.

    Args:
        cell: the new one; its workspace is the old one's.
        table: as touched.
        block_residuals: (c, n) distance in the plane between touched and seen middle, per cloud and block [m].
        height_residuals: (c, n) touched height of each top face minus the seen one [m].
        noise: of the clouds about the table [m], the largest.
        camera_spread: largest distance of the camera's position from cloud to cloud [m].
    """

    cell: CellGeometry
    table: TouchedTable
    block_residuals: FloatArray
    height_residuals: FloatArray
    noise: float
    camera_spread: float

    @property
    def worst(self) -> float:
        """Largest residual of all [m]."""
        return float(
            max(np.abs(self.table.residuals).max(), self.block_residuals.max(), np.abs(self.height_residuals).max())
        )


def calibrate(touched: TouchedPoints, views: Sequence[SeenTable], before: CellGeometry) -> Calibration:
    """The plane of the table from the points touched on it; the camera over it from the blocks.

    Height and tilt of the camera follow from the plane in its clouds, place and turn from the blocks: touched points
    are good to about a millimetre, so the plane, which is known far better, is not bent to them.

    Args:
        touched: at least three points of the table and three blocks.
        views: of the same blocks, one for each cloud.
        before: the cell so far; the frame table keeps its origin and its x on the table, and the workspace stays.

    Raises:
        InvalidInputError: points that do not suffice, contradict each other, or fit in two ways.
    """
    table = touched_table(touched.table, before.body_from_table)
    blocks = transform_points(inverse(table.body_from_table), touched.blocks)
    matches = [match_planar(blocks[:, :2], view.centres) for view in views]
    poses = np.array(
        [_planar(match.touched_from_seen) @ view.plane_from_camera for match, view in zip(matches, views, strict=True)]
    )
    positions = poses[:, :3, 3]
    middle = int(np.linalg.norm(positions - np.median(positions, axis=0), axis=1).argmin())
    heights = [blocks[:, 2] - view.heights[list(match.seen)] for match, view in zip(matches, views, strict=True)]
    return Calibration(
        cell_with(before, table.body_from_table, poses[middle]),
        table,
        np.array([match.residuals for match in matches]),
        np.array(heights),
        max(view.noise for view in views),
        float(np.linalg.norm(positions - positions[middle], axis=1).max()),
    )


def _planar(motion: FloatArray) -> FloatArray:
    """4x4 of a 3x3 motion in the plane."""
    whole = np.eye(4)
    whole[:2, :2], whole[:2, 3] = motion[:2, :2], motion[:2, 2]
    return whole
