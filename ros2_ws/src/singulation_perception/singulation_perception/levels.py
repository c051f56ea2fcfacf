"""The heights at which a surface is flat: peaks in the histogram of its points."""

import numpy as np
from numpy.typing import NDArray

from singulation_perception.jit import compiled_maker, compiled_part, compiled_part_maker
from singulation_perception.object_points import FIRST, START, STOP, IntArray

Points = NDArray[np.float32]

_MOST = 12  # levels of one surface
_BINS = 8  # of the histogram in the window of a peak, which is half as wide as the range of a face
_ENOUGH, _SPARSEST = 2_000, 4  # points of a surface that show its levels; at least every fourth run is looked at
_PARTS = 4  # histograms filled in turn: neighbours have one height, and a count must not wait for the one before
_LAST_PART = _PARTS - 1
_MASK = 6  # bins on either side of a peak in which there is no other
_PROMINENCE = 2.5  # a wall is as dense on both sides of a window as in it
_TAIL, _TAIL_REACH = 0.04, 32  # share of a peak that its own tails can hold, and bins up to which they count


@compiled_maker
def levels_of(
    xyz: Points,
    runs: IntArray,
    surface: IntArray,
    sizes: IntArray,
    tops: NDArray[np.float32],
    wanted: NDArray[np.bool_],
    band: float,
    apart: float,
    min_size: int,
) -> tuple[IntArray, NDArray[np.float64]]:
    """Levels of every wanted surface.

    Args:
        xyz: (n, 3) points in ``table`` [m].
        runs: (m, 4) runs of them.
        surface: (m,) surface of each run.
        sizes: (s,) points of each surface.
        tops: (s,) highest point of each [m].
        wanted: (s,) which surfaces to look at.
        band: half the height range of a face [m].
        apart: levels closer than this cannot be told apart point by point and become one [m].
        min_size: fewest points of a level.

    Returns:
        first level of each surface (s + 1,) and the lower and upper limit of all levels (l, 2); a wanted surface
        without a flat part has one level without limits.
    """
    order, begin = _runs_by_surface(surface, len(sizes))
    width = band / _BINS
    per_width = 1.0 / width
    highest = 0.0
    for one in range(len(sizes)):
        if wanted[one]:
            highest = max(highest, np.float64(tops[one]))
    room = np.empty(_PARTS * (int(highest * per_width) + 2), dtype=np.int32)
    first = np.zeros(len(sizes) + 1, dtype=np.int32)
    levels = np.empty((_MOST * len(sizes) + 1, 2), dtype=np.float64)
    count = 0
    for one in range(len(sizes)):
        if wanted[one]:
            bins = int(tops[one] * per_width) + 2
            parts = room[: _PARTS * bins]
            for i in range(len(parts)):
                parts[i] = 0
            every = min(max(sizes[one] // _ENOUGH, 1), _SPARSEST)
            for k in range(begin[one], begin[one + 1], every):
                run = order[k]
                for i in range(runs[run, FIRST], runs[run, FIRST] + runs[run, STOP] - runs[run, START]):
                    height = xyz[np.uintp(i), 2] * per_width
                    parts[np.uintp(int(height) + (i & _LAST_PART) * bins)] += 1
            for i in range(bins):
                for part in range(1, _PARTS):
                    parts[i] += parts[part * bins + i]
            found = levels[count : count + _MOST]
            count += _limits(found, _peaks(parts[:bins], width, min_size / every, found), band, apart)
        first[one + 1] = count
    return first, levels[:count]


@compiled_part_maker
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


@compiled_part_maker
def _peaks(histogram: IntArray, width: float, min_size: float, levels: NDArray[np.float64]) -> int:
    """Writes the heights of the levels of a histogram and says how many there are."""
    free = np.empty(len(histogram), dtype=np.int32)  # 0 near a peak that was looked at
    for i in range(len(histogram)):
        free[i] = 1
    at, size = np.empty(len(levels), dtype=np.int32), np.empty(len(levels), dtype=np.int32)
    count = 0
    while count < len(levels):
        best, low = _fullest(histogram, free)
        if best < min_size:
            break
        high = low + _BINS
        beside = min(_sum(histogram, low - _BINS, low), _sum(histogram, high, high + _BINS))
        tail = False
        for k in range(count):
            tail = tail or (abs(at[k] - low) < _TAIL_REACH and best < _TAIL * size[k])
        if best >= _PROMINENCE * beside and not tail:
            levels[count, 0] = _mean(histogram, free, low, high, width)
            at[count], size[count] = low, best
            count += 1
        middle = low + _BINS // 2
        for i in range(max(0, middle - _MASK), min(len(histogram), middle + _MASK)):
            free[i] = 0
    return count


@compiled_part
def _limits(levels: NDArray[np.float64], count: int, band: float, apart: float) -> int:
    """Turns heights into limits: sorted, near ones joined, half way between others that would overlap."""
    if count == 0:
        levels[0, 0], levels[0, 1] = -np.inf, np.inf
        return 1
    for k in range(1, count):
        at, height = k, levels[k, 0]
        while at > 0 and levels[at - 1, 0] > height:
            levels[at, 0] = levels[at - 1, 0]
            at -= 1
        levels[at, 0] = height
    kept, previous = 0, 0.0
    for k in range(count):
        height = levels[k, 0]
        if k > 0 and height - previous < apart:
            levels[kept - 1, 1] = height + band
        else:
            low = height - band
            if kept > 0 and low < levels[kept - 1, 1]:
                low = 0.5 * (previous + height)
                levels[kept - 1, 1] = low
            levels[kept, 0], levels[kept, 1] = low, height + band
            kept += 1
        previous = height
    return kept


@compiled_part
def _fullest(histogram: IntArray, free: IntArray) -> tuple[int, int]:
    """Most points in a window, those near earlier peaks left out, and the first bin of that window."""
    best, low, window = 0, 0, 0
    for i in range(len(histogram) + _BINS):
        if i < len(histogram):
            window += histogram[i] * free[i]
        if i >= _BINS:
            window -= histogram[i - _BINS] * free[i - _BINS]
        if window > best:
            best, low = window, i - _BINS + 1
    return best, low


@compiled_part
def _sum(histogram: IntArray, low: int, high: int) -> int:
    total = 0
    for i in range(max(0, low), min(len(histogram), high)):
        total += histogram[i]
    return total


@compiled_part
def _mean(histogram: IntArray, free: IntArray, low: int, high: int, width: float) -> float:
    total, weighted = 0, 0.0
    for i in range(max(0, low), min(len(histogram), high)):
        total += histogram[i] * free[i]
        weighted += histogram[i] * free[i] * (i + 0.5)
    return weighted * width / total


@compiled_part
def level_at(levels: NDArray[np.float64], begin: int, end: int, height: float) -> int:
    """The level that a height belongs to, -1 if there is none."""
    for level in range(begin, end):
        if levels[level, 0] <= height <= levels[level, 1]:
            return level
    return -1
