"""Corners of low blocks in the shadow of taller ones are put back where nobody could look, and only there."""

import numpy as np
import pytest
from ros2_ws.src.singulation_perception.test.table_top import PARAMETERS, box, cloud, heights, turned

from singulation_core.polygon import contains
from singulation_perception import segment

CORNER = np.array((0.04, 0.005))  # of the low block, touching the middle of an edge of the tall one
LOW = box(0.015, -0.02, 0.05, 0.05)
TALL = box(0.0, 0.0, 0.05, 0.05, np.pi / 4) + CORNER + 0.025 * np.sqrt(0.5)
CUT = 0.009 * np.sqrt(2.0)  # m that the shadow takes off both edges at the corner
CHAMFERED = np.array((LOW[0], LOW[1], CORNER - (0.0, CUT), CORNER - (CUT, 0.0), LOW[3]))
DARK = box(0.0, 0.0, 0.04, 0.0092, -np.pi / 4) + CORNER - 0.0044 * np.sqrt(0.5)  # ends where the tall block begins


def low_block(angle, outline, height, dark):
    """The low block as it is seen beside the tall one, everything turned by ``angle``."""
    points = cloud((turned(outline, angle), 0.025), (turned(TALL, angle), height))
    if dark:
        x, y, _ = heights()
        places = np.column_stack((x.ravel(), y.ravel()))
        hidden = contains(turned(DARK, angle), places) & ~contains(turned(TALL, angle), places)
        points[hidden.reshape(x.shape)] = np.nan
    return min(segment(points, PARAMETERS).objects, key=lambda item: item.height)


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.1, 2.5])
def test_a_corner_in_the_shadow_of_a_taller_block_is_put_back(angle):
    block = low_block(angle, LOW, 0.07, dark=True)
    assert len(block.outline) == 4
    assert np.hypot(*(block.outline - turned(CORNER, angle)).T).min() < 0.0015
    assert 0.5 < block.confidence < 1.0  # a guess, if a good one


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.1, 2.5])
def test_a_corner_is_not_put_back_where_the_table_is_seen(angle):
    assert len(low_block(angle, CHAMFERED, 0.07, dark=False).outline) == 5


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.1, 2.5])
def test_a_corner_is_not_put_back_that_the_taller_block_is_too_low_to_hide(angle):
    assert len(low_block(angle, LOW, 0.029, dark=True).outline) == 5
