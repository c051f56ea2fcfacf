"""Whether a cell file is still true: clouds and touched points against its poses."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from singulation_bringup.calibration.seen_table import SeenTable
from singulation_bringup.calibration.touched_points import TouchedPoints
from singulation_core import CellGeometry
from singulation_core.polygon import FloatArray
from singulation_core.transforms import inverse, transform_points


@dataclass(frozen=True, eq=False)
class CheckReport:
    """Differences between a cell file and what was measured.

    Args:
        offsets: (c,) height of the seen table over the one of the file, at the middle of the workspace [m].
        tilts: (c,) angle between them [rad].
        noise: of the clouds about the table [m].
        table_residuals: (k,) height of the touched points over the table of the file [m].
        block_residuals: (n, 2) seen middle minus touched middle of each block, in ``table`` [m].
        height_residuals: (n,) touched height of each top face minus the seen one [m].
    """

    offsets: FloatArray
    tilts: FloatArray
    noise: float
    table_residuals: FloatArray
    block_residuals: FloatArray
    height_residuals: FloatArray

    @property
    def worst(self) -> float:
        """Largest length of all [m]."""
        lengths = (
            self.offsets,
            self.table_residuals,
            np.linalg.norm(self.block_residuals, axis=1),
            self.height_residuals,
        )
        return float(max(np.abs(one).max() for one in lengths if len(one)))


def check(touched: TouchedPoints, views: Sequence[SeenTable], cell: CellGeometry) -> CheckReport:
    """Compare; blocks are matched to the nearest one seen in the last cloud.

    Args:
        touched: points of the table and blocks; either may be empty.
        views: at least one, seen with ``cell``.
        cell: to be checked.
    """
    table_from_body = inverse(cell.body_from_table)
    surface = transform_points(table_from_body, touched.table)[:, 2]
    blocks = transform_points(table_from_body, touched.blocks)
    view = views[-1]
    if len(blocks) and not len(view.centres):
        shifts, heights = np.full((len(blocks), 2), np.inf), np.full(len(blocks), np.inf)
    else:
        nearest = [int(np.linalg.norm(view.centres - block[:2], axis=1).argmin()) for block in blocks]
        shifts = (view.centres[nearest] - blocks[:, :2]) if nearest else np.empty((0, 2))
        heights = (blocks[:, 2] - view.heights[nearest]) if nearest else np.empty(0)
    return CheckReport(
        np.array([one.offset for one in views]),
        np.array([one.tilt for one in views]),
        max(one.noise for one in views),
        surface,
        shifts,
        heights,
    )
