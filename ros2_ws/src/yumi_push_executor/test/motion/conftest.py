"""Blocks and pushes for the tests of motion planning."""

import pathlib
import sys

import numpy as np
import pytest

from singulation_core import Arrangement, ContactMode, PlanarObject, Push

sys.path.insert(0, str(pathlib.Path(__file__).parent))

WIDTHS = {ContactMode.SINGLE_POINT: 0.0, ContactMode.EDGE: 0.0124, ContactMode.TWO_POINT: 0.03}


@pytest.fixture
def block():
    """Block with an id, centre [m], half sides [m] and height [m]."""

    def make(number, x, y, half=0.018, height=0.03, depth=None):
        depth = half if depth is None else depth
        corners = np.array(((-half, -depth), (half, -depth), (half, depth), (-half, depth)))
        return PlanarObject(number, corners + (x, y), height=height)

    return make


@pytest.fixture
def cluster(block):
    """Four blocks in the middle of the workspace."""
    return Arrangement(
        [block(k, x, y) for k, (x, y) in enumerate(((0.02, -0.02), (0.02, 0.02), (0.06, -0.02), (0.06, 0.02)))]
    )


@pytest.fixture
def push_of():
    """Push of a mode from and to points in table [m]."""

    def make(mode=ContactMode.SINGLE_POINT, start=(-0.03, 0.0), end=(0.05, 0.0), width=None):
        return Push(np.array(start), np.array(end), mode, WIDTHS[mode] if width is None else width)

    return make
