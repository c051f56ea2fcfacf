"""Choosing the contact mode by simulation."""

from dataclasses import replace
from typing import NamedTuple, Protocol

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


class Planned(NamedTuple):
    """A push and its value by the policy's own simulation; NaN if it has none."""

    push: Push
    value: float


class Plan(Protocol):
    """Plans for a contact mode, spending no more than a share of the policy's budget."""

    def __call__(self, with_mode: ContactMode, share: float = 1.0) -> Planned: ...


def best_of_modes(
    plan: Plan,
    first: ContactMode,
    scene: Scene,
    pusher: PusherGeometry,
    physics: PushPhysics | None,
) -> Push:
    """The best of the pushes planned for the three contact modes: by the policy's values, or else by simulation.

    A wide pusher fits in fewer places, but where it fits the object slips away less; which of the two counts more
    depends on the scene.

    Raises:
        SingulationError: of mode ``first``, if no mode has a push.
    """
    planned, failure = [], None
    for mode in (first, *(other for other in ContactMode if other != first)):
        try:
            planned.append(plan(mode, 1.0 / len(ContactMode)))
        except SingulationError as error:
            if error.code is not ResultCode.NO_PUSH:
                raise
            failure = failure or error
    if failure is not None and not planned:
        raise failure
    values = np.array([one.value for one in planned])
    if np.isfinite(values).any():
        return planned[int(np.nanargmax(values))].push
    pushes = [one.push for one in planned]
    changes = simulate_pushes(scene.in_order(), pushes, physics, pusher).gains()
    best = int(np.argmax(np.nan_to_num(changes, nan=-np.inf)))
    return replace(pushes[best], expected_gain=relative_gain(float(changes[best]), scene.in_order()))
