"""Which object each point belongs to."""

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray, inward_half_planes
from singulation_perception.block_search import Blocks
from singulation_perception.found_block import deepest
from singulation_perception.jit import compiled_maker
from singulation_perception.object_points import FIRST, ROW, START, STOP, IntArray, ObjectPoints


def labels_in_image(shape: tuple[int, ...], seen: ObjectPoints, blocks: Blocks) -> IntArray:
    """(H, W) ids, -1 for none.

    A point belongs to the block of its surface (walls included) whose outline is nearest to it in the plane of the
    table.
    """
    labels = np.full(shape, -1, dtype=np.int32)
    objects = sorted(blocks.objects, key=lambda item: blocks.surface[item.id])
    if not objects:
        return labels
    planes = [np.column_stack(inward_half_planes(item.outline)) for item in objects]
    first_plane = np.concatenate(([0], np.cumsum([len(one) for one in planes])))
    surface = np.array([blocks.surface[item.id] for item in objects])
    first_object = np.searchsorted(surface, np.arange(len(blocks.surfaces.count) + 1))
    ids = np.array([item.id for item in objects], dtype=np.int32)
    _paint(labels, seen.xyz, seen.runs, blocks.surfaces.of_run, first_object, ids, first_plane, np.vstack(planes))
    return labels


@compiled_maker
def _paint(
    labels: IntArray,
    xyz: NDArray[np.float32],
    runs: IntArray,
    surface: IntArray,
    first_object: NDArray[np.int64],
    ids: IntArray,
    first_plane: NDArray[np.int64],
    planes: FloatArray,
) -> None:
    for run in range(len(runs)):
        begin, end = np.int64(first_object[surface[run]]), np.int64(first_object[surface[run] + 1])
        if begin == end:
            continue
        for column in range(runs[run, START], runs[run, STOP]):
            point = xyz[runs[run, FIRST] + column - runs[run, START]]
            best = deepest(planes, first_plane, begin, end, np.float64(point[0]), np.float64(point[1]))
            labels[runs[run, ROW], column] = ids[best]
