"""Where a pusher stands, and how far it can go before it touches a block."""

import numpy as np
import pymunk

from singulation_core.polygon import FloatArray, separation
from singulation_core.push_world.space import BLOCKS_ONLY, corners
from singulation_core.push_world.sweep import free_travel


def free_share(space: pymunk.Space, pusher: pymunk.Body, way: FloatArray) -> float:
    """Share (0..1) of the straight ``way`` (2,), not zero, that the pusher can go until it touches a block."""
    length = float(np.hypot(way[0], way[1]))
    ways = [length]
    for shape in pusher.shapes:
        if isinstance(shape, pymunk.Circle):
            ways.append(length * _disc_share(space, pusher.local_to_world(shape.offset), shape.radius, way))
        elif isinstance(shape, pymunk.Poly):
            ways.append(free_travel(_outline(shape), _in_the_way(space, shape, way), way / length))
    return max(0.0, min(ways)) / length


def _disc_share(space: pymunk.Space, centre: pymunk.Vec2d, radius: float, way: FloatArray) -> float:
    # Not Chipmunk's query of the whole space: it looks only at blocks whose box the centre itself goes through.
    end = centre + (float(way[0]), float(way[1]))
    swept = pymunk.BB.newForCircle(centre, radius).merge(pymunk.BB.newForCircle(end, radius))
    hits = (one.segment_query(centre, end, radius) for one in space.bb_query(swept, BLOCKS_ONLY))
    return min((hit.alpha for hit in hits if hit is not None), default=1.0)


def _in_the_way(space: pymunk.Space, shape: pymunk.Poly, way: FloatArray) -> list[FloatArray]:
    """Outlines of the blocks near enough to be met."""
    here, (x, y) = shape.cache_bb(), way.tolist()
    swept = here.merge(pymunk.BB(here.left + x, here.bottom + y, here.right + x, here.top + y))
    near = space.bb_query(swept, BLOCKS_ONLY)
    return [_outline(one) for one in near if isinstance(one, pymunk.Poly)]


def standing_on(space: pymunk.Space, shape: pymunk.Shape, tolerance: float) -> list[pymunk.Shape]:
    """Shapes in the space that overlap a pusher's shape by more than ``tolerance``."""
    found = []
    for hit in space.shape_query(shape):
        depth = min(point.distance for point in hit.contact_point_set.points)
        if isinstance(shape, pymunk.Poly) and isinstance(hit.shape, pymunk.Poly) and depth < -tolerance:
            # Chipmunk's depth cannot be trusted where corners touch corners.
            depth = separation(_outline(shape), _outline(hit.shape))
        if hit.shape is not None and depth < -tolerance:
            found.append(hit.shape)
    return found


def _outline(shape: pymunk.Poly) -> FloatArray:
    return corners(shape, shape.body) if shape.body is not None else np.empty((0, 2))
