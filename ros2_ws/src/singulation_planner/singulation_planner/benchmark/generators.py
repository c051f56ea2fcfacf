"""Random scenes: the authors' clutter, and a tighter one in which blocks touch.

Lengths inside are bounding radii; a scenario is then given in metres, one bounding radius being ``UNIT``.
"""

from collections.abc import Callable

import numpy as np

from singulation_core import Arrangement, PlanarObject
from singulation_core.polygon import FloatArray, separation
from singulation_core.push_world.sweep import free_travel
from singulation_planner.benchmark.scenario import Scenario
from singulation_planner.benchmark.shapes import GROUPS, random_outline

UNIT = 0.04  # m that one bounding radius stands for: blocks of 80 mm
_GAPS = 0.02, 0.3  # to the nearest block in the authors' scenes
_TRIES = 200


def authors_scene(count: int, group: int, random: np.random.Generator) -> list[FloatArray]:
    """As the authors' code places blocks: each near the one before, then pulled to its nearest neighbour."""
    placed: list[FloatArray] = []
    previous = random.uniform(4.0, 8.0, 2)
    while len(placed) < count:
        outline = random_outline(group, random)
        if placed:
            outline, previous = _beside(outline, placed, previous, random)
        placed.append(outline + previous)
    return placed


def _beside(
    outline: FloatArray, placed: list[FloatArray], previous: FloatArray, random: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """A free position of the outline within 1.8 of the previous block, then pulled towards its nearest neighbour."""
    for attempt in range(_TRIES):
        reach = 1.8 * (1.0 + attempt // 20)  # surrounded: look further out
        position = np.clip(previous + random.uniform(-reach, reach, 2), 2.0, 10.0)
        gap, neighbour = _nearest(outline + position, placed)
        if gap > 0.0:
            break
    wanted = random.uniform(*_GAPS)
    towards = neighbour.mean(axis=0) - position
    towards /= np.hypot(towards[0], towards[1])
    while gap > wanted + 0.005:  # no step is longer than what is free
        position = position + (gap - wanted) * towards
        gap, _ = _nearest(outline + position, placed)
    return outline, position


def _nearest(outline: FloatArray, placed: list[FloatArray]) -> tuple[float, FloatArray]:
    """Gap to the nearest of the placed blocks, and that block."""
    order = sorted(placed, key=lambda other: float(((other.mean(axis=0) - outline.mean(axis=0)) ** 2).sum()))
    gaps = [separation(outline, other) for other in order[:6]]
    return min(gaps), order[int(np.argmin(gaps))]


def clutter_scene(count: int, group: int, random: np.random.Generator) -> list[FloatArray]:
    """Tight clutter: each block slides in from outside towards a random block of the heap until it touches.

    Sizes 0.8..1.2 bounding radii; gaps where blocks meet 0..0.02.
    """
    placed: list[FloatArray] = []
    for _ in range(count):
        outline = random_outline(group, random) * random.uniform(0.8, 1.2)
        placed.append(_slid_in(outline, placed, random) if placed else outline)
    return placed


def _slid_in(outline: FloatArray, placed: list[FloatArray], random: np.random.Generator) -> FloatArray:
    """Of a few random approaches the one that ends nearest to the middle of the heap: clutter, not chains."""
    middle = np.mean([one.mean(axis=0) for one in placed], axis=0)
    best, nearest = outline, np.inf
    for _ in range(4):
        angle = random.uniform(0.0, 2.0 * np.pi)
        towards = np.array((np.cos(angle), np.sin(angle)))
        aim = placed[int(random.integers(len(placed)))].mean(axis=0)
        far = outline + aim - 30.0 * towards
        way = free_travel(far, placed, towards) - random.uniform(0.0, 0.02)
        distance = float(np.hypot(*((far + way * towards).mean(axis=0) - middle)))
        if distance < nearest:
            best, nearest = far + way * towards, distance
    return best


GENERATORS: dict[str, Callable[[int, int, np.random.Generator], list[FloatArray]]] = {
    "authors": authors_scene,
    "clutter": clutter_scene,
}


def generate(generator: str, count: int, group: int, seed: int) -> Scenario:
    """The scenario of a generator with this seed; always the same one.

    Args:
        generator: a key of ``GENERATORS``.
        count: number of blocks.
        group: 0..3, eccentricity.
        seed: any non-negative number.
    """
    random = np.random.default_rng((seed, count, group))
    outlines = GENERATORS[generator](count, group, random)
    objects = [PlanarObject(k, outline * UNIT) for k, outline in enumerate(outlines)]
    key = f"{generator}-n{count:02d}-g{group}-s{seed}"
    return Scenario(key, count, group, seed, Arrangement(objects), UNIT)


def groups() -> range:
    """All groups of eccentricity."""
    return range(len(GROUPS))
