"""The rims of faces, followed pixel by pixel around each face."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_perception.jit import compiled_maker, compiled_part
from singulation_perception.object_points import FIRST, ROW, START, STOP, IntArray
from singulation_perception.surfaces import Faces

# Moore neighbourhood, clockwise in an image whose rows run downwards, starting to the right.
_ROWS = np.array((0, 1, 1, 1, 0, -1, -1, -1), dtype=np.int64)
_COLUMNS = np.array((1, 1, 0, -1, -1, -1, 0, 1), dtype=np.int64)


@dataclass(frozen=True, eq=False)
class FaceMaps:
    """Little images of the chosen faces, with a rim of one empty pixel, one after another in one array.

    Args:
        faces: (k,) number of the face of each image.
        point: number of the object point of each pixel, -1 where the face has none.
        first: (k + 1,) first pixel of each image in ``point``.
        box: (k, 4) row and column of the first pixel in the cloud, rows and columns of the image.
    """

    faces: IntArray
    point: IntArray
    first: NDArray[np.int64]
    box: IntArray

    def image(self, k: int) -> IntArray:
        """(rows, columns) of face k, a view."""
        _, _, rows, columns = self.box[k]
        return self.point[self.first[k] : self.first[k + 1]].reshape(rows, columns)


def face_maps(faces: Faces, chosen: IntArray) -> FaceMaps:
    """Paints the chosen faces."""
    return FaceMaps(chosen, *_painted(faces.runs, faces.of_run, faces.box, chosen))


@compiled_maker
def _painted(
    runs: IntArray, face: IntArray, face_box: IntArray, chosen: IntArray
) -> tuple[IntArray, NDArray[np.int64], IntArray]:
    first, box = np.zeros(len(chosen) + 1, dtype=np.int64), np.empty((len(chosen), 4), dtype=np.int32)
    image_of_face = np.empty(len(face_box), dtype=np.int32)
    for one in range(len(face_box)):
        image_of_face[one] = -1
    for k in range(len(chosen)):
        one = chosen[k]
        image_of_face[one] = k
        box[k, 0], box[k, 1] = face_box[one, 0] - 1, face_box[one, 2] - 1
        box[k, 2], box[k, 3] = face_box[one, 1] - box[k, 0] + 1, face_box[one, 3] - box[k, 1] + 1
        first[k + 1] = first[k] + np.int64(box[k, 2]) * box[k, 3]
    point = np.empty(first[-1], dtype=np.int32)
    for i in range(len(point)):
        point[np.uintp(i)] = -1
    for run in range(len(runs)):
        k = image_of_face[face[run]]
        if k >= 0:
            at = np.uintp(first[k] + (runs[run, ROW] - box[k, 0]) * box[k, 3] + runs[run, START] - box[k, 1])
            number = np.int32(runs[run, FIRST])
            for i in range(runs[run, STOP] - runs[run, START]):
                point[at + np.uintp(i)] = number + np.int32(i)
    return point, first, box


def rims(maps: FaceMaps) -> tuple[IntArray, IntArray]:
    """Outer rims of all faces, in order around them.

    Returns:
        (m, 3) number, row and column of each point on a rim, and (k + 1,) where each face's begin.
    """
    rim, begin = _followed(maps.point, maps.first, maps.box)
    return rim, begin


@compiled_maker
def _followed(point: IntArray, first: NDArray[np.int64], box: IntArray) -> tuple[IntArray, IntArray]:
    pixels = np.empty(4 * len(point), dtype=np.int64)
    begin = np.zeros(len(first), dtype=np.int32)
    count = 0
    for k in range(len(box)):
        start = first[k]
        while point[start] < 0:
            start += 1
        count += _follow(point, start, np.int64(box[k, 3]), pixels[count:])
        begin[k + 1] = count
    rim = np.empty((count, 3), dtype=np.int32)
    for k in range(len(box)):
        for i in range(begin[k], begin[k + 1]):
            at = pixels[i] - first[k]
            rim[i, 0] = point[pixels[i]]
            rim[i, 1], rim[i, 2] = box[k, 0] + at // box[k, 3], box[k, 1] + at % box[k, 3]
    return rim, begin


@compiled_part
def _follow(point: IntArray, start: int, width: int, rim: NDArray[np.int64]) -> int:
    """Moore tracing from the first pixel of the first row until it is entered the same way again (Jacob's rule)."""
    at, way, first_way, count = start, 6, -1, 0  # came from above
    while True:
        found = -1
        for turn in range(8):
            direction = (way + turn) % 8
            if point[at + _ROWS[direction] * width + _COLUMNS[direction]] >= 0:
                found = direction
                break
        if found < 0:  # a single pixel
            rim[count] = at
            return count + 1
        if at == start:
            if first_way < 0:
                first_way = found
            elif found == first_way:
                return count
        if count >= len(rim):
            return count
        rim[count] = at
        count += 1
        at += _ROWS[found] * width + _COLUMNS[found]
        way = (found + 5) % 8 if found % 2 else (found + 6) % 8
