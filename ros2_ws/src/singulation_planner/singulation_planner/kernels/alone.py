"""How a block goes when the tip of a jaw pushes it and nothing else is in its way."""

import numpy as np

from singulation_core.jit import compiled_inline, compiled_maker, compiled_part
from singulation_core.polygon import FloatArray
from singulation_planner.kernels.types import IntArray


@compiled_part
def _sides(centroids: FloatArray, vertices: FloatArray, firsts: IntArray, sides: FloatArray) -> None:
    """Write vertex x, y around the centroid [m], outward normal and length [m] of the edges that begin there (v, 5)."""
    for i in range(len(centroids)):
        first, last = firsts[i], firsts[i + 1]
        for k in range(first, last):
            after = k + 1 if k + 1 < last else first
            ex, ey = vertices[after, 0] - vertices[k, 0], vertices[after, 1] - vertices[k, 1]
            size = np.sqrt(ex * ex + ey * ey)
            sides[k, 0], sides[k, 1] = vertices[k, 0] - centroids[i, 0], vertices[k, 1] - centroids[i, 1]
            sides[k, 2], sides[k, 3], sides[k, 4] = ey / size, -ex / size, size


@compiled_inline
def _nearest(
    sides: FloatArray, first: int, last: int, tip_x: float, tip_y: float
) -> tuple[float, float, float, float, float]:
    """Nearest point of an outline to the tip, the normal there, and the distance (inside: < 0)."""
    height, edge = -np.inf, first
    for k in range(first, last):
        above = (tip_x - sides[k, 0]) * sides[k, 2] + (tip_y - sides[k, 1]) * sides[k, 3]
        if above > height:
            height, edge = above, k
    vx, vy, nx, ny, length = sides[edge, 0], sides[edge, 1], sides[edge, 2], sides[edge, 3], sides[edge, 4]
    along = min(length, max(0.0, (tip_y - vy) * nx - (tip_x - vx) * ny))
    px, py = vx - along * ny, vy + along * nx
    dx, dy = tip_x - px, tip_y - py
    distance = np.sqrt(dx * dx + dy * dy)
    if height <= 0.0 or distance < 1e-9 * length:
        return px, py, nx, ny, height
    return px, py, dx / distance, dy / distance, distance


@compiled_inline
def _force(
    nx: float, ny: float, rx: float, ry: float, dx: float, dy: float, gyration: float, friction: float
) -> tuple[float, float, float]:
    """Direction of the force that moves the point at (rx, ry) along (dx, dy), within the cone of friction around
    -(nx, ny), and the turn it causes; the block is as heavy as its limit surface is wide: 1.
    """
    lever = (rx * dy - ry * dx) / (gyration + rx * rx + ry * ry)
    fx, fy = dx + ry * lever, dy - rx * lever
    pressed, aside = -(fx * nx + fy * ny), fy * nx - fx * ny
    if abs(aside) > friction * pressed:
        side = friction if aside > 0.0 else -friction
        fx, fy = -nx - side * ny, -ny + side * nx
    return fx, fy, (rx * fy - ry * fx) / gyration


@compiled_maker
def paths_alone(
    centroids: FloatArray,
    vertices: FloatArray,
    firsts: IntArray,
    gyrations: FloatArray,
    targets: IntArray,
    starts: FloatArray,
    directions: FloatArray,
    tip: float,
    travel: float,
    friction: float,
    paths: FloatArray,
) -> None:
    """Quasi-static paths of the targets of m pushes (ellipsoidal limit surface, as in the push physics).

    Args:
        centroids, vertices, firsts: as in ``Scene``.
        gyrations: (n,) moments of inertia over mass [m^2].
        targets, starts, directions: (m,), (m, 2), (m, 2) pushes.
        tip, travel, friction: radius [m], way [m] and friction of the tip.
        paths: (m, k, 2), written: displacement of the centroid [m] after each kth of the way.
    """
    steps, sides = paths.shape[1], np.empty((len(vertices), 5))
    _sides(centroids, vertices, firsts, sides)
    for c in range(len(targets)):
        i, dx, dy, advance = targets[c], directions[c, 0], directions[c, 1], travel / steps
        tip_x, tip_y = starts[c, 0] - centroids[i, 0], starts[c, 1] - centroids[i, 1]
        x, y, turn = 0.0, 0.0, 0.0
        for step in range(steps):
            c_, s_ = np.cos(turn), np.sin(turn)
            ux, uy = c_ * (tip_x - x) + s_ * (tip_y - y), c_ * (tip_y - y) - s_ * (tip_x - x)
            px, py, qx, qy, distance = _nearest(sides, firsts[i], firsts[i + 1], ux, uy)
            nx, ny, rx, ry = c_ * qx - s_ * qy, s_ * qx + c_ * qy, c_ * px - s_ * py, s_ * px + c_ * py
            need = -advance * (nx * dx + ny * dy) - (distance - tip)
            tip_x, tip_y = tip_x + advance * dx, tip_y + advance * dy
            if nx * dx + ny * dy < 0.0 and need > 0.0:
                fx, fy, spin = _force(nx, ny, rx, ry, dx, dy, gyrations[i], friction)
                yields = -((fx - spin * ry) * nx + (fy + spin * rx) * ny)
                if yields > 1e-6:
                    x, y, turn = x + need / yields * fx, y + need / yields * fy, turn + need / yields * spin
            paths[c, step, 0], paths[c, step, 1] = x, y
