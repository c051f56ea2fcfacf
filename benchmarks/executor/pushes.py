"""Random pushes over the lab's workspace, with and without blocks."""

from dataclasses import dataclass

import numpy as np

from singulation_core import Arrangement, CellGeometry, ContactMode, PlanarObject, Push, PusherGeometry
from singulation_core.polygon import FloatArray, separation
from singulation_core.push_world import pusher_footprint

_LENGTH = (0.03, 0.12)  # [m]
_WIDTH = (0.010, 0.050)  # [m] of a two-point push
_RADIUS = (0.015, 0.028)  # [m] of a block
_HEIGHT = (0.015, 0.040)  # [m]
_FREE = 0.0015  # [m] between pusher and blocks at the start


@dataclass(frozen=True, eq=False)
class Task:
    """One push to plan: arrangement (empty if none) and push, in ``table``."""

    arrangement: Arrangement
    push: Push


def random_tasks(count: int, seed: int, blocks: bool) -> list[Task]:
    """Pushes with starts all over the workspace; the three contact modes in turn.

    Args:
        count: of pushes.
        seed: of everything random.
        blocks: whether 3 to 7 blocks lie on the table; the pusher then starts free of them, as a planner's push does.
    """
    random = np.random.default_rng(seed)
    tasks: list[Task] = []
    while len(tasks) < count:
        arrangement = random_arrangement(random) if blocks else Arrangement(())
        push = _random_push(random, ContactMode(len(tasks) % 3))
        if push is not None and _starts_free(push, arrangement):
            tasks.append(Task(arrangement, push))
    return tasks


def random_arrangement(random: np.random.Generator) -> Arrangement:
    """3 to 7 regular polygons that do not overlap, near one another as in the paper's clusters."""
    objects: list[PlanarObject] = []
    wanted = int(random.integers(3, 8))
    middle = random.uniform((-0.07, -0.11), (0.07, 0.11))
    while len(objects) < wanted:
        radius, corners = random.uniform(*_RADIUS), int(random.integers(3, 8))
        around = random.uniform(0.0, 2.0 * np.pi) + 2.0 * np.pi * np.arange(corners) / corners
        centre = middle + random.uniform(-0.07, 0.07, 2)
        outline = centre + radius * np.column_stack((np.cos(around), np.sin(around)))
        if all(separation(outline, other.outline) > 0.001 for other in objects):
            objects.append(PlanarObject(len(objects), outline, height=float(random.uniform(*_HEIGHT))))
    return Arrangement(objects)


def _random_push(random: np.random.Generator, mode: ContactMode) -> Push | None:
    x_min, x_max, y_min, y_max = CellGeometry().workspace
    start = random.uniform((x_min, y_min), (x_max, y_max))
    angle, length = random.uniform(0.0, 2.0 * np.pi), random.uniform(*_LENGTH)
    end = start + length * np.array((np.cos(angle), np.sin(angle)))
    if not (x_min <= end[0] <= x_max and y_min <= end[1] <= y_max):
        return None
    widths = {
        ContactMode.SINGLE_POINT: 0.0,
        ContactMode.EDGE: PusherGeometry().edge_width,
        ContactMode.TWO_POINT: float(random.uniform(*_WIDTH)),
    }
    return Push(start, end, mode, widths[mode])


def _starts_free(push: Push, arrangement: Arrangement) -> bool:
    footprint = pusher_footprint(push, PusherGeometry())
    axes = np.array((push.direction, (-push.direction[1], push.direction[0])))
    around = 2.0 * np.pi * np.arange(12) / 12
    circle = np.column_stack((np.cos(around), np.sin(around)))
    parts: list[FloatArray] = [np.array((one.x, one.y)) + one.radius * circle for one in footprint.discs]
    parts += list(footprint.polygons)
    placed = [part @ axes + push.start for part in parts]
    return all(separation(part, item.outline) > _FREE for part in placed for item in arrangement.objects)
