"""Blocks and scenes for the tests of the push physics."""

from collections.abc import Callable

import numpy as np
import pytest

from singulation_core import Arrangement, PlanarObject


def polygon_block(number: int, centre: tuple[float, float], radius: float = 0.02, corners: int = 4) -> PlanarObject:
    """A regular polygon with a vertex-centre distance of ``radius``; a square lies along the axes."""
    angles = 2.0 * np.pi * (np.arange(corners) + 0.5) / corners
    return PlanarObject(number, np.column_stack((np.cos(angles), np.sin(angles))) * radius + centre)


def random_scene(seed: int, count: int = 6) -> Arrangement:
    """Random convex blocks that touch nobody, a few millimetres apart."""
    random = np.random.default_rng(seed)
    blocks = []
    for number in range(count):
        angles = (np.arange(6) + random.uniform(-0.3, 0.3, 6)) * np.pi / 3.0
        outline = 0.02 * np.column_stack((np.cos(angles), np.sin(angles)))
        blocks.append(PlanarObject(number, outline + 0.042 * np.array((number % 3, number // 3))))
    return Arrangement(blocks)


@pytest.fixture
def block() -> Callable[..., PlanarObject]:
    return polygon_block


@pytest.fixture(scope="session")
def scene_of() -> Callable[..., Arrangement]:
    return random_scene
