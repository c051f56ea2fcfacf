"""Choosing the contact mode by simulation."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from singulation_core import (
    ContactMode,
    Push,
    PusherGeometry,
    ResultCode,
    SingulationError,
)
from singulation_core.push_world import PushPhysics, simulate_pushes
from singulation_planner.rollouts import relative_gain
from singulation_planner.scene import Scene


def best_of_modes(
    plan: Callable[[ContactMode], Push],
    first: ContactMode,
    scene: Scene,
    pusher: PusherGeometry,
    physics: PushPhysics | None,
) -> Push:
    """The best of the pushes planned for the three contact modes, by simulation.

    A wide pusher fits in fewer places, but where it fits the object slips away less; which of the two counts more
    depends on the scene.

    Raises:
        SingulationError: of mode ``first``, if no mode has a push.
    """
    pushes, failure = [], None
    for mode in (first, *(other for other in ContactMode if other != first)):
        try:
            pushes.append(plan(mode))
        except SingulationError as error:
            if error.code is not ResultCode.NO_PUSH:
                raise
            failure = failure or error
    if failure is not None and not pushes:
        raise failure
    changes = simulate_pushes(scene.in_order(), pushes, physics, pusher).gains()
    best = int(np.argmax(np.nan_to_num(changes, nan=-np.inf)))
    return replace(pushes[best], expected_gain=relative_gain(float(changes[best]), scene.in_order()))
