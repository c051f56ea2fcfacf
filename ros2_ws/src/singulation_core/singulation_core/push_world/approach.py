"""How far a pusher can go before it touches a block."""

import numpy as np
import pymunk

from singulation_core.polygon import FloatArray
from singulation_core.push_world.space import BLOCKS_ONLY
from singulation_core.push_world.sweep import free_travel


def free_share(space: pymunk.Space, pusher: pymunk.Body, way: FloatArray) -> float:
    """Share (0..1) of the straight ``way`` (2,), not zero, that the pusher can go until it touches a block."""
    length = float(np.hypot(way[0], way[1]))
    ways = [length]
    for shape in pusher.shapes:
        if isinstance(shape, pymunk.Circle):
            ways.append(length * _disc_share(space, pusher.local_to_world(shape.offset), shape.radius, way))
        elif isinstance(shape, pymunk.Poly):
            ways.append(free_travel(_corners(shape, pusher), _in_the_way(space, shape, way), way / length))
    return max(0.0, min(ways)) / length


def _disc_share(space: pymunk.Space, centre: pymunk.Vec2d, radius: float, way: FloatArray) -> float:
    hit = space.segment_query_first(centre, centre + (float(way[0]), float(way[1])), radius, BLOCKS_ONLY)
    return 1.0 if hit is None else hit.alpha


def _corners(shape: pymunk.Poly, body: pymunk.Body) -> FloatArray:
    return np.array([body.local_to_world(vertex) for vertex in shape.get_vertices()])


def _in_the_way(space: pymunk.Space, shape: pymunk.Poly, way: FloatArray) -> list[FloatArray]:
    """Outlines of the blocks near enough to be met."""
    here, (x, y) = shape.cache_bb(), way.tolist()
    swept = here.merge(pymunk.BB(here.left + x, here.bottom + y, here.right + x, here.top + y))
    near = space.bb_query(swept, BLOCKS_ONLY)
    return [_corners(one, one.body) for one in near if isinstance(one, pymunk.Poly) and one.body is not None]
