"""What the cloud shows along a possible seam: missing points of a groove, a step of the height."""

import math

import numpy as np

from singulation_perception.face_image import FaceImage
from singulation_perception.jit import compiled_maker, compiled_part, compiled_part_maker

_ENDS = 4.0  # pitches at either end of the seam, where its corners disturb
_NEAR, _FAR = 3.5, 7.5  # pitches from the seam at which heights are compared
_REACH = 9
_NONE, _CLEAR = 0.15, 0.5  # share of missing points that says nothing, and that proves a groove
_STEP, _STEP_IN_NOISE = 0.00015, 2.5  # [m] step that is proof; warp and print give less than a third of it
_SURE = 4.0  # standard errors


@compiled_maker
def trace_strength(image: FaceImage, ax: float, ay: float, bx: float, by: float, pitch: float, noise: float) -> float:
    """0 if nothing of a seam is seen between two points of a face, up to 1 if a groove or step is beyond doubt.

    Args:
        image: the face.
        ax, ay: one of them [m].
        bx, by: the other [m].
        pitch: distance of neighbouring points [m].
        noise: of the heights [m].
    """
    missing, step, error = _along(image, ax, ay, bx, by, pitch)
    groove = (missing - _NONE) / (_CLEAR - _NONE)
    proof = max(_STEP, _STEP_IN_NOISE * noise)
    edge = (abs(step) - _SURE * error - 0.3 * proof) / (0.7 * proof)
    return min(1.0, max(0.0, groove, edge))


@compiled_part_maker
def _along(image: FaceImage, ax: float, ay: float, bx: float, by: float, pitch: float) -> tuple[float, float, float]:
    """Share of places on the line without points, beyond what is missing beside it; step [m] and its standard error.

    The step compares heights extrapolated to the line from either side, so that a tilted face has none.
    """
    ux, uy = bx - ax, by - ay
    length = math.sqrt(ux * ux + uy * uy)
    ux, uy = ux / max(length, 1e-12), uy / max(length, 1e-12)
    places = int(length / pitch - 2.0 * _ENDS)
    count, total, squares = np.zeros(4), np.zeros(4), np.zeros(4)
    on, beside = 0, 0
    for k in range(places):
        t = (_ENDS + k) * pitch
        lost = np.zeros(3, dtype=np.int64)  # on the line, to the left, to the right
        for d in range(-_REACH, _REACH + 1):
            height = _height(image, ax + t * ux - d * pitch * uy, ay + t * uy + d * pitch * ux)
            if -1 <= d <= 1:
                lost[0] += math.isnan(height)
            elif 3 <= d <= 5:
                lost[1] += math.isnan(height)
            elif -5 <= d <= -3:
                lost[2] += math.isnan(height)
            if abs(d) >= 2 and not math.isnan(height):
                band = (0 if d > 0 else 2) + (0 if abs(d) <= 5 else 1)
                count[band] += 1.0
                total[band] += height
                squares[band] += height * height
        on += lost[0] > 0
        beside += (lost[1] > 0) + (lost[2] > 0)
    if places < 3 or count[0] < 6 or count[2] < 6:
        return 0.0, 0.0, np.inf
    usual = 0.5 * beside / places
    missing = (on / places - usual) / max(1.0 - usual, 0.1)
    level, error = np.zeros(2), 0.0
    for side in range(2):
        near, far = 2 * side, 2 * side + 1
        mean = total[near] / count[near]
        variance = max(squares[near] / count[near] - mean * mean, 0.0)
        slope = 0.0
        if count[far] > 0.5 * count[near]:
            slope = (mean - total[far] / count[far]) / (_FAR - _NEAR)
        level[side] = mean + slope * _NEAR
        error += 3.0 * variance / count[near]  # the slope's share doubles it
    return missing, level[0] - level[1], math.sqrt(error)


@compiled_part
def _height(image: FaceImage, x: float, y: float) -> float:
    """Height at a place of the table, relative to a point of the face [m]; NaN without a point."""
    map_ = image.to_pixel
    row = math.floor(map_[0, 0] * x + map_[0, 1] * y + map_[0, 2] + 0.5)
    column = math.floor(map_[1, 0] * x + map_[1, 1] * y + map_[1, 2] + 0.5)
    if row < 0 or column < 0 or row >= image.point.shape[0] or column >= image.point.shape[1]:
        return np.nan
    point = image.point[row, column]
    return np.float64(image.xyz[point, 2]) if point >= 0 else np.nan
