"""Where a pusher starts, whether it is free there, and what the push would carry along."""

import numpy as np

from singulation_core.jit import compiled, compiled_inline, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray

# What became of a candidate.
FEASIBLE, MISSES, BLOCKED, OUTSIDE, OVER_EDGE, UNTRIED = 0, 1, 2, 3, 4, 5
_SINGLE_POINT, _EDGE, _TWO_POINT = 0, 1, 2

# Centroids (n, 2), bounding radii (n,), vertices (v, 2), first vertex of each object (n + 1,), as in ``Scene``.
Shapes = tuple[FloatArray, FloatArray, FloatArray, IntArray]


@compiled_part
def _disc_contact(
    vertices: FloatArray, first: int, last: int, x: float, y: float, dx: float, dy: float, radius: float
) -> float:
    """Distance along (dx, dy) from (x, y) at which a disc coming from far behind touches the outline [m]."""
    contact = np.inf
    for k in range(first, last):
        after = k + 1 if k + 1 < last else first
        rx, ry = vertices[k, 0] - x, vertices[k, 1] - y
        u, w = rx * dx + ry * dy, ry * dx - rx * dy  # along and to the left of the push
        if abs(w) <= radius:
            contact = min(contact, u - np.sqrt(radius * radius - w * w))
        rx, ry = vertices[after, 0] - x, vertices[after, 1] - y
        edge_u, edge_w = rx * dx + ry * dy - u, ry * dx - rx * dy - w
        if edge_w >= 0.0:  # this edge faces away from the pusher
            continue
        length = np.sqrt(edge_u * edge_u + edge_w * edge_w)
        normal_u, normal_w = edge_w / length, -edge_u / length
        share = (-radius * normal_w - w) / edge_w  # where on the edge the disc would touch
        if 0.0 <= share <= 1.0:
            contact = min(contact, u + share * edge_u + radius * normal_u)
    return contact


@compiled_part
def _strip_contact(
    vertices: FloatArray, first: int, last: int, x: float, y: float, dx: float, dy: float, half: float
) -> float:
    """As ``_disc_contact``, for a straight edge of half width ``half`` [m] across the push."""
    contact = np.inf
    for k in range(first, last):
        after = k + 1 if k + 1 < last else first
        rx, ry = vertices[k, 0] - x, vertices[k, 1] - y
        u, w = rx * dx + ry * dy, ry * dx - rx * dy
        if abs(w) <= half:
            contact = min(contact, u)
        rx, ry = vertices[after, 0] - x, vertices[after, 1] - y
        u_after, w_after = rx * dx + ry * dy, ry * dx - rx * dy
        for side in (-half, half):
            if (w - side) * (w_after - side) < 0.0:
                contact = min(contact, u + (u_after - u) * (side - w) / (w_after - w))
    return contact


@compiled_part
def _gap(vertices: FloatArray, first: int, last: int, x: float, y: float) -> float:
    """Signed distance of a point to a convex outline [m], negative inside."""
    outward, squared = -np.inf, np.inf
    for k in range(first, last):
        after = k + 1 if k + 1 < last else first
        ex, ey = vertices[after, 0] - vertices[k, 0], vertices[after, 1] - vertices[k, 1]
        rx, ry = x - vertices[k, 0], y - vertices[k, 1]
        length2 = ex * ex + ey * ey
        outward = max(outward, (rx * ey - ry * ex) / np.sqrt(length2))
        along = min(1.0, max(0.0, (rx * ex + ry * ey) / length2))
        px, py = rx - along * ex, ry - along * ey
        squared = min(squared, px * px + py * py)
    return np.sqrt(squared) if outward > 0.0 else outward


@compiled_part
def _rectangle_apart(
    vertices: FloatArray,
    first: int,
    last: int,
    x: float,
    y: float,
    dx: float,
    dy: float,
    half: float,
    front: float,
    back: float,
) -> bool:
    """Whether a rectangle (``front`` before, ``back`` behind, ``half`` beside the point) misses the outline."""
    u_min, u_max, w_min, w_max = np.inf, -np.inf, np.inf, -np.inf
    for k in range(first, last):
        rx, ry = vertices[k, 0] - x, vertices[k, 1] - y
        u, w = rx * dx + ry * dy, ry * dx - rx * dy
        u_min, u_max, w_min, w_max = min(u_min, u), max(u_max, u), min(w_min, w), max(w_max, w)
        after = k + 1 if k + 1 < last else first
        ex, ey = vertices[after, 0] - vertices[k, 0], vertices[after, 1] - vertices[k, 1]
        normal_u, normal_w = ey * dx - ex * dy, -ex * dx - ey * dy  # outward, in the frame of the push
        support = min(front * normal_u, -back * normal_u) - half * abs(normal_w)
        if support >= u * normal_u + w * normal_w:
            return True
    return u_min >= front or u_max <= -back or w_min >= half or w_max <= -half


@compiled_inline
def _start(
    mode: int,
    from_circle: bool,
    vertices: FloatArray,
    first: int,
    last: int,
    radius: float,
    x: float,
    y: float,
    dx: float,
    dy: float,
    offset: float,
    jaw: float,
    pusher: FloatArray,
) -> float:
    """Position of the pusher along the push line at its start; infinite if the line misses the object."""
    tip, half, clearance = pusher[0], pusher[1], pusher[3]
    grown = tip + clearance
    if mode == _EDGE:
        contact = _strip_contact(vertices, first, last, x, y, dx, dy, half + clearance) - clearance
    elif mode == _TWO_POINT:
        left = _disc_contact(vertices, first, last, x - dy * jaw, y + dx * jaw, dx, dy, grown)
        contact = min(left, _disc_contact(vertices, first, last, x + dy * jaw, y - dx * jaw, dx, dy, grown))
    else:
        contact = _disc_contact(vertices, first, last, x, y, dx, dy, grown)
    if not from_circle or contact == np.inf:
        return contact
    whole = radius + (clearance if mode == _EDGE else grown)
    return min(contact, -np.sqrt(max(0.0, whole * whole - offset * offset)))


