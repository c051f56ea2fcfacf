"""Choosing the contact mode by simulation."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from singulation_core import (
    Arrangement,
    ContactMode,
    Push,
    PusherGeometry,
    ResultCode,
    SingulationError,
    singulation_distance,
)
from singulation_core.polygon import FloatArray
from singulation_core.push_world import PushPhysics, simulate_pushes
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
    changes = simulated_changes(scene.arrangement, pushes, pusher, physics)
    best = int(np.argmax(np.nan_to_num(changes, nan=-np.inf)))
    return replace(pushes[best], expected_gain=relative_gain(float(changes[best]), scene.arrangement))


def simulated_changes(
    arrangement: Arrangement, pushes: Sequence[Push], pusher: PusherGeometry, physics: PushPhysics | None
) -> FloatArray:
    """(m,) s' - s of each push; NaN where the simulation failed."""
    return simulate_pushes(arrangement, pushes, physics, pusher).gains()


def relative_gain(change: float, arrangement: Arrangement) -> float:
    """(s' - s) / s, with lengths in mean bounding radii of the arrangement; NaN if s is 0."""
    present = singulation_distance(arrangement)
    return change / present if present != 0.0 else float("nan")
