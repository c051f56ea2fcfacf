"""A push simulated by Box2D, quasi-statically: an engine that shares nothing with those of the project.

Not a dependency of the suite: ``pip install -r requirements/benchmarks.txt``.
"""

import importlib
import math
from typing import Any

import numpy as np

from singulation_core import Arrangement, Push, PusherGeometry
from singulation_core.polygon import FloatArray
from singulation_core.push_world import Footprint, pusher_footprint
from singulation_core.push_world.displaced import displaced

_STEP, _ITERATIONS, _FRICTION = 0.02, 20, 0.5  # bounding radii, velocity iterations
_MOST_VERTICES = 16  # of one Box2D polygon


def simulate_in_box2d(arrangement: Arrangement, push: Push, pusher: PusherGeometry) -> Arrangement:
    """The arrangement after a push; every step starts at rest, which is table friction in the quasi-static limit."""
    box2d = importlib.import_module("Box2D")
    unit = float(arrangement.bounding_radii.mean())
    world = box2d.b2World(gravity=(0.0, 0.0), doSleep=False)
    world.warmStarting = True
    heading = math.atan2(*push.direction[::-1].tolist())
    blocks = [_block(box2d, world, item.outline - item.centroid, item.centroid, unit) for item in arrangement.objects]
    jaws = _jaws(box2d, world, pusher_footprint(push, pusher), push.start, heading, unit)
    steps = math.ceil(push.length / unit / _STEP)
    velocity = push.direction * push.length / unit / steps
    for _ in range(steps):
        jaws.linearVelocity = velocity.tolist()
        _step(world, blocks)
    centroids = np.array([tuple(body.position) for body in blocks]) * unit
    return displaced(arrangement, np.column_stack((centroids, [body.angle for body in blocks])))


def _step(world: Any, blocks: list[Any]) -> None:
    world.Step(1.0, _ITERATIONS, 10)
    for body in blocks:
        body.linearVelocity, body.angularVelocity = (0.0, 0.0), 0.0


def _block(box2d: Any, world: Any, outline: FloatArray, centroid: FloatArray, unit: float) -> Any:
    body = world.CreateDynamicBody(position=(centroid / unit).tolist(), allowSleep=False)
    for part in _parts(outline / unit):
        shape = box2d.b2PolygonShape(vertices=[tuple(point) for point in part.tolist()])
        shape.radius = 0.0
        body.CreateFixture(shape=shape, density=1.0, friction=_FRICTION)
    return body


def _parts(outline: FloatArray) -> list[FloatArray]:
    """The outline, cut where it has more vertices than Box2D takes."""
    if len(outline) <= _MOST_VERTICES:
        return [outline]
    half = len(outline) // 2
    return [*_parts(outline[: half + 1]), *_parts(np.vstack((outline[half:], outline[:1])))]


def _jaws(box2d: Any, world: Any, jaws: Footprint, start: FloatArray, heading: float, unit: float) -> Any:
    body = world.CreateKinematicBody(position=(start / unit).tolist(), angle=heading)
    for disc in jaws.discs:
        shape = box2d.b2CircleShape(pos=(disc.x / unit, disc.y / unit), radius=disc.radius / unit)
        body.CreateFixture(shape=shape, friction=_FRICTION)
    for one in jaws.polygons:
        shape = box2d.b2PolygonShape(vertices=[tuple(point) for point in (one / unit).tolist()])
        shape.radius = 0.0
        body.CreateFixture(shape=shape, friction=_FRICTION)
    return body
