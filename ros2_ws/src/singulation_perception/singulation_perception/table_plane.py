"""The table: where its plane is, how noisy the cloud is on it, or why it cannot be trusted."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from singulation_core import ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from singulation_core.transforms import inverse, transform_points

from singulation_perception.parameters import SegmentationParameters

_SAMPLES = 16_000  # valid points looked at; the fit is then good to about 1/100 of the noise
_SCORED = 2_000  # of them, to score a hypothesis
_HYPOTHESES = 128  # three good points come up with 0.15^3; free search uses more
_MAX_NOISE = 0.02  # [m] a plane that scatters more is none
_METRES_LIMIT = 30.0  # [m] no sensor of this kind reaches farther


@dataclass(frozen=True, eq=False)
class TablePlane:
    """The fitted table.

    Args:
        table_from_camera: 4x4, z = 0 on the fitted plane, z towards the camera.
        noise: robust standard deviation of the cloud about the plane [m], unevenness of the table included.
        share: of the sampled points inside the workspace that lie on the plane.
        offset: height of the fitted plane above the expected one at the middle of the workspace [m], 0 without one.
        tilt: angle between fitted and expected plane [rad], 0 without an expected one.
    """

    table_from_camera: FloatArray
    noise: float
    share: float
    offset: float
    tilt: float

    @property
    def camera_plane(self) -> FloatArray:
        """(4,) unit normal and offset in the camera frame: height = normal . point + offset."""
        return np.asarray(self.table_from_camera[2])


def find_table(
    points: NDArray[np.float32],
    parameters: SegmentationParameters,
    previous: TablePlane | None = None,
) -> TablePlane:
    """Robust plane fit on a subsample of the cloud.

    Args:
        points: (N, 3) or (H, W, 3), camera frame [m].
        parameters: expected pose and limits.
        previous: the table in the last cloud; tried first, so that equal scenes give equal planes.

    Raises:
        SingulationError: NO_POINTS, NOT_METRES, NO_TABLE (no plane at all), WRONG_TABLE (a plane, but not the
            expected one: the floor of a bin, a tilted or lifted table).
    """
    sample = _sample(points)
    expected = parameters.table_from_camera
    frame = np.eye(4) if expected is None else expected
    located = transform_points(frame, sample)
    if expected is not None:
        located = located[_inside(located, parameters.workspace)]
        if len(located) < 100:
            raise SingulationError(
                ResultCode.NO_POINTS,
                f"{len(located)} of {len(sample)} sampled points lie in the workspace {parameters.workspace} m; "
                "check table_from_camera, workspace and that the camera sees the table",
            )
    plane = _search(located, parameters, expected is not None, previous, frame)
    plane, inliers, noise = _refine(located, plane, expected is not None)
    share = float(inliers.mean())
    _require_plane(located[inliers], share, noise, parameters)
    if expected is None:
        return TablePlane(_frame_from_plane(plane), noise, share, 0.0, 0.0)
    return _near_expected(plane, noise, share, parameters, expected)


def _sample(points: NDArray[np.float32]) -> FloatArray:
    """Valid points of an even subsample, (m, 3)."""
    if points.ndim == 3:
        step = max(1, int(np.sqrt(points.shape[0] * points.shape[1] / (2 * _SAMPLES))))
        chosen = points[::step, ::step].reshape(-1, 3)
    else:
        chosen = points[:: max(1, len(points) // (2 * _SAMPLES))]
    chosen = chosen.astype(np.float64)
    valid = chosen[np.isfinite(chosen).all(axis=1) & (chosen != 0.0).any(axis=1)]
    if len(valid) < 100:
        raise SingulationError(
            ResultCode.NO_POINTS,
            f"{len(valid)} of {len(chosen)} sampled points are valid (finite and not 0 0 0); is the camera covered?",
        )
    distance = float(np.median(np.linalg.norm(valid, axis=1)))
    if not (distance < _METRES_LIMIT):
        raise SingulationError(
            ResultCode.NOT_METRES,
            f"median distance {distance:.0f}: the cloud looks like millimetres; clouds are in metres, divide by 1000",
        )
    return np.asarray(valid)


def _inside(located: FloatArray, workspace: tuple[float, float, float, float] | None) -> NDArray[np.bool_]:
    if workspace is None:
        return np.ones(len(located), dtype=bool)
    x_min, x_max, y_min, y_max = workspace
    x, y = located[:, 0], located[:, 1]
    return np.asarray((x >= x_min) & (x <= x_max) & (y >= y_min) & (y <= y_max))


def _search(
    located: FloatArray,
    parameters: SegmentationParameters,
    expected: bool,
    previous: TablePlane | None,
    frame: FloatArray,
) -> FloatArray:
    """Best of many three-point planes, (4,) with unit normal; with an expectation only planes near it count."""
    random = np.random.default_rng(7)  # equal clouds give equal planes
    near = located
    if expected:
        near = located[np.abs(located[:, 2]) <= 2.0 * parameters.max_table_offset]
        if len(near) < 100:
            near = located
    corners = near[random.integers(0, len(near), (_HYPOTHESES if expected else 4 * _HYPOTHESES, 3))]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    usable = lengths > 1e-12
    normals = normals[usable] / lengths[usable, None]
    planes = np.column_stack((normals, -(normals * corners[usable, 0]).sum(axis=1)))
    if previous is not None:
        planes = np.vstack((_plane_in_frame(previous.camera_plane, frame), planes))
    if not len(planes):
        raise SingulationError(ResultCode.NO_TABLE, "all sampled points lie on one line or coincide, no plane in them")
    scored = near[random.integers(0, len(near), _SCORED)]
    reach = 0.0015 if expected else 0.004 * float(np.median(np.linalg.norm(scored, axis=1)))
    hits = (np.abs(scored @ planes[:, :3].T + planes[:, 3]) < reach).sum(axis=0)
    best = planes[int(hits.argmax())]
    return np.asarray(_facing(best, frame))


def _plane_in_frame(plane: FloatArray, frame: FloatArray) -> FloatArray:
    """A plane of the camera frame, expressed in ``frame`` (4x4 frame_from_camera)."""
    return np.asarray(plane @ inverse(frame))


def _facing(plane: FloatArray, frame: FloatArray) -> FloatArray:
    """The plane with its normal towards the camera."""
    height = float(plane[:3] @ frame[:3, 3] + plane[3])
    return plane if height >= 0.0 else -plane


def _refine(located: FloatArray, plane: FloatArray, expected: bool) -> tuple[FloatArray, NDArray[np.bool_], float]:
    """Least squares on what lies within three robust deviations, repeated."""
    reach = 0.003 if expected else 0.006 * float(np.median(np.linalg.norm(located, axis=1)))
    noise = reach
    for _ in range(4):
        heights = located @ plane[:3] + plane[3]
        inliers = np.abs(heights) <= reach
        if inliers.sum() < 50:
            break
        chosen = located[inliers]
        centre = chosen.mean(axis=0)
        normal = np.linalg.eigh(np.cov((chosen - centre).T))[1][:, 0]
        normal = normal if normal @ plane[:3] > 0.0 else -normal
        plane = np.append(normal, -normal @ centre)
        residuals = chosen @ plane[:3] + plane[3]
        noise = float(1.4826 * np.median(np.abs(residuals - np.median(residuals))))
        reach = max(3.5 * noise, 1e-6)
    return plane, np.abs(located @ plane[:3] + plane[3]) <= max(reach, 1e-6), noise


def _require_plane(inliers: FloatArray, share: float, noise: float, parameters: SegmentationParameters) -> None:
    if not (share >= parameters.min_table_share and noise < _MAX_NOISE and len(inliers) >= 50):
        raise SingulationError(
            ResultCode.NO_TABLE,
            f"the best plane holds {100 * share:.0f} % of the points in view with {1000 * noise:.1f} mm of scatter; "
            f"a table holds at least {100 * parameters.min_table_share:.0f} %",
        )
    spread = np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(inliers.T)), 0.0))
    if not (spread[1] > 0.01):
        raise SingulationError(
            ResultCode.NO_TABLE,
            f"the points of the plane spread {1000 * spread[1]:.1f} mm across, need more than 10 mm to tell its tilt",
        )


def _near_expected(
    plane: FloatArray, noise: float, share: float, parameters: SegmentationParameters, expected: FloatArray
) -> TablePlane:
    """Turns and lifts the expected frame so that z = 0 is the plane; the middle of the workspace stays in place."""
    x_min, x_max, y_min, y_max = parameters.workspace or (0.0, 0.0, 0.0, 0.0)
    middle = np.array(((x_min + x_max) / 2, (y_min + y_max) / 2, 0.0))
    tilt = float(np.arccos(np.clip(plane[2], -1.0, 1.0)))
    offset = -float(plane[:3] @ middle + plane[3]) / max(float(plane[2]), 1e-9)
    if not (tilt <= parameters.max_table_tilt and abs(offset) <= parameters.max_table_offset):
        raise SingulationError(
            ResultCode.WRONG_TABLE,
            f"the plane found is {1000 * offset:+.1f} mm from the expected table and tilted by "
            f"{np.degrees(tilt):.2f} degrees; allowed are {1000 * parameters.max_table_offset:.1f} mm and "
            f"{np.degrees(parameters.max_table_tilt):.2f} degrees (max_table_offset, max_table_tilt). "
            "Is it the floor of a bin, was the camera moved, or is table_from_camera wrong?",
        )
    middle[2] = offset
    correction = np.eye(4)
    correction[:3, :3] = _turn_to_z(plane[:3])
    correction[:3, 3] = np.array((middle[0], middle[1], 0.0)) - correction[:3, :3] @ middle
    return TablePlane(correction @ expected, noise, share, offset, tilt)


def _turn_to_z(normal: FloatArray) -> FloatArray:
    """Smallest rotation that takes the unit normal (z > 0) to (0, 0, 1)."""
    a, b, c = normal
    s = 1.0 / (1.0 + c)
    return np.array(((1.0 - a * a * s, -a * b * s, -a), (-a * b * s, 1.0 - b * b * s, -b), (a, b, c)))


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
