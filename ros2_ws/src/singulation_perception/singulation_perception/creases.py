"""Straight lines inside a face that look like the seam of two flush blocks: rows of missing points, steps of height.

Concave corners are the usual trace of touching blocks. Where two blocks are flush at both ends there is none, but a gap
narrower than the point spacing still costs points along the seam, and unequal heights leave a step.
"""

import math

import numpy as np

from singulation_core.polygon import FloatArray
from singulation_perception.face_image import FaceImage, to_table
from singulation_perception.jit import compiled_maker
from singulation_perception.object_points import IntArray

_FEWEST = 8  # missing points of a groove
_PAIRS = np.random.default_rng(3).random(
    (400, 2)
)  # lines through two of them that are tried, as shares of their number
_WIDTH = 0.8  # pitches on either side of a line within which points belong to it
_SHARE = 0.22  # of the places on a line that are missing, from which it is looked at more closely
_LOOKED_AT = 4_000  # points of a face that are asked for a step
_UNEVEN = 1.3  # a face of two heights scatters that much more than others


def groove_line(image: FaceImage, pitch: float) -> FloatArray | None:
    """Normal and offset (3,) of the line that holds most missing points, None if no line holds many."""
    holes = _holes(image.point)
    if len(holes) < _FEWEST:
        return None
    turn = to_table(image)
    places = holes @ turn[:, :2].T + turn[:, 2]
    pairs = (_PAIRS * len(places)).astype(np.int64)
    line, count, extent = _best_line(places, pairs, _WIDTH * pitch)
    if count < max(_FEWEST, _SHARE * extent / pitch):
        return None
    return line


@compiled_maker
def _holes(point: IntArray) -> FloatArray:
    """(h, 2) rows and columns of pixels without a point between the first and the last point of row and column."""
    rows, columns = point.shape
    top, bottom = np.empty(columns, dtype=np.int32), np.empty(columns, dtype=np.int32)
    for column in range(columns):
        top[column], bottom[column] = rows, -1
    for row in range(rows):
        for column in range(columns):
            there = point[row, column] >= 0
            top[column] = min(top[column], row if there else rows)
            bottom[column] = row if there else bottom[column]
    holes = np.empty((rows * columns, 2))
    count = 0
    for row in range(rows):
        left, right = columns, -1
        for column in range(columns):
            if point[row, column] >= 0:
                left, right = min(left, column), column
        for column in range(left + 2, right - 1):
            if point[row, column] < 0 and top[column] + 1 < row < bottom[column] - 1:
                holes[count, 0], holes[count, 1] = row, column
                count += 1
    return holes[:count]


@compiled_maker
def _best_line(places: FloatArray, pairs: IntArray, width: float) -> tuple[FloatArray, int, float]:
    """Line through two places with most places near it, how many, and how far apart the outermost are."""
    best = np.zeros(3)
    most, extent = 0, 0.0
    for k in range(len(pairs)):
        ax, ay = places[pairs[k, 0], 0], places[pairs[k, 0], 1]
        ux, uy = places[pairs[k, 1], 0] - ax, places[pairs[k, 1], 1] - ay
        length = math.sqrt(ux * ux + uy * uy)
        if length < 4.0 * width:
            continue
        ux, uy = ux / length, uy / length
        count, low, high = 0, 0.0, 0.0
        for i in range(len(places)):
            x, y = places[i, 0] - ax, places[i, 1] - ay
            if abs(x * uy - y * ux) < width:
                t = x * ux + y * uy
                count, low, high = count + 1, min(low, t), max(high, t)
        if count > most:
            most, extent = count, high - low
            best[0], best[1], best[2] = uy, -ux, uy * ax - ux * ay
    return best, most, extent


def step_line(image: FaceImage, noise: float) -> FloatArray | None:
    """Normal and offset (3,) of the line that parts a face of two heights, None if it has one height."""
    chosen = image.point[image.point >= 0]
    points = image.xyz[chosen[:: max(1, len(chosen) // _LOOKED_AT)]].T.astype(np.float64)
    if not (float(points[2].std()) > _UNEVEN * noise):
        return None
    ordered = np.sort(points[2])
    upper = np.where(points[2] > 0.5 * (ordered[len(ordered) // 10] + ordered[-1 - len(ordered) // 10]), 1.0, -1.0)
    upper -= upper.mean()
    places = points[:2] - points[:2].mean(axis=1, keepdims=True)
    (xx, xy), (_, yy) = (places @ places.T).tolist()
    x, y = (places @ upper).tolist()
    slope = np.array((yy * x - xy * y, xx * y - xy * x))  # least squares but for its length
    length = float(np.hypot(*slope))
    if not (length > 0.0):
        return None
    normal = slope / length
    position = normal @ points[:2]
    order = np.argsort(position)
    cut = int(np.abs(np.cumsum(upper[order])).argmax())
    return np.array((normal[0], normal[1], position[order[cut]]))
