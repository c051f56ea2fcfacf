"""Corners of low blocks that a taller neighbour hides from the camera or from the projector.

A shadow cuts a corner off: a square looks like a pentagon. The edge it leaves shows where it comes from: the shadow of
a horizontal edge on a horizontal face is parallel to that edge, the shadow of an upright edge lies on a line through
it. Both hold for what the camera cannot see as for what the projector does not reach. Such an edge is left out if its
neighbours meet where nothing could be seen.
"""

import math

import numpy as np
from numpy.typing import NDArray

from singulation_core.polygon import FloatArray
from singulation_perception.confidence import COMPLETED
from singulation_perception.face_blocks import FaceBlocks
from singulation_perception.found_block import FoundBlock
from singulation_perception.hidden import reach_of_shadows
from singulation_perception.jit import compiled_maker, compiled_part
from singulation_perception.object_points import IntArray
from singulation_perception.piles import near_pairs
from singulation_perception.raster import Raster

_SEEN = 0.15  # share of a hidden corner that may be seen to be lower: flying points
_SHARPEST = 0.15  # sine at a corner that is put back
_LOOSE = 2.0  # pitches: places of corners and edges
_PARALLEL, _TURNED = 0.04, 0.75  # sine between a shadow and what casts it; the same for loose ends of a short shadow
_STEPS = 12  # of the lattice of places that are looked at, along each side


def with_hidden_corners(blocks: list[FoundBlock], faces: FaceBlocks, step: float) -> list[FoundBlock]:
    """Puts the hidden corners of low blocks back; without an image of the cloud nothing is known to be hidden.

    Args:
        blocks: all of them.
        faces: that they were found in.
        step: height difference from which one block is higher than another [m].
    """
    if faces.view.cloud is None:
        return blocks
    done = list(blocks)
    for lower, upper in near_pairs(blocks, step):
        if len(done[lower].outline) > 3:
            done[lower] = _completed(done[lower], blocks[upper], faces, step)
    return done


def _completed(block: FoundBlock, upper: FoundBlock, faces: FaceBlocks, step: float) -> FoundBlock:
    """A low block with the corners that one taller neighbour hides."""
    loose = _LOOSE * faces.pitch(block.face)
    per_height = reach_of_shadows(faces.view, block.shape.x, block.shape.y, block.height)
    reach = per_height * (upper.height - block.height) + loose
    outline, k = np.ascontiguousarray(block.outline), 0
    completed = False
    while True:
        k, x, y = shadowed_edge(outline, np.ascontiguousarray(upper.outline), reach, loose, k)
        if k < 0:
            return block.redrawn(outline, COMPLETED) if completed else block
        others = (k + 1 + np.arange(len(outline) - 1)) % len(outline)  # the end of the edge comes first
        if _is_unseen(outline[k], outline[others[0]], np.array((x, y)), block, faces, step):
            outline, k, completed = np.vstack(((x, y), outline[others[1:]])), 0, True
        else:
            k += 1


@compiled_maker
def shadowed_edge(
    outline: FloatArray, caster: FloatArray, reach: float, loose: float, begin: int
) -> tuple[int, float, float]:
    """The next edge of a low block, from edge ``begin`` on, that may be where the shadow of something taller ends.

    Args:
        outline: of the low block [m].
        caster: outline of what is taller [m].
        reach: of its shadow [m].
        loose: how far corners and edges may be off [m].

    Returns:
        Number of the edge, -1 if there is none, and the place where its neighbours meet outside it.
    """
    size = len(outline)
    for k in range(begin, size if size > 3 else 0):
        i, j, m = k - 1 if k > 0 else size - 1, (k + 1) % size, (k + 2) % size
        ex, ey = outline[j, 0] - outline[k, 0], outline[j, 1] - outline[k, 1]
        ax, ay = outline[k, 0] - outline[i, 0], outline[k, 1] - outline[i, 1]
        bx, by = outline[m, 0] - outline[j, 0], outline[m, 1] - outline[j, 1]
        length = math.sqrt(ex * ex + ey * ey)
        sine = ax * by - ay * bx
        if not (sine > _SHARPEST * math.sqrt((ax * ax + ay * ay) * (bx * bx + by * by))):
            continue
        way = (ex * by - ey * bx) / sine
        x, y = outline[k, 0] + ax * way, outline[k, 1] + ay * way
        depth = way * (ey * ax - ex * ay) / length
        if 0.0 < depth < reach and _depth_inside(caster, x, y) < loose:
            mx, my = 0.5 * (outline[k, 0] + outline[j, 0]), 0.5 * (outline[k, 1] + outline[j, 1])
            if _casts(caster, mx, my, ex / length, ey / length, length, reach, loose):
                return k, x, y
    return -1, 0.0, 0.0


