"""Motion of the blocks in one step: least kinetic energy under contacts with friction (projected Gauss-Seidel)."""

from singulation_core.jit import compiled_inline, compiled_part
from singulation_core.polygon import FloatArray
from singulation_core.push_world.compiled.types import Contacts, Numbers, Shapes, State

_STILL = 1e-4  # inner units; the solver stops when no contact corrects more


@compiled_inline
def add_contact(
    shapes: Shapes,
    state: State,
    contacts: Contacts,
    first: int,
    second: int,
    slot: int,
    point: FloatArray,
    normal: FloatArray,
) -> None:
    """Append a contact: point x, y, gap, key; normal from the first to the second body."""
    c = contacts.total[0]
    if c >= len(contacts.gap):
        return
    contacts.total[0] = c + 1
    nx, ny = normal[0], normal[1]
    ax, ay = point[0] - state.poses[first, 0], point[1] - state.poses[first, 1]
    bx, by = point[0] - state.poses[second, 0], point[1] - state.poses[second, 1]
    contacts.bodies[c, 0], contacts.bodies[c, 1], contacts.bodies[c, 2] = first, second, slot
    contacts.normal[c, 0], contacts.normal[c, 1] = nx, ny
    contacts.arms[c, 0], contacts.arms[c, 1], contacts.arms[c, 2], contacts.arms[c, 3] = ax, ay, bx, by
    contacts.gap[c], contacts.key[c] = point[2] + state.slack[first, second], point[3]
    shift = shapes.mobility[first, 0] + shapes.mobility[second, 0]
    turn_a, turn_b = shapes.mobility[first, 1], shapes.mobility[second, 1]
    across_a, across_b = ax * ny - ay * nx, bx * ny - by * nx
    along_a, along_b = ax * nx + ay * ny, bx * nx + by * ny
    contacts.resistance[c, 0] = 1.0 / (shift + turn_a * across_a * across_a + turn_b * across_b * across_b)
    contacts.resistance[c, 1] = 1.0 / (shift + turn_a * along_a * along_a + turn_b * along_b * along_b)
    contacts.impulse[c, 0], contacts.impulse[c, 1] = 0.0, 0.0


@compiled_part
def _push_apart(shapes: Shapes, state: State, contacts: Contacts, c: int, along: float, aside: float) -> None:
    """Apply an impulse along the normal and along the tangent (normal turned left) of a contact."""
    first, second = contacts.bodies[c, 0], contacts.bodies[c, 1]
    nx, ny = contacts.normal[c, 0], contacts.normal[c, 1]
    jx, jy = along * nx - aside * ny, along * ny + aside * nx
    ax, ay, bx, by = contacts.arms[c, 0], contacts.arms[c, 1], contacts.arms[c, 2], contacts.arms[c, 3]
    motion, mobility = state.motion, shapes.mobility
    motion[first, 0] -= mobility[first, 0] * jx
    motion[first, 1] -= mobility[first, 0] * jy
    motion[first, 2] -= mobility[first, 1] * (ax * jy - ay * jx)
    motion[second, 0] += mobility[second, 0] * jx
    motion[second, 1] += mobility[second, 0] * jy
    motion[second, 2] += mobility[second, 1] * (bx * jy - by * jx)


@compiled_part
def _slip(state: State, contacts: Contacts, c: int) -> tuple[float, float]:
    """Relative motion of the two bodies at a contact: apart, and along the tangent."""
    first, second = contacts.bodies[c, 0], contacts.bodies[c, 1]
    nx, ny = contacts.normal[c, 0], contacts.normal[c, 1]
    ax, ay, bx, by = contacts.arms[c, 0], contacts.arms[c, 1], contacts.arms[c, 2], contacts.arms[c, 3]
    ux = state.motion[second, 0] - state.motion[second, 2] * by - state.motion[first, 0] + state.motion[first, 2] * ay
    uy = state.motion[second, 1] + state.motion[second, 2] * bx - state.motion[first, 1] - state.motion[first, 2] * ax
    return ux * nx + uy * ny, uy * nx - ux * ny


@compiled_part
def warm_start(shapes: Shapes, state: State, contacts: Contacts) -> None:
    """Begin with the impulses that the same contacts had in the last step."""
    for c in range(contacts.total[0]):
        first, second = contacts.bodies[c, 0], contacts.bodies[c, 1]
        for slot in range(2):
            if state.memory[first, second, slot, 0] == contacts.key[c]:
                contacts.impulse[c, 0] = state.memory[first, second, slot, 1]
                contacts.impulse[c, 1] = state.memory[first, second, slot, 2]
                _push_apart(shapes, state, contacts, c, contacts.impulse[c, 0], contacts.impulse[c, 1])
                break


@compiled_part
def remember(state: State, contacts: Contacts) -> None:
    """Keep the impulses for the next step."""
    for c in range(contacts.total[0]):
        first, second, slot = contacts.bodies[c, 0], contacts.bodies[c, 1], contacts.bodies[c, 2]
        state.memory[first, second, slot, 0] = contacts.key[c]
        state.memory[first, second, slot, 1] = contacts.impulse[c, 0]
        state.memory[first, second, slot, 2] = contacts.impulse[c, 1]
        if slot == 0 and (c + 1 == contacts.total[0] or contacts.bodies[c + 1, 2] == 0):
            state.memory[first, second, 1, 0] = -1.0


@compiled_part
def solve(shapes: Shapes, state: State, contacts: Contacts, numbers: Numbers, healing: float) -> None:
    """Find the motion of all blocks in contact.

    No contact may close by more than its gap; an overlap deeper than the slop opens by the share ``healing``.
    """
    for _ in range(numbers.iterations):
        largest = 0.0
        for c in range(contacts.total[0]):
            apart, aside = _slip(state, contacts, c)
            gap, along, across = contacts.gap[c], contacts.resistance[c, 0], contacts.resistance[c, 1]
            room = gap if gap > 0.0 else healing * min(gap + numbers.slop, 0.0)
            old, held = contacts.impulse[c, 0], contacts.impulse[c, 1]
            new = max(0.0, old - (apart + room) * along)
            limit = numbers.friction * new
            hold = min(limit, max(-limit, held - aside * across))
            if new != old or hold != held:
                contacts.impulse[c, 0], contacts.impulse[c, 1] = new, hold
                _push_apart(shapes, state, contacts, c, new - old, hold - held)
                largest = max(largest, abs(new - old) / along, abs(hold - held) / across)
        if largest < _STILL:
            break
