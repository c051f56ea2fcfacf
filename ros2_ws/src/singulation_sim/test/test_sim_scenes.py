"""Random scenes."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import CellGeometry, InvalidInputError, ResultCode, SingulationError, smallest_gap
from singulation_core.polygon import separation
from singulation_sim.scenes import SCENES, random_scene

CELL = CellGeometry()


@settings(max_examples=25, deadline=None)
@given(st.sampled_from(sorted(set(SCENES) - {"empty"})), st.integers(0, 9), st.integers(0, 10**6))
def test_blocks_lie_close_together_inside_the_workspace(scene: str, objects: int, seed: int) -> None:
    arrangement = random_scene(scene, objects, seed)
    assert len(arrangement) == objects or (objects == 0 and 3 <= len(arrangement) <= 7)
    corners = np.vstack([item.outline for item in arrangement.objects])
    low, high = np.array(CELL.workspace[::2]), np.array(CELL.workspace[1::2])
    assert (corners >= low + 0.04).all()
    assert (corners <= high - 0.04).all()
    assert all(0.02 <= item.height <= 0.04 for item in arrangement.objects)
    if len(arrangement) > 1:
        assert smallest_gap(arrangement) > 0.0018
        for item in arrangement.objects:
            others = [other for other in arrangement.objects if other is not item]
            assert min(separation(item.outline, other.outline) for other in others) < 0.0062


def test_the_same_seed_gives_the_same_scene() -> None:
    first, again, other = (random_scene("mixed", 5, seed) for seed in (7, 7, 8))
    assert all((a.outline == b.outline).all() for a, b in zip(first.objects, again.objects, strict=True))
    assert [item.height for item in first.objects] == [item.height for item in again.objects]
    assert first.centroids.shape != other.centroids.shape or (first.centroids != other.centroids).any()


def test_kinds_of_blocks() -> None:
    corners = {len(item.outline) for seed in range(10) for item in random_scene("mixed", 6, seed).objects}
    assert corners == {3, 4}
    for item in random_scene("squares", 7, 1).objects:
        sides = np.hypot(*(np.roll(item.outline, -1, axis=0) - item.outline).T)
        assert np.ptp(sides) < 1e-9
    shapes = [item for seed in range(20) for item in random_scene("mixed", 6, seed).objects if len(item.outline) == 3]
    for item in shapes:
        sides = np.sort(np.hypot(*(np.roll(item.outline, -1, axis=0) - item.outline).T))
        assert sides[0] == pytest.approx(sides[1])
        assert sides[2] == pytest.approx(sides[0] * np.sqrt(2.0))


def test_groups_become_more_eccentric() -> None:
    def roundness(group: int) -> float:
        items = [item for seed in range(15) for item in random_scene(f"group_{group}", 6, seed).objects]
        return float(np.mean([item.area / (np.pi * item.bounding_radius**2) for item in items]))

    values = [roundness(group) for group in range(4)]
    assert values == sorted(values, reverse=True)


def test_all_pairs_are_apart() -> None:
    for seed in range(20):
        for a, b in combinations(random_scene("group_3", 8, seed).objects, 2):
            assert separation(a.outline, b.outline) > 0.0018


@pytest.mark.parametrize("gap", [0.0005, 0.01])
def test_gaps_can_be_chosen(gap: float) -> None:
    for seed in range(5):
        assert smallest_gap(random_scene("mixed", 4, seed, gaps=(gap, gap))) == pytest.approx(gap, abs=1.1e-4)


def test_what_cannot_be_made_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="one of: mixed, squares"):
        random_scene("round")
    with pytest.raises(InvalidInputError, match="-1 objects"):
        random_scene("mixed", -1)
    with pytest.raises(InvalidInputError, match="gaps"):
        random_scene("mixed", 3, gaps=(0.01, 0.001))
    with pytest.raises(SingulationError) as failure:
        random_scene("mixed", 5, cell=replace(CELL, workspace=(-0.05, 0.05, -0.05, 0.05)))
    assert failure.value.code is ResultCode.OUTSIDE_WORKSPACE
    assert len(random_scene("mixed", 5)) == 5


@pytest.mark.parametrize("objects", [0, 5])
def test_an_empty_scene_is_a_bare_table(objects: int) -> None:
    assert len(random_scene("empty", objects)) == 0
