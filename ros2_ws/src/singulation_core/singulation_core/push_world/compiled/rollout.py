"""Pushes from start to end."""

import numpy as np

from singulation_core.jit import compiled, compiled_inline, compiled_part
from singulation_core.polygon import FloatArray
from singulation_core.push_world.compiled.island import find_contacts, pusher_gap
from singulation_core.push_world.compiled.manifold import place, separation
from singulation_core.push_world.compiled.solver import remember, solve, warm_start
from singulation_core.push_world.compiled.types import Contacts, IntArray, Numbers, Scratch, Shapes, State

DONE, BLOCKED, DIVERGED = 0, 1, 2
_ARRIVED = 1e-12  # what is left of the way then is a rounding error


@compiled
def roll_out_many(
    shapes: Shapes,
    state: State,
    contacts: Contacts,
    scratch: Scratch,
    numbers: Numbers,
    origins: FloatArray,
    unit: float,
    starts: FloatArray,
    ends: FloatArray,
    poses: FloatArray,
    codes: IntArray,
) -> None:
    """All pushes of one scene, each from the first poses.

    Args:
        shapes, state, contacts, scratch, numbers: see their classes.
        origins: (n, 3) first poses of the blocks, in inner units.
        unit: length of an inner unit [m].
        starts, ends: (m, 2) of the pusher [m].
        poses: (m, n, 3) written: x, y [m], turn [rad]; NaN where not done.
        codes: (m,) written: ``DONE``, ``BLOCKED`` or ``DIVERGED``.
    """
    for k in range(len(starts)):
        x, y = starts[k, 0] / unit, starts[k, 1] / unit
        wx, wy = (ends[k, 0] - starts[k, 0]) / unit, (ends[k, 1] - starts[k, 1]) / unit
        heading = np.arctan2(wy, wx)
        _begin(shapes, state, origins, x, y, heading)
        codes[k] = _roll_out(shapes, state, contacts, scratch, numbers, np.hypot(wx, wy))
        c, s = np.cos(heading), np.sin(heading)
        for body in range(len(origins)):
            px, py, turn = state.poses[body, 0], state.poses[body, 1], state.poses[body, 2]
            if codes[k] != DONE:
                px, py, turn = np.nan, np.nan, np.nan
            poses[k, body, 0], poses[k, body, 1] = (x + c * px - s * py) * unit, (y + s * px + c * py) * unit
            poses[k, body, 2] = turn + heading


@compiled
def measure_overlaps(shapes: Shapes, state: State, origins: FloatArray) -> None:
    """Note how deep blocks overlap at first: such pairs count as touching."""
    _begin(shapes, state, origins, 0.0, 0.0, 0.0)
    for one in range(len(origins)):
        for other in range(one):
            dx, dy = origins[one, 0] - origins[other, 0], origins[one, 1] - origins[other, 1]
            if np.hypot(dx, dy) < shapes.radii[one] + shapes.radii[other]:
                deep = max(0.0, -separation(shapes, state, one, other, 0.0)[0])
                state.slack[one, other], state.slack[other, one] = deep, deep


@compiled
def part_overlaps(shapes: Shapes, state: State, origins: FloatArray, sweeps: int) -> None:
    """Move blocks in ``origins`` straight apart until none overlap, or ``sweeps`` times over all pairs."""
    _begin(shapes, state, origins, 0.0, 0.0, 0.0)
    for _ in range(sweeps):
        parted = True
        for one in range(len(origins)):
            for other in range(one):
                dx, dy = origins[other, 0] - origins[one, 0], origins[other, 1] - origins[one, 1]
                if np.hypot(dx, dy) >= shapes.radii[one] + shapes.radii[other]:
                    continue
                gap, edge = separation(shapes, state, one, other, 0.0)
                if gap >= -1e-6:
                    continue
                way = -0.5 * gap if shapes.firsts[one] <= edge < shapes.firsts[one + 1] else 0.5 * gap
                x, y = way * state.outward[edge, 0], way * state.outward[edge, 1]
                _shift(shapes, state, origins, other, x, y)
                _shift(shapes, state, origins, one, -x, -y)
                parted = False
        if parted:
            return


