"""Blocks whose outlines overlap: stacked ones, and low ones whose hidden part was drawn too large."""

import numpy as np

from singulation_core.polygon import FloatArray, convex_hull, inward_half_planes, signed_area
from singulation_perception.confidence import CLIPPED, STACKED
from singulation_perception.found_block import FoundBlock
from singulation_perception.shapes import meeting_pairs, shape_of, shared_area

_STACKED = 0.25  # share of the upper block that lies over the lower one
_NEGLIGIBLE = 0.02  # share of the lower block that noise explains
_SLIVER = 1e-7  # [m^2]
_DETAIL = 0.0015  # [m] by which the corners of what is left over after a cut must stand out


def settled(blocks: list[FoundBlock], step: float) -> tuple[list[FoundBlock], int]:
    """Joins stacked blocks to one pile, which moves as one, and takes overlaps off the lower of two neighbours.

    Args:
        blocks: in any order.
        step: height difference from which one block is higher than another [m].

    Returns:
        The blocks, and how many lie on others and became part of their pile.
    """
    waiting = sorted(blocks, key=lambda block: block.height)
    if not any(_overlap(waiting[i], waiting[j]) for i, j in near_pairs(waiting, step)):
        return waiting, 0
    done: list[FoundBlock] = []
    stacked = 0
    while waiting:
        block = waiting.pop(0)
        for upper in [one for one in waiting if one.height > block.height + step and _near(block, one)]:
            shared, own, others = shared_area(block.outline, upper.outline)
            if shared > _STACKED * others:
                waiting.remove(upper)
                block = _pile(block, upper)
                stacked += 1
            elif shared > _NEGLIGIBLE * own:
                block = _clipped(block, upper)
        done.append(block)
    return done, stacked


def near_pairs(blocks: list[FoundBlock], step: float) -> list[tuple[int, int]]:
    """Lower and higher block of all pairs of different height whose bounding circles meet."""
    shapes = np.array([block.shape for block in blocks]).reshape(-1, 5)
    pairs = meeting_pairs(shapes, np.array([block.height for block in blocks]), step)
    return [(i, j) for i, j in pairs.tolist()]


def _overlap(lower: FoundBlock, upper: FoundBlock) -> bool:
    """Whether they overlap more than noise explains."""
    shared, own, others = shared_area(lower.outline, upper.outline)
    return bool(shared > min(_STACKED * others, _NEGLIGIBLE * own))


def _near(one: FoundBlock, two: FoundBlock) -> bool:
    x, y = one.shape.x - two.shape.x, one.shape.y - two.shape.y
    return x * x + y * y < (one.shape.radius + two.shape.radius) ** 2


def cut_off(outline: FloatArray, normal: FloatArray, offset: float) -> FloatArray:
    """The part of a convex outline with normal . p >= offset, (m, 2), m = 0 if there is none."""
    side = outline @ normal - offset
    kept: list[FloatArray] = []
    for k in range(len(outline)):
        j = (k + 1) % len(outline)
        if side[k] >= 0.0:
            kept.append(outline[k])
        if min(side[k], side[j]) < 0.0 < max(side[k], side[j]):
            kept.append(outline[k] + (outline[j] - outline[k]) * side[k] / (side[k] - side[j]))
    return np.array(kept).reshape(-1, 2)


def _pile(lower: FoundBlock, upper: FoundBlock) -> FoundBlock:
    outline = convex_hull(np.vstack((lower.outline, upper.outline)))
    confidence = STACKED * min(lower.confidence, upper.confidence)
    count = lower.count + upper.count
    return FoundBlock(outline, shape_of(outline), upper.height, count, confidence, lower.surface, lower.face)


def _clipped(lower: FoundBlock, upper: FoundBlock) -> FoundBlock:
    """The lower block without what lies beyond the edge of the upper one that costs it least."""
    parts = [
        cut_off(lower.outline, -normal, -float(offset))
        for normal, offset in zip(*inward_half_planes(upper.outline), strict=True)
    ]
    best = max(parts, key=lambda part: signed_area(part) if len(part) > 2 else 0.0)
    if len(best) < 3 or not (signed_area(best) > _SLIVER):
        return lower.doubted(STACKED)
    return lower.redrawn(_without_details(convex_hull(best)), CLIPPED)


def _without_details(outline: FloatArray) -> FloatArray:
    """A convex outline without corners that hardly stand out between their neighbours, the flattest first."""
    while len(outline) > 3:
        before, after = np.roll(outline, 1, axis=0), np.roll(outline, -1, axis=0)
        ways, offs = after - before, outline - before
        depths = np.abs(ways[:, 0] * offs[:, 1] - ways[:, 1] * offs[:, 0]) / np.hypot(ways[:, 0], ways[:, 1])
        flattest = int(depths.argmin())
        if not (depths[flattest] < _DETAIL):
            break
        outline = np.delete(outline, flattest, axis=0)
    return outline
