"""Connected surfaces among the object points, and the flat top faces in them."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.jit import compiled_maker, compiled_part
from singulation_perception.levels import level_at, levels_of
from singulation_perception.object_points import (
    FIRST,
    HIGH,
    LOW,
    ROW,
    SQUARES,
    START,
    STOP,
    SUM,
    IntArray,
    ObjectPoints,
    widen,
)
from singulation_perception.union_find import numbered_roots, single_sets, unite

Points = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Surfaces:
    """Sets of object points that hang together, walls included.

    Args:
        of_run: (m,) surface of each run of the object points.
        count: (s,) points.
        top: (s,) highest point [m].
    """

    of_run: IntArray
    count: IntArray
    top: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Faces:
    """Horizontal faces, each connected in the image.

    Args:
        runs: (m, 4) as in ``ObjectPoints``, of points on a face only.
        of_run: (m,) face of each run.
        surface: (f,) surface that each face belongs to.
        flat: (f,) whether it is a level with many points; else a whole surface that has no flat part.
        count: (f,) points.
        height: (f,) mean height [m].
        scatter: (f,) standard deviation of the heights [m].
        holes: (f,) pixels without a point between points in the same row.
        box: (f, 4) first row, row after the last, first column, column after the last.
    """

    runs: IntArray
    of_run: IntArray
    surface: IntArray
    flat: NDArray[np.bool_]
    count: IntArray
    height: NDArray[np.float64]
    scatter: NDArray[np.float64]
    holes: IntArray
    box: IntArray


def surfaces_of(seen: ObjectPoints, step: float, cluster: IntArray | None = None) -> Surfaces:
    """Links neighbours in the image that differ in height by at most ``step`` [m].

    Args:
        seen: the object points.
        step: of neighbours [m].
        cluster: (m,) of each run, if only runs of one cluster may be linked.
    """
    kind = np.zeros(len(seen.runs), dtype=np.int32) if cluster is None else cluster
    surface, count = connected_runs(seen.xyz, seen.runs, seen.spans, kind, step)
    return Surfaces(surface, *_sizes(seen.runs, seen.spans, surface, count))


def faces_of(seen: ObjectPoints, surfaces: Surfaces, band: float, apart: float, highest: float, min_size: int) -> Faces:
    """Parts surfaces into the levels at which they have many points.

    A wall that is seen obliquely can chain the tops of several blocks into one surface; the levels part them again.

    Args:
        seen: the object points.
        surfaces: of them.
        band: half the height range of a face [m].
        apart: least height difference of two faces [m].
        highest: surfaces that reach higher have no faces [m].
        min_size: fewest points of a level.
    """
    wanted = (surfaces.count >= min_size) & (surfaces.top <= highest)
    first, levels = levels_of(
        seen.xyz, seen.runs, surfaces.of_run, surfaces.count, surfaces.top, wanted, band, apart, min_size
    )
    runs, spans, level = _runs_on_levels(seen.xyz, seen.runs, seen.spans, surfaces.of_run, first, levels)
    face, count = connected_runs(seen.xyz, runs, spans, level, np.inf)
    counts, heights, scatter, holes, boxes, level_of_face = _face_table(runs, spans, face, level, count)
    surface = np.searchsorted(first, level_of_face, side="right").astype(np.int32) - 1
    return Faces(runs, face, surface, np.isfinite(levels[level_of_face, 0]), counts, heights, scatter, holes, boxes)


@compiled_maker
def connected_runs(xyz: Points, runs: IntArray, spans: FloatArray, kind: IntArray, step: float) -> tuple[IntArray, int]:
    """Number of the connected set of each run: runs of one kind, above one another, at most ``step`` apart.

    ``spans`` are not looked at if ``step`` is infinite.
    """
    parent = single_sets(len(runs))
    above, row_start = 0, 0
    for run in range(len(runs)):
        if run > 0 and runs[run, ROW] != runs[run - 1, ROW]:
            above = row_start if runs[run - 1, ROW] == runs[run, ROW] - 1 else run
            row_start = run
        while above < row_start and runs[above, STOP] <= runs[run, START]:
            above += 1
        other = above
        while other < row_start and runs[other, START] < runs[run, STOP]:
            if kind[other] == kind[run] and _meet(xyz, runs, spans, other, run, step):
                unite(parent, np.int64(other), np.int64(run))
            other += 1
    return numbered_roots(parent)


@compiled_part
def _meet(xyz: Points, runs: IntArray, spans: FloatArray, one: int, two: int, step: float) -> bool:
    """Whether two runs in neighbouring rows have neighbours that differ by at most ``step``."""
    if step == np.inf or max(spans[one, HIGH], spans[two, HIGH]) - min(spans[one, LOW], spans[two, LOW]) <= step:
        return True
    begin, end = max(runs[one, START], runs[two, START]), min(runs[one, STOP], runs[two, STOP])
    for column in range(begin, end):
        a = xyz[runs[one, FIRST] + column - runs[one, START], 2]
        b = xyz[runs[two, FIRST] + column - runs[two, START], 2]
        if abs(a - b) <= step:
            return True
    return False


@compiled_maker
def _sizes(runs: IntArray, spans: FloatArray, surface: IntArray, count: int) -> tuple[IntArray, NDArray[np.float32]]:
    sizes = np.zeros(count, dtype=np.int32)
    tops = np.zeros(count, dtype=np.float32)
    for run in range(len(runs)):
        sizes[surface[run]] += runs[run, STOP] - runs[run, START]
        tops[surface[run]] = max(tops[surface[run]], spans[run, HIGH])
    return sizes, tops


@compiled_maker
def _runs_on_levels(
    xyz: Points,
    runs: IntArray,
    spans: FloatArray,
    surface: IntArray,
    first: IntArray,
    levels: FloatArray,
) -> tuple[IntArray, FloatArray, IntArray]:
    """Runs cut where the level changes, without the points that lie on none; their spans and levels."""
    cut = np.empty((len(xyz), 4), dtype=np.int32)
    cut_spans = np.empty((len(xyz), 4))
    kind = np.empty(len(xyz), dtype=np.int32)
    count = 0
    for run in range(len(runs)):
        begin, end = first[surface[run]], first[surface[run] + 1]
        if begin == end:
            continue
        level = level_at(levels, begin, end, spans[run, LOW])
        if level >= 0 and level == level_at(levels, begin, end, spans[run, HIGH]):  # the usual case, all of it
            for k in range(4):
                cut[count, k], cut_spans[count, k] = runs[run, k], spans[run, k]
            kind[count] = level
            count += 1
            continue
        last = -1
        for column in range(runs[run, START], runs[run, STOP]):
            i = runs[run, FIRST] + column - runs[run, START]
            height = np.float64(xyz[i, 2])
            level = level_at(levels, begin, end, height)
            if level >= 0:
                if level != last:
                    cut[count, ROW], cut[count, START], cut[count, FIRST] = runs[run, ROW], column, i
                    cut_spans[count, LOW], cut_spans[count, HIGH] = height, height
                    cut_spans[count, SUM], cut_spans[count, SQUARES] = 0.0, 0.0
                    kind[count] = level
                    count += 1
                cut[count - 1, STOP] = column + 1
                widen(cut_spans, count - 1, height)
            last = level
    return cut[:count], cut_spans[:count], kind[:count]


@compiled_maker
def _face_table(
    runs: IntArray, spans: FloatArray, face: IntArray, level: IntArray, count: int
) -> tuple[IntArray, FloatArray, FloatArray, IntArray, IntArray, IntArray]:
    counts, holes = np.zeros(count, dtype=np.int32), np.zeros(count, dtype=np.int32)
    heights, squares = np.zeros(count), np.zeros(count)
    level_of_face = np.zeros(count, dtype=np.int32)
    box = np.empty((count, 4), dtype=np.int32)
    last = np.empty(count, dtype=np.int32)  # run of each face
    for run in range(len(runs)):
        one = face[run]
        if counts[one] == 0:
            box[one, 0], box[one, 2], box[one, 3] = runs[run, ROW], runs[run, START], runs[run, STOP]
            level_of_face[one] = level[run]
        elif runs[last[one], ROW] == runs[run, ROW]:
            holes[one] += runs[run, START] - runs[last[one], STOP]
        last[one] = run
        box[one, 1] = runs[run, ROW] + 1
        box[one, 2] = min(box[one, 2], runs[run, START])
        box[one, 3] = max(box[one, 3], runs[run, STOP])
        counts[one] += runs[run, STOP] - runs[run, START]
        heights[one] += spans[run, SUM]
        squares[one] += spans[run, SQUARES]
    for one in range(count):
        heights[one] /= counts[one]
        squares[one] = math.sqrt(max(squares[one] / counts[one] - heights[one] * heights[one], 0.0))
    return counts, heights, squares, holes, box, level_of_face