@compiled_inline
def _fits(
    mode: int,
    shapes: Shapes,
    px: float,
    py: float,
    dx: float,
    dy: float,
    target: int,
    jaw: float,
    pusher: FloatArray,
) -> bool:
    """Whether the pusher at (px, py) keeps its clearance from every object but the target.

    An edge keeps it all around as a larger rectangle, which past its corners is up to 1.4 times as much.
    """
    centroids, radii, vertices, firsts = shapes
    tip, half, back, slack = pusher[0], pusher[1], pusher[2], pusher[3] * (1.0 - 1e-9)
    size = np.hypot(half, back) if mode == _EDGE else tip + jaw
    for j in range(len(radii)):
        rx, ry = centroids[j, 0] - px, centroids[j, 1] - py
        reach = radii[j] + size + 2.0 * slack
        if j == target or rx * rx + ry * ry > reach * reach:
            continue
        first, last = firsts[j], firsts[j + 1]
        if mode == _EDGE:
            if not _rectangle_apart(vertices, first, last, px, py, dx, dy, half + slack, slack, back + slack):
                return False
        else:
            for side in (-jaw, jaw):
                if _gap(vertices, first, last, px - dy * side, py + dx * side) < tip + slack:
                    return False
                if jaw == 0.0:
                    break
    return True


@compiled_part
def _inside(
    mode: int,
    walls: tuple[FloatArray, FloatArray],
    px: float,
    py: float,
    dx: float,
    dy: float,
    jaw: float,
    pusher: FloatArray,
) -> bool:
    """Whether the whole footprint lies inside the workspace."""
    normals, limits = walls
    for k in range(len(limits)):
        nx, ny = normals[k, 0], normals[k, 1]
        across, along = abs(ny * dx - nx * dy), nx * dx + ny * dy
        need = pusher[0] + jaw * across
        if mode == _EDGE:
            need = pusher[1] * across + max(0.0, pusher[2] * along)
        if not (px * nx + py * ny - limits[k] >= need):
            return False
    return True


@compiled_inline
def _place_one(
    mode: int,
    from_circle: bool,
    shapes: Shapes,
    i: int,
    dx: float,
    dy: float,
    offset: float,
    jaw: float,
    pusher: FloatArray,
    ways: FloatArray,
    walls: tuple[FloatArray, FloatArray],
    start: FloatArray,
) -> int:
    """``place`` for one candidate and one contact mode."""
    centroids, radii, vertices, firsts = shapes
    x, y = centroids[i, 0] - dy * offset, centroids[i, 1] + dx * offset
    at = _start(mode, from_circle, vertices, firsts[i], firsts[i + 1], radii[i], x, y, dx, dy, offset, jaw, pusher)
    if at == np.inf:
        return MISSES
    lowest = at - ways[1]
    start[0], start[1] = x + at * dx, y + at * dy
    while not _fits(mode, shapes, start[0], start[1], dx, dy, i, jaw, pusher):
        at -= ways[2]
        if at < lowest:
            return BLOCKED
        start[0], start[1] = x + at * dx, y + at * dy
    end_x, end_y = start[0] + ways[0] * dx, start[1] + ways[0] * dy
    if _inside(mode, walls, start[0], start[1], dx, dy, jaw, pusher) and _inside(
        mode, walls, end_x, end_y, dx, dy, jaw, pusher
    ):
        return FEASIBLE
    return OUTSIDE


@compiled
def place(
    modes: IntArray,
    from_circle: bool,
    shapes: Shapes,
    objects: IntArray,
    directions: FloatArray,
    offsets: FloatArray,
    begin: int,
    all_of_them: bool,
    jaws: FloatArray,
    pusher: FloatArray,
    ways: FloatArray,
    walls: tuple[FloatArray, FloatArray],
    starts: FloatArray,
    status: IntArray,
) -> int:
    """Put the pusher at the start of candidates ``begin``, ``begin + 1``, ... and say what is wrong with each.

    Args:
        modes: contact modes whose pusher must be free; the first one performs the push.
        from_circle: whether to start at the bounding circle instead of at the outline.
        shapes: the scene.
        objects, directions, offsets: (m,), (m, 2), (m,) candidates.
        begin: index of the first candidate to look at.
        all_of_them: go on after the first feasible candidate.
        jaws: (n,) half the distance of two points on each object [m].
        pusher: tip radius, half edge width, edge thickness, clearance [m].
        ways: travel from start to end, how far a blocked start may be moved back, and in which steps [m].
        walls: inward half planes of the workspace: normals (k, 2), offsets (k,); none: unbounded.
        starts: (m, 2), written.
        status: (m,), written.

    Returns:
        Index of the first feasible candidate, -1 if there is none.
    """
    found = -1
    for c in range(begin, len(objects)):
        i, dx, dy = objects[c], directions[c, 0], directions[c, 1]
        for m in range(len(modes) - 1, -1, -1):  # the pushing mode last, so that the start written is its own
            mode = modes[m]
            jaw = jaws[i] if mode == _TWO_POINT else 0.0
            status[c] = _place_one(
                mode, from_circle, shapes, i, dx, dy, offsets[c], jaw, pusher, ways, walls, starts[c]
            )
            if status[c] != FEASIBLE:
                break
        if status[c] == FEASIBLE:
            found = c if found < 0 else found
            if not all_of_them:
                break
    return found
