"""The rims of faces as rings in the plane of the table, with their measures."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.hull import hull_indices
from singulation_perception.jit import compiled_maker, compiled_part
from singulation_perception.object_points import IntArray
from singulation_perception.rings import concave_area, least_width

_SMALLEST_AREA = 1e-9  # [m^2] what has less is a line
_ROUGH_PITCHES, _ROUGH_NOISE = 2.5, 8.0
_LEAST_PITCH, _MOST_PITCH = 0.8, 1.25  # times the usual one


@dataclass(frozen=True, eq=False)
class FaceRings:
    """Rings of k faces.

    Args:
        points: (m, 2) of all rings, counter-clockwise [m].
        pixels: (m, 2) their rows and columns in the cloud.
        begin: (k + 1,) first point of each ring.
        pitch: (k,) distance of neighbouring points [m].
        roughness: (k,) depth up to which a rim counts as straight [m].
        width: (k,) least width [m].
        thickness: (k,) twice the area over the length of the ring [m].
        concave: (k,) area between ring and hull, roughness apart [m^2].
        hulls: numbers of the points of each ring that are corners of its hull, one ring after another.
        hull_begin: (k + 1,) where each ring's begin.
    """

    points: FloatArray
    pixels: IntArray
    begin: IntArray
    pitch: FloatArray
    roughness: FloatArray
    width: FloatArray
    thickness: FloatArray
    concave: FloatArray
    hulls: IntArray
    hull_begin: IntArray

    def ring(self, k: int) -> FloatArray:
        """(m, 2) points of ring k, a view."""
        return self.points[self.begin[k] : self.begin[k + 1]]

    def hull(self, k: int) -> IntArray:
        """Numbers of the corners of the hull of ring k, a view."""
        return self.hulls[self.hull_begin[k] : self.hull_begin[k + 1]]


def face_rings(
    xyz: NDArray[np.float32], rim: IntArray, begin: IntArray, count: IntArray, noise: float, camera: FloatArray
) -> FaceRings:
    """Rings of the faces.

    Noise moves a point along the line of sight: seen from above a rim stays where it is, seen obliquely it gets rough.

    Args:
        xyz: (n, 3) points in ``table`` [m].
        rim: (m, 3) number, row and column of the points on the rims, one face after another.
        begin: (k + 1,) where each face's begin.
        count: (k,) points of each face.
        noise: of the heights [m].
        camera: (3,) its place in ``table`` [m].
    """
    points, pixels, area = _oriented(xyz, rim, begin)
    pitch, roughness = _scales(xyz, rim, begin, area, count, noise, camera)
    return FaceRings(points, pixels, begin, pitch, roughness, *_measures(points, begin, area, roughness))


@compiled_maker
def _oriented(xyz: NDArray[np.float32], rim: IntArray, begin: IntArray) -> tuple[FloatArray, IntArray, FloatArray]:
    points = np.empty((len(rim), 2))
    pixels = np.empty((len(rim), 2), dtype=np.int32)
    area = np.empty(len(begin) - 1)
    for k in range(len(begin) - 1):
        first, last = begin[k], begin[k + 1]
        double = 0.0
        for i in range(first + 1, last):
            a, b = rim[i - 1, 0], rim[i, 0]
            x, y = np.float64(xyz[a, 0] - xyz[rim[first, 0], 0]), np.float64(xyz[a, 1] - xyz[rim[first, 0], 1])
            double += x * (xyz[b, 1] - xyz[a, 1]) - y * (xyz[b, 0] - xyz[a, 0])
        area[k] = 0.5 * abs(double)
        for i in range(first, last):
            at = i if double >= 0.0 else first + last - 1 - i
            points[at, 0], points[at, 1] = xyz[rim[i, 0], 0], xyz[rim[i, 0], 1]
            pixels[at, 0], pixels[at, 1] = rim[i, 1], rim[i, 2]
    return points, pixels, area


@compiled_maker
def _scales(
    xyz: NDArray[np.float32],
    rim: IntArray,
    begin: IntArray,
    area: FloatArray,
    count: IntArray,
    noise: float,
    camera: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Distance of neighbouring points and roughness of the rim of each face."""
    pitch, roughness = np.empty(len(area)), np.empty(len(area))
    widest, covered, cells = 0.0, 0.0, 0.0
    for k in range(len(area)):
        pitch[k] = math.sqrt(max(area[k], _SMALLEST_AREA) / _cells(count[k], begin[k + 1] - begin[k]))
        widest = max(widest, pitch[k])
    for k in range(len(area)):
        if pitch[k] > 0.5 * widest:  # walls have hardly any area from above
            covered, cells = covered + area[k], cells + _cells(count[k], begin[k + 1] - begin[k])
    usual = math.sqrt(covered / cells) if len(area) > 0 else 0.0
    for k in range(len(area)):
        pitch[k] = min(max(pitch[k], _LEAST_PITCH * usual), _MOST_PITCH * usual)
        at = rim[begin[k], 0]
        x, y, z = camera[0] - xyz[at, 0], camera[1] - xyz[at, 1], camera[2] - xyz[at, 2]
        oblique = math.sqrt(x * x + y * y) / max(abs(z), 1e-3)  # tangent between the vertical and the line of sight
        roughness[k] = max(_ROUGH_PITCHES * pitch[k], _ROUGH_NOISE * noise * oblique)
    return pitch, roughness


@compiled_part
def _cells(count: int, on_rim: int) -> float:
    """Pick's theorem: the area of a lattice polygon in cells is its points, less half of those on the rim, less one."""
    return max(count - 0.5 * on_rim - 1.0, 1.0)


@compiled_maker
def _measures(
    points: FloatArray, begin: IntArray, area: FloatArray, roughness: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, IntArray, IntArray]:
    width, thickness, concave = np.zeros(len(area)), np.zeros(len(area)), np.zeros(len(area))
    hulls, hull_begin = np.empty(len(points), dtype=np.int32), np.zeros(len(area) + 1, dtype=np.int32)
    for k in range(len(area)):
        ring = points[begin[k] : begin[k + 1]]
        hull = hull_indices(ring)
        first = hull_begin[k]
        hull_begin[k + 1] = first + len(hull)
        for i in range(len(hull)):
            hulls[first + i] = hull[i]
        if len(hull) > 2:
            length = 0.0
            for i in range(len(ring)):
                x, y = ring[i, 0] - ring[i - 1, 0], ring[i, 1] - ring[i - 1, 1]
                length += math.sqrt(x * x + y * y)
            width[k] = least_width(ring, hull)
            thickness[k] = 2.0 * area[k] / length
            concave[k] = concave_area(ring, hull, roughness[k])
    return width, thickness, concave, hulls, hull_begin
