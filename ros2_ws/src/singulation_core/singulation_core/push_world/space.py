"""Blocks and pushers as bodies of a pymunk space. Lengths are inner units (mean bounding radii)."""

import math
from typing import NamedTuple

import numpy as np
import pymunk

from singulation_core.arrangement import Arrangement
from singulation_core.polygon import FloatArray
from singulation_core.push_world.footprint import Footprint
from singulation_core.push_world.physics import PushPhysics

PUSHER_FILTER = pymunk.ShapeFilter(group=1, categories=0b10)  # one group: jaws do not collide with each other
BLOCKS_ONLY = pymunk.ShapeFilter(mask=0b01)
_BLOCK_FILTER = pymunk.ShapeFilter(categories=0b01)


class Block(NamedTuple):
    """An object of the arrangement in the space."""

    id: int
    body: pymunk.Body
    shape: pymunk.Poly


def new_space(physics: PushPhysics, count: int) -> pymunk.Space:
    """An empty table top for ``count`` blocks."""
    space = pymunk.Space()
    # A hash keeps no memory of earlier steps, a tree does: the order of contacts, and with it the result, would depend
    # on the pushes simulated before.
    space.use_spatial_hash(2.0, 4 * count + 8)
    seconds = physics.seconds_per_step
    space.iterations = physics.iterations
    # Chipmunk raises both to the power of dt; given per step here, so that they do not depend on the step.
    space.damping = physics.velocity_kept ** (1.0 / seconds)
    space.collision_bias = (1.0 - physics.overlap_correction) ** (1.0 / seconds)
    space.collision_slop = physics.slop
    return space


def add_blocks(space: pymunk.Space, arrangement: Arrangement, unit: float, physics: PushPhysics) -> list[Block]:
    """One dynamic body for each object, its origin at the area centroid, unturned, at the origin of the space."""
    densities = physics.densities(len(arrangement))
    blocks = []
    for item, density in zip(arrangement.objects, densities, strict=True):
        vertices = ((item.outline - item.centroid) / unit).tolist()
        mass = density * item.area / unit**2
        body = pymunk.Body(mass, pymunk.moment_for_poly(mass, vertices))
        shape = pymunk.Poly(body, vertices)
        shape.friction = contact_friction(physics)
        shape.filter = _BLOCK_FILTER
        space.add(body, shape)
        blocks.append(Block(item.id, body, shape))
    return blocks


def pusher_body(footprint: Footprint, unit: float, physics: PushPhysics) -> tuple[pymunk.Body, list[pymunk.Shape]]:
    """A body whose motion is prescribed, with the shapes of the footprint."""
    body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    shapes: list[pymunk.Shape] = [
        pymunk.Circle(body, one.radius / unit, (one.x / unit, one.y / unit)) for one in footprint.discs
    ]
    shapes += [pymunk.Poly(body, (one / unit).tolist()) for one in footprint.polygons]
    for shape in shapes:
        shape.friction = contact_friction(physics)
        shape.filter = PUSHER_FILTER
    return body, shapes


def corners(shape: pymunk.Poly, body: pymunk.Body) -> FloatArray:
    """(k, 2) vertices in the space, counter-clockwise."""
    return np.array([body.local_to_world(vertex) for vertex in shape.get_vertices()])


def contact_friction(physics: PushPhysics) -> float:
    """Chipmunk multiplies the coefficients of the two shapes in a contact."""
    return math.sqrt(physics.friction)


def block_poses(blocks: list[Block]) -> FloatArray:
    """(n, 3) x, y, angle of the blocks."""
    return np.array([(*block.body.position, block.body.angle) for block in blocks], dtype=np.float64).reshape(-1, 3)
