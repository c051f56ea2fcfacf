"""Scenes with ground truth: layouts of blocks, seen by a sensor."""

from dataclasses import dataclass, replace

import numpy as np
from benchmarks.perception.blocks import (
    Block,
    corner_contact,
    placed_apart,
    random_height,
    random_shape,
    touching_group,
)
from benchmarks.perception.sensor import Sensor, view
from numpy.typing import NDArray

from singulation_core import Arrangement, PlanarObject
from singulation_core.polygon import FloatArray

AREA = (-0.25, 0.25, -0.19, 0.19)  # the workspace of the scenes [m]
FULL = Sensor()
HALF = Sensor(width=1032, height=772)
_MARGIN = 0.005


@dataclass(frozen=True, eq=False)
class Scene:
    """A cloud with what it shows.

    Args:
        points: (H, W, 3) float32, camera frame [m].
        labels: (H, W) block of each point, -1 for none.
        table_from_camera: the true 4x4.
        truth: the blocks.
    """

    points: NDArray[np.float32]
    labels: NDArray[np.int16]
    table_from_camera: FloatArray
    truth: Arrangement


def make_scene(
    seed: int,
    sensor: Sensor = FULL,
    *,
    blocks: int = 25,
    group: int = 1,
    gap: float = 0.005,
    heights: str = "uniform",
    corner: bool = False,
) -> Scene:
    """A random scene.

    Args:
        seed: of everything random; scenes for tuning and for reports use different ones.
        sensor: its pose is varied a little by the seed.
        blocks: how many; fewer if there is no room.
        group: blocks per group.
        gap: between the blocks of a group [m], or between all blocks if ``group`` is 1; groups stay 6 mm apart.
        heights: ``equal``, ``steps`` or ``uniform``.
        corner: groups are pairs, a corner against an edge.
    """
    random = np.random.default_rng(seed)
    if corner:
        groups = [corner_contact(random, gap) for _ in range(blocks // 2)]
    elif group > 1:
        groups = [touching_group(random, group, gap) for _ in range(blocks // group)]
    else:
        groups = [[random_shape(random)] for _ in range(blocks)]
    inner = (AREA[0] + _MARGIN, AREA[1] - _MARGIN, AREA[2] + _MARGIN, AREA[3] - _MARGIN)
    placed = placed_apart(random, groups, inner, gap if group == 1 and not corner else 0.006)
    solid = [Block(outline, random_height(random, heights)) for members in placed for outline in members]
    turned = replace(
        sensor,
        distance=random.uniform(0.85, 0.95),
        tilt=np.radians(random.uniform(2, 8)),
        heading=random.uniform(0, 2 * np.pi),
    )
    return scene_of(solid, turned, random)


def scene_of(blocks: list[Block], sensor: Sensor, random: np.random.Generator) -> Scene:
    """The given blocks, with two fixtures outside the workspace."""
    seen = view(sensor, [*blocks, *_fixtures()], random)
    labels = np.where(seen.labels < len(blocks), seen.labels, np.int16(-1))
    objects = [PlanarObject(i, block.outline, block.height) for i, block in enumerate(blocks)]
    return Scene(seen.points, labels, sensor.table_from_camera, Arrangement(objects))


def _fixtures() -> list[Block]:
    bar = np.array(((-0.3, -0.03), (0.3, -0.03), (0.3, 0.03), (-0.3, 0.03)))
    return [Block(bar + (0.0, 0.27), 0.06), Block(bar[:, ::-1][::-1] + (0.36, 0.0), 0.05)]
