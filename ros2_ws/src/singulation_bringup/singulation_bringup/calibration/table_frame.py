"""The frame ``table`` from points touched on its surface."""

from dataclasses import dataclass

import numpy as np

from singulation_core import InvalidInputError
from singulation_core.polygon import FloatArray

_LEAST_SPREAD = 0.03  # m; standard deviation of the touched points across, or the tilt is a guess
_STEEPEST = np.radians(10.0)


@dataclass(frozen=True, eq=False)
class TouchedTable:
    """The table as touched.

    Args:
        body_from_table: 4x4; z = 0 on the plane, x and y as before.
        residuals: (k,) height of each touched point above the plane [m].
        tilt: against the frame before [rad].
        lift: of the plane against the frame before, at its origin [m].
    """

    body_from_table: FloatArray
    residuals: FloatArray
    tilt: float
    lift: float


def touched_table(points: FloatArray, before: FloatArray) -> TouchedTable:
    """Least-squares plane through the points; the frame before is turned and lifted onto it as little as possible.

    Args:
        points: (k >= 3, 3) in ``yumi_body`` [m].
        before: 4x4 ``body_from_table`` so far; origin and direction of x are kept.

    Raises:
        InvalidInputError: too few points, too close together, or on a slope that is no table.
    """
    if len(points) < 3:
        raise InvalidInputError(f"table: {len(points)} points touched, need at least 3, better 5")
    middle = points.mean(axis=0)
    _, spreads, axes = np.linalg.svd(points - middle, full_matrices=False)
    across = float(spreads[1]) / np.sqrt(len(points))
    if not (across >= _LEAST_SPREAD):
        raise InvalidInputError(
            f"table: the points spread {1e3 * across:.0f} mm across, need {1e3 * _LEAST_SPREAD:.0f} mm; "
            "touch the table in its corners, not along a line"
        )
    normal = axes[2] if axes[2] @ before[:3, 2] > 0.0 else -axes[2]
    tilt = float(np.arccos(np.clip(normal @ before[:3, 2], -1.0, 1.0)))
    if not (tilt <= _STEEPEST):
        raise InvalidInputError(
            f"table: the touched plane is tilted by {np.degrees(tilt):.1f} degrees against the one before, at most "
            f"{np.degrees(_STEEPEST):.0f} are believed; check the points"
        )
    frame = np.eye(4)
    frame[:3, :3] = _turned(before[:3, :3], normal)
    lift = float(normal @ (middle - before[:3, 3])) / float(normal @ before[:3, 2])
    frame[:3, 3] = before[:3, 3] + lift * before[:3, 2]
    return TouchedTable(frame, (points - middle) @ normal, tilt, lift)


def _turned(rotation: FloatArray, normal: FloatArray) -> FloatArray:
    """The rotation with its z on the normal and its x as near as possible to where it was."""
    x = rotation[:, 0] - (rotation[:, 0] @ normal) * normal
    x /= np.linalg.norm(x)
    return np.column_stack((x, np.cross(normal, x), normal))
