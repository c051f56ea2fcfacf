"""What the score of rollout_push knows of two outlines: where they would touch."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_planner.kernels.gaps import all_gaps
from singulation_planner.kernels.touching import touching
from singulation_planner.scene import Scene
from singulation_planner.testing import clutter, squares


def contacts(scene):
    gaps, edges = all_gaps(scene.vertices, scene.firsts)
    return gaps, *touching(scene.centroids, scene.vertices, scene.firsts, edges, scene.scale)


@settings(deadline=None)
@given(st.floats(-0.6, 0.6), st.floats(0.0, 0.5))
def test_squares_side_by_side_touch_in_the_middle_of_what_they_share(aside, gap):
    side = 0.02
    scene = Scene.of(squares([(0.0, 0.0), (side * (1.0 + gap), side * aside)]))
    left, right = (0, 1) if scene.centroids[0, 0] < scene.centroids[1, 0] else (1, 0)
    gaps, planes, arms, gyrations = contacts(scene)
    assert gaps[left, right] == pytest.approx(side * gap, abs=1e-9)
    np.testing.assert_allclose(planes[left, right], (1.0, 0.0, side), atol=1e-9)
    np.testing.assert_allclose(planes[right, left], (-1.0, 0.0, side), atol=1e-9)
    np.testing.assert_allclose(arms[left, right], (-0.5 * side, -0.5 * side * aside), atol=1e-9)
    np.testing.assert_allclose(arms[right, left], (0.5 * side, 0.5 * side * aside), atol=1e-9)
    np.testing.assert_allclose(gyrations, side**2 / 6.0)


@settings(deadline=None)
@given(st.integers(2, 8), st.integers(0, 10**6))
def test_no_plane_cuts_into_either_of_its_blocks(count, seed):
    scene = Scene.of(clutter(count, seed))
    gaps, planes, _, _ = contacts(scene)
    for i in range(count):
        for j in range(count):
            if i == j:
                continue
            own, other = (scene.vertices[scene.firsts[k] : scene.firsts[k + 1]] @ planes[i, j, :2] for k in (i, j))
            assert np.hypot(*planes[i, j, :2]) == pytest.approx(1.0)
            apart = (scene.centroids[j] - scene.centroids[i]) @ planes[i, j, :2]
            assert apart - planes[i, j, 2] == pytest.approx(max(0.0, other.min() - own.max()), abs=1e-9)
            assert other.min() - own.max() <= gaps[i, j] + 1e-9
