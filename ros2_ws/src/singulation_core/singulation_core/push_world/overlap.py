"""Overlapping outlines cannot both be right: the physical border lies between them."""

import numpy as np
import pymunk

from singulation_core.errors import SingulationError
from singulation_core.polygon import FloatArray, inward_half_planes, signed_area
from singulation_core.push_world.space import Block, corners
from singulation_core.result_code import ResultCode

_DEEPEST = 0.3  # of the smaller block's bounding radius; a deeper overlap is not perception noise
_SMALLEST_SHARE = 0.5  # of a block's area that must survive the cuts


def refuse_deep_overlap(first: int, second: int, depth: float, radius: float) -> None:
    """Raise if two blocks overlap by more than noise explains.

    Args:
        first, second: their ids.
        depth: of the overlap, in the unit of ``radius``.
        radius: smaller of their bounding radii.

    Raises:
        SingulationError: ``OVERLAPPING_OBJECTS``.
    """
    if not (depth <= _DEEPEST * radius):
        raise SingulationError(
            ResultCode.OVERLAPPING_OBJECTS,
            f"objects {first} and {second} overlap by {depth / radius:.0%} of the smaller bounding radius, need "
            f"{_DEEPEST:.0%} at most: perceive the scene again",
        )


def part_overlapping(space: pymunk.Space, blocks: list[Block], slop: float) -> None:
    """Cut overlapping blocks apart along the middle of their overlap, without moving them.

    A solver would push them apart, which looks like a gain that no push made (measured: up to 0.8 of brute force's).

    Args:
        space: in which the blocks are in place.
        blocks: all of it.
        slop: overlap that needs no cut.

    Raises:
        SingulationError: ``OVERLAPPING_OBJECTS`` if an overlap is too deep, or too little of a block is left.
    """
    areas = [block.shape.area for block in blocks]
    rank: dict[pymunk.Shape, int] = {block.shape: position for position, block in enumerate(blocks)}
    for first, block in enumerate(blocks):
        for hit in space.shape_query(block.shape):
            second = rank.get(hit.shape, -1) if hit.shape is not None else -1
            if second > first and (_deep(hit, slop) or _nearly_concentric(block, blocks[second])):
                _part(block, blocks[second], slop, areas[first], areas[second])


def _deep(hit: pymunk.ShapeQueryInfo, slop: float) -> bool:
    return min(point.distance for point in hit.contact_point_set.points) < -slop


def _nearly_concentric(first: Block, second: Block) -> bool:
    """Whether Chipmunk may not see at all how deep they overlap."""
    return first.body.position.get_distance(second.body.position) < 0.5


def _part(first: Block, second: Block, slop: float, first_area: float, second_area: float) -> None:
    # Chipmunk says that two blocks meet; how deep it does not know where corners touch corners.
    one, other = corners(first.shape, first.body), corners(second.shape, second.body)
    depth, normal, border = max(_least_overlap(one, other), _turned_round(_least_overlap(other, one)), key=_height)
    if depth < -slop:
        radius = min(float(np.hypot(*np.array(block.shape.get_vertices()).T).max()) for block in (first, second))
        refuse_deep_overlap(first.id, second.id, -depth, radius)
        _cut(first, one, normal, border, first_area)
        _cut(second, other, -normal, -border, second_area)


def _least_overlap(one: FloatArray, other: FloatArray) -> tuple[float, FloatArray, float]:
    """Over the edges of ``one``: (gap, outward unit normal, middle of the gap) where the gap is largest."""
    normals, offsets = inward_half_planes(one)
    gaps = (offsets[:, None] - normals @ other.T).min(axis=1)
    best = int(gaps.argmax())
    return float(gaps[best]), -normals[best], float(0.5 * gaps[best] - offsets[best])


def _turned_round(overlap: tuple[float, FloatArray, float]) -> tuple[float, FloatArray, float]:
    depth, normal, border = overlap
    return depth, -normal, -border


def _height(overlap: tuple[float, FloatArray, float]) -> float:
    return overlap[0]


def _cut(block: Block, outline: FloatArray, normal: FloatArray, border: float, whole: float) -> None:
    """Keep the part of the block with ``normal . x <= border``."""
    kept = _clipped(outline, outline @ normal - border)
    share = signed_area(kept) / whole if len(kept) >= 3 else 0.0
    if not (share >= _SMALLEST_SHARE):
        raise SingulationError(
            ResultCode.OVERLAPPING_OBJECTS,
            f"object {block.id} overlaps others so far that {share:.0%} of it is left; need "
            f"{_SMALLEST_SHARE:.0%}: perceive the scene again",
        )
    block.shape.unsafe_set_vertices([block.body.world_to_local((float(x), float(y))) for x, y in kept])
    block.shape.cache_bb()


def _clipped(outline: FloatArray, heights: FloatArray) -> FloatArray:
    """One pass of Sutherland-Hodgman: the vertices with heights <= 0 and the crossings."""
    kept = []
    for k, (vertex, height) in enumerate(zip(outline, heights, strict=True)):
        following, next_height = outline[(k + 1) % len(outline)], heights[(k + 1) % len(outline)]
        if height <= 0.0:
            kept.append(vertex)
        if min(height, next_height) < 0.0 < max(height, next_height):
            kept.append(vertex + (following - vertex) * height / (height - next_height))
    return np.array(kept)
