"""An even subsample of a cloud: enough to find the table, the unit of length and the part of the image to look at."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core import ResultCode, SingulationError
from singulation_core.polygon import FloatArray
from singulation_perception.jit import compiled_maker
from singulation_perception.prefetch import prefetch
from singulation_perception.raster import Raster

_POINTS = 8_000  # looked at; a plane fitted to them is good to about 1/40 of the noise
_FEWEST = 100
_METRES_LIMIT = 30.0  # [m] no sensor of this kind reaches farther
_EVERYWHERE = (-np.inf, np.inf, -np.inf, np.inf)

Workspace = tuple[float, float, float, float]
IntArray = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class CloudSample:
    """Valid points of every ``step``-th row and column that lie inside the workspace.

    Args:
        located: (3, m) in the given frame [m].
        columns: (H, 2) first column and column after the last that may hold the workspace, in each row of the cloud.
        distance: mean distance of the points to the camera [m].
        pitch: distance of neighbouring points of the cloud on the table, rather too large than too small [m].
    """

    located: FloatArray
    columns: IntArray
    distance: float
    pitch: float


def sample(cloud: Raster, frame: FloatArray, workspace: Workspace | None) -> CloudSample:
    """Looks at some points of an organized cloud.

    Args:
        cloud: camera frame [m].
        frame: 4x4 that takes them to the frame of the workspace.
        workspace: limits, or None.

    Raises:
        SingulationError: NO_POINTS if (almost) none is valid or none lies in the workspace, NOT_METRES.
    """
    height, width = cloud.height, cloud.width
    row_step = max(1, int(np.sqrt(height * width / _POINTS))) if height > 1 else 1
    column_step = max(1, int(height * width / row_step / _POINTS))
    limits = np.array(workspace or _EVERYWHERE)
    located, spans, box, valid, inside, everywhere = _pick(cloud, row_step, column_step, np.array(frame[:3]), limits)
    columns = _columns(spans, row_step, 3 * column_step, height, width)
    looked_at = -(-height // row_step) * -(-width // column_step)
    if valid < min(_FEWEST, looked_at):
        raise SingulationError(
            ResultCode.NO_POINTS,
            f"{valid} of {looked_at} sampled points are valid (finite and not 0 0 0); is the camera covered?",
        )
    # In millimetres, everything lies far outside the workspace.
    count = located.shape[1]
    distance = inside / count if count >= _FEWEST else everywhere / max(valid, 1)
    if not (distance < _METRES_LIMIT):
        raise SingulationError(
            ResultCode.NOT_METRES,
            f"mean distance {distance:.0f}: the cloud looks like millimetres; clouds are in metres, divide by 1000",
        )
    return CloudSample(located, columns, distance, _pitch(box, count * row_step * column_step))


def _pitch(box: FloatArray, points: int) -> float:
    """Of points of a cloud that lie within limits in x and y: the room they take is more than what they cover."""
    return math.sqrt((box[1] - box[0]) * (box[3] - box[2]) / points) if points else 0.0


@compiled_maker
def _columns(spans: IntArray, row_step: int, margin: int, height: int, width: int) -> IntArray:
    """Limits for every row from those of the sampled rows beside it, widened by ``margin``."""
    columns = np.empty((height, 2), dtype=np.int32)
    for one in range(len(spans)):
        first, stop = spans[one, 0], spans[one, 1]
        for beside in range(max(one - 1, 0), min(one + 2, len(spans))):
            first, stop = min(first, spans[beside, 0]), max(stop, spans[beside, 1])
        first = min(max(first - margin, 0), width)
        stop = max(first, min(max(stop + margin, 0), width))
        for row in range(one * row_step, min((one + 1) * row_step, height)):
            columns[row, 0], columns[row, 1] = first, stop
    return columns


@compiled_maker
def _pick(
    cloud: Raster, row_step: int, column_step: int, frame: FloatArray, limits: FloatArray
) -> tuple[FloatArray, IntArray, FloatArray, int, float, float]:
    """Points inside the limits; first column and column after the last of them in each sampled row; their least and
    greatest x and y; how many points are valid anywhere; the sums of the distances of both to the camera.
    """
    numbers = cloud.numbers
    located = np.empty((3, (cloud.height // row_step + 1) * (cloud.width // column_step + 1)))
    spans = np.empty((-(-cloud.height // row_step), 2), dtype=np.int32)
    count, valid, inside, everywhere = 0, 0, 0.0, 0.0
    x_min, x_max, y_min, y_max = np.inf, -np.inf, np.inf, -np.inf
    for row in range(0, cloud.height, row_step):
        left, right = cloud.width, 0
        following = min(row + row_step, cloud.height - 1) * cloud.row_step
        for column in range(0, cloud.width, column_step):
            prefetch(numbers, following + column * cloud.point_step)
        for column in range(0, cloud.width, column_step):
            at = row * cloud.row_step + column * cloud.point_step
            a, b, c = np.float64(numbers[at]), np.float64(numbers[at + 1]), np.float64(numbers[at + 2])
            distance = math.sqrt(a * a + b * b + c * c)
            if not (0.0 < distance < np.inf):
                continue
            valid += 1
            everywhere += distance
            x = a * frame[0, 0] + b * frame[0, 1] + c * frame[0, 2] + frame[0, 3]
            y = a * frame[1, 0] + b * frame[1, 1] + c * frame[1, 2] + frame[1, 3]
            if limits[0] <= x <= limits[1] and limits[2] <= y <= limits[3]:
                located[0, count], located[1, count] = x, y
                located[2, count] = a * frame[2, 0] + b * frame[2, 1] + c * frame[2, 2] + frame[2, 3]
                x_min, x_max, y_min, y_max = min(x_min, x), max(x_max, x), min(y_min, y), max(y_max, y)
                count += 1
                inside += distance
                left, right = min(left, column), column + 1
        spans[row // row_step, 0], spans[row // row_step, 1] = left, right
    return (
        np.ascontiguousarray(located[:, :count]),
        spans,
        np.array((x_min, x_max, y_min, y_max)),
        valid,
        inside,
        everywhere,
    )
