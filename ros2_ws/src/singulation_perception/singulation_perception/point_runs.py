"""Writing the points of a run, its row in the table of runs, and its span."""

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.coarse_look import Values
from singulation_perception.jit import compiled_part, compiled_part_sums
from singulation_perception.object_points import FIRST, HIGH, LOW, ROW, SQUARES, START, STOP, SUM, IntArray
from singulation_perception.raster import Raster


@compiled_part_sums
def locate(
    cloud: Raster,
    row: int,
    column: int,
    pose: NDArray[np.float32],
    limits: NDArray[np.float32],
    height: Values,
    first: np.uintp,
    length: int,
    numbers: Values,
    count: int,
) -> int:
    """Writes the points of a run, which begins at ``first`` among the heights, behind the ``count`` written ones; how
    many of them lie inside the workspace.

    Into a flat array and with a known step, which makes vector instructions of it.
    """
    start = np.uintp(row * cloud.row_step + column * cloud.point_step)
    if cloud.point_step == 3:
        return _located(cloud.numbers, start, np.uintp(3), pose, limits, height, first, length, numbers, count)
    return _located(
        cloud.numbers, start, np.uintp(cloud.point_step), pose, limits, height, first, length, numbers, count
    )


@compiled_part_sums
def _located(
    seen: Values,
    start: np.uintp,
    point_step: np.uintp,
    pose: NDArray[np.float32],
    limits: NDArray[np.float32],
    height: Values,
    first: np.uintp,
    length: int,
    numbers: Values,
    count: int,
) -> int:
    at, one, two, three = np.uintp(3 * count), np.uintp(1), np.uintp(2), np.uintp(3)
    xa, xb, xc, xd = pose[0, 0], pose[0, 1], pose[0, 2], pose[0, 3]  # read once: what is written might be theirs
    ya, yb, yc, yd = pose[1, 0], pose[1, 1], pose[1, 2], pose[1, 3]
    x_min, x_max, y_min, y_max = limits[0], limits[1], limits[2], limits[3]
    inside = 0
    for k in range(length):
        i = np.uintp(k)
        p, to = start + point_step * i, at + three * i
        a, b, c = seen[p], seen[p + one], seen[p + two]
        x, y = a * xa + b * xb + c * xc + xd, a * ya + b * yb + c * yc + yd
        numbers[to], numbers[to + one], numbers[to + two] = x, y, height[first + i]
        inside += (x >= x_min) & (x <= x_max) & (y >= y_min) & (y <= y_max)
    return inside


@compiled_part
def _is_inside(x: np.float32, y: np.float32, limits: NDArray[np.float32]) -> bool:
    return (x >= limits[0]) & (x <= limits[1]) & (y >= limits[2]) & (y <= limits[3])


@compiled_part
def crop(
    runs: IntArray,
    spans: FloatArray,
    run: int,
    row: int,
    column: int,
    count: int,
    height: Values,
    bits: IntArray,
    first: np.uintp,
    length: int,
    numbers: Values,
    limits: NDArray[np.float32],
) -> tuple[int, int]:
    """Notes the parts of a written run that lie inside the workspace, their points moved together; how many points and
    runs there are then.
    """
    written, begun = count, 0
    for k in range(length + 1):
        at = 3 * (written + k)
        if k < length and _is_inside(numbers[at], numbers[at + 1], limits):
            to = 3 * (count + k - begun)
            numbers[to], numbers[to + 1], numbers[to + 2] = numbers[at], numbers[at + 1], numbers[at + 2]
            continue
        if k > begun:
            note(runs, spans, run, row, column + begun, count, height, bits, first + np.uintp(begun), k - begun)
            count, run = count + k - begun, run + 1
        begun = k + 1
    return count, run


@compiled_part_sums
def note(
    runs: IntArray,
    spans: FloatArray,
    run: int,
    row: int,
    column: int,
    count: int,
    height: Values,
    bits: IntArray,
    first: np.uintp,
    length: int,
) -> None:
    """Writes a run and its span, with vector instructions: sums of small differences, which single precision holds, and
    least and greatest bits, for positive numbers are ordered as their bits. The last two places are worked in.
    """
    runs[run, ROW], runs[run, START], runs[run, STOP], runs[run, FIRST] = row, column, column + length, count
    level, total, squares = height[first], np.float32(0.0), np.float32(0.0)
    for k in range(length):
        more = height[first + np.uintp(k)] - level
        total += more
        squares += more * more
    low, high = bits[first], bits[first]
    for k in range(length):
        value = bits[first + np.uintp(k)]
        low, high = min(low, value), max(high, value)
    least, greatest = np.uintp(len(bits) - 2), np.uintp(len(bits) - 1)
    bits[least], bits[greatest] = low, high
    base = np.float64(level)
    spans[run, LOW], spans[run, HIGH], spans[run, SUM] = height[least], height[greatest], length * base + total
    spans[run, SQUARES] = length * base * base + 2.0 * base * total + squares
