"""Made-up clouds of blocks on the table of the cell, seen from straight above: what can be checked without a sensor."""

import numpy as np

from singulation_core import CellGeometry
from singulation_core.transforms import inverse, transform_points
from singulation_perception import SegmentationParameters

CELL = CellGeometry()
PARAMETERS = SegmentationParameters(table_from_camera=CELL.table_from_camera, workspace=CELL.workspace)
PITCH = 0.001  # m between neighbouring points


def turned(outline, angle):
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.asarray(outline) @ np.array(((cosine, sine), (-sine, cosine)))


def box(x, y, width, depth, angle=0.0):
    """(4, 2) outline of a rectangle with its middle at (x, y) [m]."""
    half = 0.5 * np.array(((-width, -depth), (width, -depth), (width, depth), (-width, depth)))
    return turned(half, angle) + (x, y)


def heights(*blocks, table=0.0, noise=0.0001):
    """x, y and z (H, W) of a table with upright blocks, each an outline and the height of its top [m]."""
    x, y = np.meshgrid(np.arange(-0.14, 0.14, PITCH), np.arange(-0.18, 0.18, PITCH))
    z = np.full(x.shape, float(table))
    for outline, height in blocks:
        inside = np.ones(x.shape, dtype=bool)
        for (ax, ay), (bx, by) in zip(outline, np.roll(outline, -1, axis=0), strict=True):
            inside &= (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0.0
        z[inside] = table + height
    return x, y, z + np.random.default_rng(1).normal(0.0, noise, x.shape)


def cloud(*blocks, table=0.0, tilt=0.0, noise=0.0001):
    """(H, W, 3) float32 in the camera frame; ``tilt`` turns everything about the table's x axis [rad]."""
    points = np.stack(heights(*blocks, table=table, noise=noise), axis=-1)
    cosine, sine = np.cos(tilt), np.sin(tilt)
    points = points @ np.array(((1.0, 0.0, 0.0), (0.0, cosine, sine), (0.0, -sine, cosine)))
    return transform_points(inverse(CELL.table_from_camera), points).astype(np.float32)
