"""``plan_push``: from an arrangement to the push that a policy would do."""

import math
from dataclasses import replace
from typing import Any

from numpy.typing import ArrayLike

from singulation_core import (
    Arrangement,
    ContactMode,
    InvalidInputError,
    Push,
    PusherGeometry,
    ResultCode,
    SingulationError,
    smallest_gap,
)
from singulation_core import contact_mode as as_contact_mode
from singulation_core.polygon import FloatArray
from singulation_core.push_world.physics import PushPhysics
from singulation_planner.best_mode import Planned, best_of_modes
from singulation_planner.candidates import Candidates
from singulation_planner.placement import Placement, clearance_of, with_room
from singulation_planner.placer import make_placer
from singulation_planner.policies import find_policy
from singulation_planner.policy import Policy, Task
from singulation_planner.scene import OVERLAP_TOLERANCE, Scene
from singulation_planner.workspace import workspace_walls

# Travel after contact in mean bounding radii. The paper does not give it; its tables fit 0.7 to 1.
PUSH_DISTANCE_FACTOR = 1.0
_PUSHER, _PLACEMENT = PusherGeometry(), Placement()


def plan_push(
    arrangement: Arrangement,
    policy: str = "cluster_push",
    contact_mode: ContactMode | int | str = ContactMode.SINGLE_POINT,
    push_distance: float | None = None,
    pusher: PusherGeometry = _PUSHER,
    workspace: ArrayLike | None = None,
    seed: int = 0,
    placement: Placement = _PLACEMENT,
    push_distance_factor: float = PUSH_DISTANCE_FACTOR,
    best_contact_mode: bool = False,
    physics: PushPhysics | None = None,
    min_gap: float | None = None,
    overlap_tolerance: float = OVERLAP_TOLERANCE,
    **options: Any,
) -> Push:
    """The push that a policy plans for an arrangement.

    The policy ranks candidates (push object, direction, line); the first one that the pusher can perform is taken:
    the pusher is free at its start, start and end lie in the workspace, and no object is carried over its edge.

    Args:
        arrangement: at least two objects.
        policy: one of ``POLICIES``.
        contact_mode: how the jaws touch.
        push_distance: travel from start to end [m]; None: the clearance at the start and
            ``push_distance_factor`` mean bounding radii.
        pusher: footprint of the jaws.
        workspace: (k, 2) convex, counter-clockwise polygon in the frame of the arrangement [m]; None: unbounded.
        seed: of what is random in a policy; the same input and seed give the same push.
        placement: how starts are chosen and what counts as reachable.
        push_distance_factor: see ``push_distance``.
        best_contact_mode: plan for each of the three contact modes, simulate their pushes, return the best;
            ``contact_mode`` is then only the first one tried, which wins ties.
        physics: of policies and choices that simulate; None: ``PushPhysics.quasi_static()``.
        min_gap: nothing is to do if all objects are at least this far apart [m]; None: they may always be pushed.
        overlap_tolerance: depth of an overlap that is taken for noise, in units of the smaller bounding radius.
        **options: of the policy, see its module.

    Returns:
        The push; ``expected_gain`` is NaN unless the policy simulates, and so is ``expected`` None.

    Raises:
        SingulationError: ``NOTHING_TO_DO``, ``NO_PUSH`` (with the number of candidates refused for each reason),
            ``UNKNOWN_POLICY``, ``UNKNOWN_CONTACT_MODE``, ``OUTSIDE_WORKSPACE``, ``OVERLAPPING_OBJECTS`` or
            ``INVALID_INPUT``.
    """
    chosen, mode = find_policy(policy), as_contact_mode(contact_mode)
    settings = chosen.read_options(options)
    scene = Scene.of(arrangement, overlap_tolerance)
    _refuse_separated(arrangement, min_gap)
    walls = workspace_walls(workspace, scene)

    def push_from(place: Placement) -> Push:
        travel = _travel(push_distance, push_distance_factor * scene.scale, clearance_of(place, pusher))

        def plan(with_mode: ContactMode, share: float = 1.0) -> Planned:
            placer = make_placer(scene, with_mode, travel, pusher, place, walls)
            return _first_push(chosen, Task(scene, placer, seed, physics, share), settings)

        return best_of_modes(plan, mode, scene, pusher, physics) if best_contact_mode else plan(mode).push

    roomy = with_room(placement, pusher, getattr(settings, "start_room", 0.0) * scene.scale)
    try:
        return push_from(roomy)
    except SingulationError as error:
        if roomy is placement or error.code is not ResultCode.NO_PUSH:
            raise
    return push_from(placement)


def _refuse_separated(arrangement: Arrangement, min_gap: float | None) -> None:
    if min_gap is None:
        return
    gap = smallest_gap(arrangement)
    if gap >= min_gap:
        raise SingulationError(
            ResultCode.NOTHING_TO_DO, f"all objects are at least {gap:.4g} m apart, asked for were {min_gap:.4g} m"
        )


def _travel(push_distance: float | None, after_contact: float, clearance: float) -> float:
    travel = clearance + after_contact if push_distance is None else push_distance
    if not (0.0 < travel < math.inf):
        raise InvalidInputError(f"push distance {travel} m, need a finite positive length")
    return float(travel)


def _first_push(policy: Policy, task: Task, settings: Any) -> Planned:
    placer = task.placer
    for candidates in policy.rank(task, settings):
        found = placer.first_feasible(candidates)
        if found is not None:
            return _planned(policy, task, candidates, *found)
    raise SingulationError(ResultCode.NO_PUSH, f"{policy.name}: no push is possible: {placer.why_none()}")


def _planned(policy: Policy, task: Task, candidates: Candidates, index: int, start: FloatArray) -> Planned:
    gain = math.nan if candidates.gains is None else float(candidates.gains[index])
    target = int(candidates.objects[index])
    push = task.placer.push(target, start, candidates.directions[index], policy.name, gain)
    if candidates.poses is not None:
        push = replace(push, expected=task.scene.displaced(candidates.poses[index]))
    return Planned(push, math.nan if candidates.values is None else float(candidates.values[index]))
