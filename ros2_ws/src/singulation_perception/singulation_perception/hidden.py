"""Parts of a face that the camera cannot see because something taller stands in the way."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.hull import hull_indices
from singulation_perception.jit import compiled_maker, compiled_part, compiled_part_maker
from singulation_perception.object_points import IntArray
from singulation_perception.raster import Raster
from singulation_perception.rings import pockets

_COVERED = 0.5  # share of a pocket filled by something taller that may lie on the block
_SEEN_LOWER = 0.3  # share of a pocket that is seen to be lower, from which on it is empty
_TALLER = 0.03  # share of taller points around a pocket that can have hidden it
_AROUND = 6  # pixels
_ROWS = 30  # of a pocket and its surroundings that are looked at, about
_FEWEST = 6  # points of a rim between two hidden pockets
_SHADOW = 0.35  # tangent of the projector's view beside the camera's: 0.23 m of baseline at 0.65 m and more


@dataclass(frozen=True, eq=False)
class View:
    """The cloud as the camera sees it.

    Args:
        camera: (3,) its place in ``table`` [m].
        plane: (4,) of the table in the camera frame.
        cloud: as the camera sees it, to tell hidden from empty; None if the cloud has no image order.
    """

    camera: FloatArray
    plane: FloatArray
    cloud: Raster | None


def reach_of_shadows(view: View, x: float, y: float, height: float) -> float:
    """Length of what something hides from the camera or the projector, in its height above a face.

    Args:
        view: of the camera.
        x: of a place on the face [m].
        y: of the same [m].
        height: of the face [m].
    """
    away = math.hypot(float(view.camera[0]) - x, float(view.camera[1]) - y)
    return away / max(abs(float(view.camera[2]) - height), 1e-3) + _SHADOW


def without_hidden(ring: FloatArray, pixels: IntArray, roughness: float, view: View, height: float) -> FloatArray:
    """Bridges the pockets of a ring that are hidden rather than empty.

    A pocket counts as hidden if less than 30 % of it is seen to be lower than the face, something taller is near, and
    that is tall enough to hide, from the camera or the projector, as much as is missing, or covers half of it.

    Args:
        ring: (m, 2) rim of a face [m].
        pixels: (m, 2) rows and columns of its points in the cloud.
        roughness: of the rim [m].
        view: of the camera.
        height: of the face [m].

    Returns:
        The ring without the hidden pockets.
    """
    if view.cloud is None:
        return ring
    reach = reach_of_shadows(view, float(ring[0, 0]), float(ring[0, 1]), height)
    keep = _in_sight(ring, pixels, roughness, view.cloud, view.plane.astype(np.float32), height, reach)
    return ring if keep.all() else np.asarray(ring[keep])


@compiled_maker
def _in_sight(
    ring: FloatArray,
    pixels: IntArray,
    roughness: float,
    cloud: Raster,
    plane: NDArray[np.float32],
    height: float,
    reach: float,
) -> NDArray[np.bool_]:
    """(m,) which points of a ring do not lie in a hidden pocket, or between two with hardly any others."""
    keep = np.ones(len(ring), dtype=np.bool_)
    low, high = np.float32(height - roughness), np.float32(height + roughness)
    found = pockets(ring, hull_indices(ring), roughness)
    for k in range(len(found)):
        first, count, depth = np.int64(found[k, 0]), np.int64(found[k, 1] - found[k, 0]) + 1, found[k, 3]
        pocket = np.empty((count, 2), dtype=np.int32)
        for i in range(count):
            at = (first + i) % len(ring)
            pocket[i, 0], pocket[i, 1] = pixels[at, 0], pixels[at, 1]
        lower, covered, taller, inside, near, level = _look(cloud, plane, pocket, low, high)
        hidden = lower < _SEEN_LOWER * inside and taller > _TALLER * near
        tall_enough = depth < reach * (level - height) + 2.0 * roughness
        if hidden and (tall_enough or covered > _COVERED * inside):
            for i in range(1, count - 1):
                keep[(first + i) % len(ring)] = False
    _drop_scattered(keep)
    return keep


@compiled_part
def _drop_scattered(keep: NDArray[np.bool_]) -> None:
    """Points left over between hidden pockets, too few for a rim: the wall of what is taller has some at any height."""
    size = len(keep)
    for first in range(size):
        if keep[first] and not keep[first - 1]:
            count = 1
            while count < _FEWEST and keep[(first + count) % size]:
                count += 1
            if count < _FEWEST:
                for i in range(count):
                    keep[(first + i) % size] = False


@compiled_part_maker
def _look(
    cloud: Raster,
    plane: NDArray[np.float32],
    pocket: IntArray,
    low: np.float32,
    high: np.float32,
) -> tuple[int, int, int, int, int, float]:
    """Points lower inside a pocket, taller inside, taller in and around it, pixels inside and around; mean height of
    the taller. Of large pockets every few rows are counted: only shares are asked for.
    """
    top, left, bottom, right = cloud.height, cloud.width, 0, 0
    for i in range(len(pocket)):
        top, bottom = min(top, pocket[i, 0]), max(bottom, pocket[i, 0] + 1)
        left, right = min(left, pocket[i, 1]), max(right, pocket[i, 1] + 1)
    top, bottom = max(0, top - _AROUND), min(cloud.height, bottom + _AROUND)
    left, right = max(0, left - _AROUND), min(cloud.width, right + _AROUND)
    inside_row = np.empty(right - left + 1, dtype=np.int32)
    lower, covered, taller, inside, near, total = 0, 0, 0, 0, 0, 0.0
    for row in range(top, bottom, max(1, (bottom - top) // _ROWS)):
        near += right - left
        for column in range(right - left + 1):
            inside_row[column] = 0
        for i in range(len(pocket)):  # the row is inside between crossings: parity, summed from the left
            r, q = pocket[i, 0], pocket[i - 1, 0]
            if (r > row) != (q > row):
                crossing = pocket[i, 1] + (row - r) * (pocket[i - 1, 1] - pocket[i, 1]) / (q - r)
                inside_row[max(0, min(right, math.ceil(crossing)) - left)] ^= 1
        within = 0
        for column in range(left, right):
            within ^= inside_row[column - left]
            inside += within
            at = row * cloud.row_step + column * cloud.point_step
            a, b, c = cloud.numbers[at], cloud.numbers[at + 1], cloud.numbers[at + 2]
            level = a * plane[0] + b * plane[1] + c * plane[2] + plane[3]
            if math.isfinite(level) and not (a == 0.0 and b == 0.0 and c == 0.0):
                if level > high:
                    taller += 1
                    covered += within
                    total += level
                lower += within == 1 and level < low
    return lower, covered, taller, inside, near, total / max(taller, 1)