@compiled_part
def _shift(shapes: Shapes, state: State, origins: FloatArray, body: int, x: float, y: float) -> None:
    for poses in (origins, state.poses):
        poses[body, 0] += x
        poses[body, 1] += y
    place(shapes, state, body)


@compiled_part
def _begin(shapes: Shapes, state: State, origins: FloatArray, x: float, y: float, heading: float) -> None:
    """Everything at its first pose, in the frame of a push from (x, y) along ``heading``."""
    n = len(origins)
    c, s = np.cos(heading), np.sin(heading)
    for body in range(n + 1):
        dx, dy, angle = 0.0, 0.0, 0.0
        if body < n:
            dx, dy, angle = origins[body, 0] - x, origins[body, 1] - y, origins[body, 2] - heading
        state.poses[body, 0], state.poses[body, 1], state.poses[body, 2] = c * dx + s * dy, c * dy - s * dx, angle
        place(shapes, state, body)
        for other in range(n + 1):
            state.axes[body, other] = -1
            for slot in range(2):
                state.memory[body, other, slot, 0] = -1.0


@compiled_part
def _roll_out(
    shapes: Shapes, state: State, contacts: Contacts, scratch: Scratch, numbers: Numbers, length: float
) -> int:
    """One push, after ``_begin``; the poses are left in ``state``."""
    back = _moved_back(shapes, state, numbers)
    if back < 0.0:
        return BLOCKED
    n, left, found, settling = len(shapes.radii) - 1, length + back, 0, numbers.settle_steps
    while left > _ARRIVED or settling > 0:
        gap = _nearest(shapes, state) if found == 0 else 0.0
        if left > _ARRIVED and gap > 1.5 * numbers.step:  # nothing to push yet: jump
            jump = min(gap - 0.5 * numbers.step, left)
            state.poses[n, 0] += jump
            left -= jump
            place(shapes, state, n)
            continue
        advance = min(numbers.step, left) if left > _ARRIVED else 0.0
        left -= advance
        settling -= 1 if advance == 0.0 else 0
        found = _step(shapes, state, contacts, scratch, numbers, advance)
    for body in range(n):
        if not (abs(state.poses[body, 0]) + abs(state.poses[body, 1]) + abs(state.poses[body, 2]) < 1e6):
            return DIVERGED
    return DONE


@compiled_part
def _moved_back(shapes: Shapes, state: State, numbers: Numbers) -> float:
    """Move a pusher that would start on a block back until it is free; how far, negative if that is too far."""
    n, back = len(shapes.radii) - 1, 0.0
    while _nearest(shapes, state) < -numbers.touching:
        if back >= numbers.retreat:
            return -1.0
        state.poses[n, 0] -= 0.5 * numbers.step
        back += 0.5 * numbers.step
        place(shapes, state, n)
    return back


@compiled_part
def _nearest(shapes: Shapes, state: State) -> float:
    """Gap between the pusher and the nearest block."""
    gap = np.inf
    for body in range(len(shapes.radii) - 1):
        gap = min(gap, pusher_gap(shapes, state, body, gap))
    return gap


@compiled_inline
def _step(shapes: Shapes, state: State, contacts: Contacts, scratch: Scratch, numbers: Numbers, advance: float) -> int:
    """Move the pusher by ``advance`` and the blocks with it; how many blocks are in contact."""
    n = len(shapes.radii) - 1
    found = find_contacts(shapes, state, contacts, scratch, 1.5 * advance + numbers.slop)
    for k in range(1, found):
        for axis in range(3):
            state.motion[scratch.island[0, k], axis] = 0.0
    state.motion[n, 0], state.motion[n, 1], state.motion[n, 2] = advance, 0.0, 0.0
    if advance > 0.0:
        warm_start(shapes, state, contacts)
    solve(shapes, state, contacts, numbers, numbers.healing if advance > 0.0 else numbers.healing_at_rest)
    remember(state, contacts)
    for k in range(found):
        _move(shapes, state, scratch.island[0, k])
    return found - 1


@compiled_part
def _move(shapes: Shapes, state: State, body: int) -> None:
    x, y, turn = state.motion[body, 0], state.motion[body, 1], state.motion[body, 2]
    if x != 0.0 or y != 0.0 or turn != 0.0:
        state.poses[body, 0] += x
        state.poses[body, 1] += y
        state.poses[body, 2] += turn
        place(shapes, state, body)
