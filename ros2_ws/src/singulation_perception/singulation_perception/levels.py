"""The heights at which a surface is flat: peaks in the histogram of its points."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from singulation_perception.object_points import FIRST, START, STOP, IntArray

Points = NDArray[np.float32]

_MOST = 12  # levels of one surface
_BINS = 8  # of the histogram to one face's range of heights
_PROMINENCE = 2.5  # a wall is as dense beside the range as in it, its end half as dense


@njit(cache=True)
def levels_of(
    xyz: Points,
    runs: IntArray,
    surface: IntArray,
    sizes: IntArray,
    wanted: NDArray[np.bool_],
    band: float,
    highest: float,
    min_size: int,
) -> tuple[IntArray, NDArray[np.float64]]:
    """Levels of every wanted surface.

    Args:
        xyz: (n, 3) points in ``table`` [m].
        runs: (m, 4) runs of them.
        surface: (m,) surface of each run.
        sizes: (s,) points of each surface.
        wanted: (s,) which surfaces to look at.
        band: half the height range of a face [m].
        highest: of all wanted points [m].
        min_size: fewest points of a level.

    Returns:
        first level of each surface (s + 1,) and the heights of all levels; a wanted surface without a flat part has
        the one level infinity, which takes all its points.
    """
    order, begin = _runs_by_surface(surface, len(sizes))
    width = 2.0 * band / _BINS
    histogram = np.zeros(int(highest / width) + 2, dtype=np.int32)
    first = np.zeros(len(sizes) + 1, dtype=np.int32)
    levels = np.empty(_MOST * len(sizes) + 1, dtype=np.float64)
    count = 0
    for one in range(len(sizes)):
        if wanted[one]:
            for i in range(len(histogram)):
                histogram[i] = 0
            for k in range(begin[one], begin[one + 1]):
                run = order[k]
                for i in range(runs[run, FIRST], runs[run, FIRST] + runs[run, STOP] - runs[run, START]):
                    histogram[int(xyz[i, 2] / width)] += 1
            count += _peaks(histogram, width, min_size, levels[count : count + _MOST])
        first[one + 1] = count
    return first, levels[:count]


@njit(cache=True)
def _runs_by_surface(surface: IntArray, count: int) -> tuple[IntArray, IntArray]:
    begin = np.zeros(count + 1, dtype=np.int32)
    for one in surface:
        begin[one + 1] += 1
    for one in range(count):
        begin[one + 1] += begin[one]
    following = begin.copy()
    order = np.empty(len(surface), dtype=np.int32)
    for run in range(len(surface)):
        order[following[surface[run]]] = run
        following[surface[run]] += 1
    return order, begin


@njit(cache=True)
def _peaks(histogram: IntArray, width: float, min_size: int, levels: NDArray[np.float64]) -> int:
    """Writes the levels of a histogram, empties it on the way, and says how many there are."""
    half = _BINS // 2
    count = 0
    while count < len(levels):
        best, middle, window = 0, -1, 0
        for i in range(len(histogram) + half):
            window += histogram[i] if i < len(histogram) else 0
            window -= histogram[i - _BINS] if i >= _BINS else 0
            if window > best:
                best, middle = window, i - half
        if best < min_size:
            break
        low, high = max(0, middle - half + 1), min(len(histogram), middle + half + 1)
        beside = _sum(histogram, low - _BINS, low) + _sum(histogram, high, high + _BINS)
        if 2 * best >= _PROMINENCE * beside:
            levels[count] = _mean(histogram, low, high, width)
            count += 1
        for i in range(max(0, low - half // 2), min(len(histogram), high + half // 2)):
            histogram[i] = 0
    if count == 0:
        levels[0] = np.inf
        count = 1
    return count


@njit(cache=True)
def _sum(histogram: IntArray, low: int, high: int) -> int:
    total = 0
    for i in range(max(0, low), min(len(histogram), high)):
        total += histogram[i]
    return total


@njit(cache=True)
def _mean(histogram: IntArray, low: int, high: int, width: float) -> float:
    total, weighted = 0, 0.0
    for i in range(low, high):
        total += histogram[i]
        weighted += histogram[i] * (i + 0.5)
    return weighted * width / total


@njit(cache=True)
def nearest_level(levels: NDArray[np.float64], begin: int, end: int, height: float, band: float) -> int:
    """The level within ``band`` of a height, -1 if there is none; an infinite level takes everything."""
    best, nearest = -1, band
    for level in range(begin, end):
        if levels[level] == np.inf:
            return level
        distance = abs(levels[level] - height)
        if distance <= nearest:
            best, nearest = level, distance
    return best
