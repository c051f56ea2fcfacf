"""The table: where its plane is, how noisy the cloud is on it, or why it cannot be trusted."""

import math
from dataclasses import dataclass

import numpy as np

from singulation_core import ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from singulation_core.transforms import inverse
from singulation_perception.cloud_sample import CloudSample, IntArray, sample
from singulation_perception.parameters import SegmentationParameters
from singulation_perception.plane_fit import best_plane, plane_spread, refined_plane
from singulation_perception.raster import Raster

_NEAR_HYPOTHESES = 96  # near an expected table, every second point lies on it
_FREE_HYPOTHESES = 500  # three points of a plane that holds a fifth of the cloud come up four times
_ASKED = 2_000  # points that hypotheses come from
_MAX_NOISE = 0.02  # [m] a plane that scatters more is none
_LEAST_SPREAD = 0.01  # [m] across, to tell a tilt


@dataclass(frozen=True, eq=False)
class TablePlane:
    """The fitted table.

    Args:
        table_from_camera: 4x4, z = 0 on the fitted plane, z towards the camera.
        noise: robust standard deviation of the cloud about the plane [m], unevenness of the table included.
        share: of the sampled points inside the workspace that lie on the plane.
        offset: height of the fitted plane above the expected one at the middle of the workspace [m], 0 without one.
        tilt: angle between fitted and expected plane [rad], 0 without an expected one.
        columns: (H, 2) first column and column after the last that may hold the workspace, in each row of the cloud.
        pitch: distance of neighbouring points on the table, rather too large than too small [m].
    """

    table_from_camera: FloatArray
    noise: float
    share: float
    offset: float
    tilt: float
    columns: IntArray
    pitch: float

    @property
    def camera_plane(self) -> FloatArray:
        """(4,) unit normal and offset in the camera frame: height = normal . point + offset."""
        return np.asarray(self.table_from_camera[2])


def find_table(
    cloud: Raster,
    parameters: SegmentationParameters,
    previous: TablePlane | None = None,
) -> TablePlane:
    """Robust plane fit on a subsample of the cloud.

    Args:
        cloud: camera frame [m].
        parameters: expected pose and limits.
        previous: the table in the last cloud; where it still holds, no other is sought.

    Raises:
        SingulationError: NO_POINTS, NOT_METRES, NO_TABLE (no plane at all), WRONG_TABLE (a plane, but not the
            expected one: the floor of a bin, a tilted or lifted table).
    """
    expected = parameters.table_from_camera
    frame = np.eye(4) if expected is None else expected
    picked = sample(cloud, frame, None if expected is None else parameters.workspace)
    size = picked.located.shape[1]
    if size < 100:
        raise SingulationError(
            ResultCode.NO_POINTS,
            f"{size} sampled points lie in the workspace {parameters.workspace} m; check "
            "table_from_camera, workspace and that the camera sees the table",
        )
    plane = _start(picked, parameters, previous, frame)
    plane, noise, reach = refined_plane(picked.located, plane, 0.003 if expected is not None else _free_reach(picked))
    count, spread = plane_spread(picked.located, plane, reach)
    share = count / size
    _require_plane(share, noise, spread, parameters)
    if expected is None:
        return TablePlane(_frame_from_plane(plane), noise, share, 0.0, 0.0, picked.columns, picked.pitch)
    pose, offset, tilt = _near_expected(plane, parameters, expected)
    return TablePlane(pose, noise, share, offset, tilt, picked.columns, picked.pitch)


def _free_reach(picked: CloudSample) -> float:
    """Scatter to reckon with when nothing is known of the sensor: depth noise grows with distance [m]."""
    return 0.005 * picked.distance


