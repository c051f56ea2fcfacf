"""Which blocks move with the pusher, and where they touch."""

import numpy as np

from singulation_core.jit import compiled_inline, compiled_part
from singulation_core.push_world.compiled.manifold import disc_contact, polygon_contacts, separation
from singulation_core.push_world.compiled.solver import add_contact
from singulation_core.push_world.compiled.types import Contacts, Scratch, Shapes, State

_FOUND, _COMPLETE = 1, 2


@compiled_part
def pusher_gap(shapes: Shapes, state: State, body: int, enough: float) -> float:
    """Gap between the pusher and a block, or something larger than ``enough`` if it is."""
    n = len(shapes.radii) - 1
    x, y = state.poses[n, 0], state.poses[n, 1]
    rough = np.hypot(state.poses[body, 0] - x, state.poses[body, 1] - y) - shapes.radii[body] - shapes.radii[n]
    if rough > enough:
        return float(rough)
    gap = np.inf
    for k in range(len(shapes.discs)):
        dx, dy, radius = shapes.discs[k, 0], shapes.discs[k, 1], shapes.discs[k, 2]
        gap = min(gap, disc_contact(shapes, state, body, x + dx, y + dy, radius)[0])
    if shapes.firsts[n + 1] > shapes.firsts[n]:
        gap = min(gap, separation(shapes, state, body, n, enough)[0])
    return gap


@compiled_inline
def find_contacts(shapes: Shapes, state: State, contacts: Contacts, scratch: Scratch, margin: float) -> int:
    """Contacts of all blocks that the pusher touches, directly or through others; how many shapes these are.

    The pusher itself is the first of them.
    """
    n = len(shapes.radii) - 1
    island = scratch.island
    contacts.total[0] = 0
    for body in range(n):
        island[1, body] = 0
    island[0, 0], looked, found = n, 0, 1
    while looked < found:
        one = island[0, looked]
        looked += 1
        island[1, one] = _COMPLETE
        for other in range(n):
            if island[1, other] == _COMPLETE or not _near(shapes, state, one, other, margin):
                continue
            if _contacts_of(shapes, state, contacts, scratch, one, other, margin) and island[1, other] != _FOUND:
                island[0, found], island[1, other] = other, _FOUND
                found += 1
    return found


@compiled_inline
def _near(shapes: Shapes, state: State, one: int, other: int, margin: float) -> bool:
    reach = shapes.radii[one] + shapes.radii[other] + margin
    dx, dy = state.poses[one, 0] - state.poses[other, 0], state.poses[one, 1] - state.poses[other, 1]
    return bool(dx * dx + dy * dy <= reach * reach)


@compiled_inline
def _contacts_of(
    shapes: Shapes, state: State, contacts: Contacts, scratch: Scratch, one: int, other: int, margin: float
) -> bool:
    """Add the contacts of two shapes, the first of which may be the pusher; whether there are any."""
    n, before = len(shapes.radii) - 1, contacts.total[0]
    first, second = (other, n) if one == n else (one, other)  # the normal points to the pusher
    if one == n:
        _disc_contacts(shapes, state, contacts, scratch, other, margin)
    if shapes.firsts[one + 1] > shapes.firsts[one]:
        _pair_contacts(shapes, state, contacts, scratch, first, second, margin)
    return bool(contacts.total[0] > before)


@compiled_inline
def _disc_contacts(
    shapes: Shapes, state: State, contacts: Contacts, scratch: Scratch, body: int, margin: float
) -> None:
    """Add the contacts of a block with the round parts of the pusher."""
    n, met = len(shapes.radii) - 1, 0
    x, y = state.poses[n, 0], state.poses[n, 1]
    for k in range(len(shapes.discs)):
        dx, dy, radius = shapes.discs[k, 0], shapes.discs[k, 1], shapes.discs[k, 2]
        gap, nx, ny, key = disc_contact(shapes, state, body, x + dx, y + dy, radius)
        if gap <= margin:
            point = scratch.points[0]
            point[0], point[1], point[2], point[3] = x + dx - nx * radius, y + dy - ny * radius, gap, key + 1e8 * k
            scratch.normal[0], scratch.normal[1] = nx, ny
            add_contact(shapes, state, contacts, body, n, min(met, 1), point, scratch.normal)
            met += 1


@compiled_inline
def _pair_contacts(
    shapes: Shapes, state: State, contacts: Contacts, scratch: Scratch, one: int, other: int, margin: float
) -> None:
    """Add the contacts of two polygons."""
    limit = margin - state.slack[one, other]
    count, swapped, nx, ny = polygon_contacts(shapes, state, one, other, limit, scratch.points)
    sign = -1.0 if swapped == 1 else 1.0
    scratch.normal[0], scratch.normal[1] = sign * nx, sign * ny
    for k in range(count):
        add_contact(shapes, state, contacts, one, other, k, scratch.points[k], scratch.normal)