@compiled_part
def _depth_inside(outline: FloatArray, x: float, y: float) -> float:
    """How deep inside an outline a place lies [m]; negative outside."""
    least = np.inf
    for k in range(len(outline)):
        ax, ay = outline[k - 1, 0], outline[k - 1, 1]
        ex, ey = outline[k, 0] - ax, outline[k, 1] - ay
        least = min(least, (ex * (y - ay) - ey * (x - ax)) / math.sqrt(ex * ex + ey * ey))
    return least


@compiled_part
def _casts(
    caster: FloatArray, x: float, y: float, ux: float, uy: float, length: float, reach: float, loose: float
) -> bool:
    """Whether an edge of a low block, by its middle, direction and length, may end the shadow of something taller."""
    sine = min(0.5, _PARALLEL + _TURNED * loose / length)
    for k in range(len(caster)):
        cx, cy = caster[k, 0] - x, caster[k, 1] - y
        beyond = abs(cx * ux + cy * uy) - 0.5 * length
        if abs(cx * uy - cy * ux) < 2.0 * loose and beyond < reach:
            return True  # of the upright edge at this corner
        ex, ey = caster[k, 0] - caster[k - 1, 0], caster[k, 1] - caster[k - 1, 1]
        size = math.sqrt(ex * ex + ey * ey)
        before = (ex * cy - ey * cx) / size
        if ex * ux + ey * uy < 0.0 and abs(ex * uy - ey * ux) < sine * size and -loose < before < reach:
            return True  # of the horizontal edge that ends there
    return False


def _is_unseen(
    start: FloatArray, stop: FloatArray, corner: FloatArray, block: FoundBlock, faces: FaceBlocks, step: float
) -> bool:
    """Whether nothing lower than the block is seen between an edge of it and a corner beyond."""
    image, plane = faces.image(block.face), faces.view.plane.astype(np.float32)
    level = np.float32(block.height - step)
    lower = count_lower(faces.view.cloud, plane, image.to_pixel, image.corner, start, stop, corner, level)
    return bool(lower < _SEEN * _STEPS * _STEPS)


@compiled_maker
def count_lower(
    cloud: Raster,
    plane: NDArray[np.float32],
    to_pixel: FloatArray,
    first: IntArray,
    start: FloatArray,
    stop: FloatArray,
    corner: FloatArray,
    level: np.float32,
) -> int:
    """At how many places of a lattice between an edge and a corner the camera sees something below ``level`` [m].

    Args:
        cloud: as the camera sees it.
        plane: (4,) of the table in the camera frame.
        to_pixel: (2, 3) from places to rows and columns from ``first`` on.
        first: (2,) row and column in the cloud.
        start, stop, corner: (2,) ends of the edge and the corner [m].
        level: of the table frame [m].
    """
    count = 0
    for i in range(_STEPS):
        for j in range(_STEPS):
            along, up = (i + 0.5) / _STEPS, (j + 0.5) / _STEPS
            x, y = start[0] + along * (stop[0] - start[0]), start[1] + along * (stop[1] - start[1])
            x, y = x + up * (corner[0] - x), y + up * (corner[1] - y)
            row = math.floor(to_pixel[0, 0] * x + to_pixel[0, 1] * y + to_pixel[0, 2] + 0.5) + first[0]
            column = math.floor(to_pixel[1, 0] * x + to_pixel[1, 1] * y + to_pixel[1, 2] + 0.5) + first[1]
            row, column = min(max(row, 0), cloud.height - 1), min(max(column, 0), cloud.width - 1)
            at = row * cloud.row_step + column * cloud.point_step
            a, b, c = cloud.numbers[at], cloud.numbers[at + 1], cloud.numbers[at + 2]
            there = a != 0.0 or b != 0.0 or c != 0.0
            count += there and a * plane[0] + b * plane[1] + c * plane[2] + plane[3] < level
    return count
