"""Simulators that planned pushes are judged in: fine pymunk, Box2D, and fine pymunk with noise."""

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np
from benchmarks.rollout.plans import SETTING, Judge
from benchmarks.rollout.table_in_box2d import simulate_in_box2d

from singulation_core import Arrangement, Push, ResultCode, SingulationError, singulation_distance
from singulation_core.polygon import FloatArray
from singulation_core.push_world import PushPhysics, simulate_push
from singulation_planner.benchmark.scenario import Scenario

_SHIFT, _TURN, _FRICTION = 0.05, 0.05, 0.1  # standard deviations: bounding radii, rad, of friction
_WORLDS = 12
_BACK, _FURTHEST = 0.05, 1.0  # a start on a block is moved back in such steps, at most so far [bounding radii]


def in_pymunk(scenario: Scenario, push: Push) -> float:
    """s' - s by the fine preset."""
    return _gain(scenario.arrangement, simulate_push(scenario.arrangement, push, PushPhysics.fine(), SETTING.pusher))


def in_box2d(scenario: Scenario, push: Push) -> float:
    """s' - s by Box2D."""
    return _gain(scenario.arrangement, simulate_in_box2d(scenario.arrangement, push, SETTING.pusher))


def with_noise(scenario: Scenario, push: Push) -> float:
    """Mean s' - s over 12 worlds, the same for every planner, that perception could have seen as this scene.

    Blocks are shifted and turned, then moved apart where they overlap; friction differs; a pusher that would start on
    a block is moved back until it is free and goes to the same end.
    """
    return _mean_gain(scenario, push, _FURTHEST)


def or_nothing(scenario: Scenario, push: Push) -> float:
    """As ``with_noise``, but where the pusher would come down on a block nothing is gained."""
    return _mean_gain(scenario, push, 0.0)


JUDGES: Mapping[str, Judge] = {
    "pymunk": in_pymunk,
    "box2d": in_box2d,
    "noise": with_noise,
    "noise_or_nothing": or_nothing,
}


def _mean_gain(scenario: Scenario, push: Push, furthest: float) -> float:
    gains = []
    for world, friction in _true_worlds(scenario):
        physics = replace(PushPhysics.fine(), friction=friction)
        gains.append(_gain_moved_back(world, push, physics, scenario.unit, furthest))
    return float(np.mean(gains))


def _gain(before: Arrangement, after: Arrangement) -> float:
    return singulation_distance(after, 1.0) - singulation_distance(before, 1.0)


@lru_cache(maxsize=1)
def _true_worlds(scenario: Scenario) -> list[tuple[Arrangement, float]]:
    """Worlds and their friction."""
    random = np.random.default_rng((scenario.n, scenario.group, scenario.seed, 1))
    worlds = []
    for _ in range(_WORLDS):
        objects = []
        for item in scenario.arrangement.objects:
            shift = _SHIFT * scenario.unit * random.standard_normal(2)
            objects.append(item.moved(shift, _TURN * random.standard_normal()))
        friction = max(0.05, 0.5 + _FRICTION * random.standard_normal())
        worlds.append((apart(Arrangement(objects)), friction))
    return worlds


def apart(arrangement: Arrangement) -> Arrangement:
    """The blocks moved straight apart until none overlap."""
    objects = list(arrangement.objects)
    for _ in range(100):
        moved = False
        for i in range(len(objects)):
            for j in range(i):
                reach = objects[i].bounding_radius + objects[j].bounding_radius
                if np.hypot(*(objects[i].centroid - objects[j].centroid)) >= reach:
                    continue
                way = _overlap(objects[i].outline, objects[j].outline)
                if way is not None:
                    objects[i], objects[j] = objects[i].moved(-0.5 * way), objects[j].moved(0.5 * way)
                    moved = True
        if not moved:
            break
    return Arrangement(objects, arrangement.frame, arrangement.stamp)


def _overlap(first: FloatArray, second: FloatArray) -> FloatArray | None:
    """The shortest way of the second outline out of the first; None if they do not overlap."""
    best, way = np.inf, None
    for own, other, sign in ((first, second, 1.0), (second, first, -1.0)):
        edges = np.roll(own, -1, axis=0) - own
        normals = np.column_stack((edges[:, 1], -edges[:, 0])) / np.hypot(edges[:, 0], edges[:, 1])[:, None]
        depths = ((own * normals).sum(axis=1)[:, None] - normals @ other.T).max(axis=1)
        k = int(depths.argmin())
        if depths[k] <= 1e-7:
            return None
        if depths[k] < best:
            best, way = float(depths[k]), sign * (depths[k] + 1e-7) * normals[k]
    return way


def _gain_moved_back(world: Arrangement, push: Push, physics: PushPhysics, unit: float, furthest: float) -> float:
    for step in range(round(furthest / _BACK) + 1):
        moved = replace(push, start=push.start - step * _BACK * unit * push.direction)
        try:
            return _gain(world, simulate_push(world, moved, physics, SETTING.pusher))
        except SingulationError as error:
            if error.code is not ResultCode.PATH_BLOCKED:
                raise
    return 0.0  # nowhere to put the jaws down: nothing is pushed