def _start(
    picked: CloudSample, parameters: SegmentationParameters, previous: TablePlane | None, frame: FloatArray
) -> FloatArray:
    """The plane to refine, normal towards the camera; where a table is expected, only points near it are asked."""
    some = picked.located[:, :: max(1, picked.located.shape[1] // _ASKED)]
    near, free = some, parameters.table_from_camera is None
    if not free:
        near = some.compress(np.abs(some[2]) <= 2.0 * parameters.max_table_offset, axis=1)
        if near.shape[1] < parameters.min_table_share * some.shape[1]:
            near = some  # then whatever plane there is, to say where it is
    last = None if previous is None else previous.camera_plane @ inverse(frame)
    if free:
        plane = best_plane(near, _FREE_HYPOTHESES, _free_reach(picked), last)
    else:
        plane = best_plane(near, _NEAR_HYPOTHESES, 0.0015, last)
    if plane is None:
        raise SingulationError(ResultCode.NO_TABLE, "all sampled points lie on one line or coincide, no plane in them")
    return plane if plane[:3] @ frame[:3, 3] + plane[3] >= 0.0 else -plane


def _require_plane(share: float, noise: float, spread: float, parameters: SegmentationParameters) -> None:
    if not (share >= parameters.min_table_share and noise < _MAX_NOISE):
        raise SingulationError(
            ResultCode.NO_TABLE,
            f"the best plane holds {100 * share:.0f} % of the points in view with {1000 * noise:.1f} mm of scatter; "
            f"need {100 * parameters.min_table_share:.0f} % (min_table_share) and {1000 * _MAX_NOISE:.0f} mm",
        )
    if not (spread > _LEAST_SPREAD):
        raise SingulationError(
            ResultCode.NO_TABLE,
            f"the points of the plane spread {1000 * spread:.1f} mm across, need more than "
            f"{1000 * _LEAST_SPREAD:.0f} mm to tell its tilt",
        )


def _near_expected(
    plane: FloatArray, parameters: SegmentationParameters, expected: FloatArray
) -> tuple[FloatArray, float, float]:
    """Turns and lifts the expected frame so that z = 0 is the plane; the middle of the workspace stays in place.

    A camera is calibrated on a board in the workspace: there its pose is right even if its tilt is a little off.
    """
    x_min, x_max, y_min, y_max = parameters.workspace or (0.0, 0.0, 0.0, 0.0)
    x, y = 0.5 * (x_min + x_max), 0.5 * (y_min + y_max)
    a, b, c, d = plane.tolist()
    tilt = math.acos(min(max(c, -1.0), 1.0))
    offset = -(a * x + b * y + d) / max(c, 1e-9)
    if not (tilt <= parameters.max_table_tilt and abs(offset) <= parameters.max_table_offset):
        raise SingulationError(
            ResultCode.WRONG_TABLE,
            f"the plane found is {1000 * offset:+.1f} mm from the expected table and tilted by "
            f"{np.degrees(tilt):.2f} degrees; allowed are {1000 * parameters.max_table_offset:.1f} mm and "
            f"{np.degrees(parameters.max_table_tilt):.2f} degrees (max_table_offset, max_table_tilt). "
            "Is it the floor of a bin, was the camera moved, or is table_from_camera wrong?",
        )
    turn = _turn_to_z(a, b, c)
    moved = [place - (row[0] * x + row[1] * y + row[2] * offset) for place, row in zip((x, y, 0.0), turn, strict=True)]
    correction = [(*row, shift) for row, shift in zip(turn, moved, strict=True)]
    return np.array((*correction, (0.0, 0.0, 0.0, 1.0))) @ expected, offset, tilt


def _turn_to_z(a: float, b: float, c: float) -> tuple[tuple[float, float, float], ...]:
    """Rows of the smallest rotation that takes the unit normal (a, b, c), c > 0, to (0, 0, 1)."""
    s = 1.0 / (1.0 + c)
    return (1.0 - a * a * s, -a * b * s, -a), (-a * b * s, 1.0 - b * b * s, -b), (a, b, c)


def _frame_from_plane(plane: FloatArray) -> FloatArray:
    """Table frame of a plane in the camera frame: origin below the camera, x along the camera's x."""
    z = plane[:3]
    along = np.array((1.0, 0.0, 0.0)) if abs(z[0]) < 0.9 else np.array((0.0, -1.0, 0.0))
    x = along - (along @ z) * z
    x /= np.linalg.norm(x)
    pose = np.eye(4)
    pose[:3, :3] = np.vstack((x, np.cross(z, x), z))
    pose[2, 3] = plane[3]
    return pose
