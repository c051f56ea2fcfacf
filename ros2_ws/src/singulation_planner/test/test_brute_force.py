"""Policies and choices that simulate."""

import math

import numpy as np
import pytest

from singulation_core import ContactMode, ResultCode, SingulationError, singulation_distance
from singulation_core.push_world import PushPhysics, simulate_push
from singulation_planner import plan_push
from singulation_planner.policies import brute_force
from singulation_planner.policies.brute_force import Options, _chords, _parallels
from singulation_planner.testing import clutter, squares

COARSE = {"directions": 6, "offsets": 3}


def change(arrangement, push):
    unit = float(arrangement.bounding_radii.mean())
    after = singulation_distance(simulate_push(arrangement, push), unit)
    return after - singulation_distance(arrangement, unit)


def gain(arrangement, push):
    return change(arrangement, push) / singulation_distance(arrangement)


@pytest.mark.parametrize("mode", list(ContactMode))
def test_its_gain_is_that_of_the_simulated_push(mode):
    arrangement = clutter(4, 11)
    push = plan_push(arrangement, "brute_force", mode, **COARSE)
    assert push.expected_gain == pytest.approx(gain(arrangement, push), rel=0.02)


@pytest.mark.parametrize("seed", range(4))
def test_it_beats_every_policy_that_pushes_along_its_lines(seed):
    """With the line through the centroid in the grid, it is at least as good as what ranks the same 16 directions."""
    arrangement = clutter(4, seed)
    best = plan_push(arrangement, "brute_force", directions=16, offsets=1)
    for policy in ("min_overlap", "min_contact_range"):
        assert change(arrangement, best) >= change(arrangement, plan_push(arrangement, policy)) - 0.01


def test_a_finer_grid_is_not_worse():
    arrangement = clutter(3, 3)
    coarse = plan_push(arrangement, "brute_force", directions=4, offsets=1)
    fine = plan_push(arrangement, "brute_force", directions=8, offsets=5)
    assert fine.expected_gain >= coarse.expected_gain - 1e-6


def test_the_grid_of_the_text_leaves_the_centroid_out():
    angles, lines = _parallels(Options())
    assert len(angles) == len(lines) == 256
    assert lines.min() == -0.9
    assert lines.max() == 0.9
    assert np.abs(lines).min() > 0.0
    assert len(set(zip(angles.tolist(), lines.tolist(), strict=True))) == 256


def test_the_grid_of_the_code_is_all_chords():
    angles, lines = _chords(16)
    assert len(angles) == 240
    points = 2.0 * np.pi * np.arange(16) / 16
    start = np.column_stack((np.cos(points), np.sin(points)))
    on_line = np.cos(angles)[:, None] * start[:, 1] - np.sin(angles)[:, None] * start[:, 0] - lines[:, None]
    assert ((np.abs(on_line) < 1e-9).sum(axis=1) == 2).all()
    push = plan_push(clutter(3, 3), "brute_force", grid="chords", directions=5)
    assert math.isfinite(push.expected_gain)


def test_physics_is_a_choice():
    arrangement = clutter(4, 7)
    slippery = plan_push(arrangement, "brute_force", physics=PushPhysics(friction=0.01), **COARSE)
    rough = plan_push(arrangement, "brute_force", physics=PushPhysics(friction=1.0), **COARSE)
    assert slippery.expected_gain != rough.expected_gain


def test_failed_simulations_are_counted_and_never_returned(monkeypatch):
    arrangement = clutter(3, 3)
    monkeypatch.setattr(
        brute_force, "simulated_changes", lambda task, candidates, chosen, starts: np.full(len(chosen), np.nan)
    )
    with pytest.raises(SingulationError, match="could not be simulated") as caught:
        plan_push(arrangement, "brute_force", **COARSE)
    assert caught.value.code is ResultCode.NO_PUSH
    monkeypatch.undo()
    assert math.isfinite(plan_push(arrangement, "brute_force", **COARSE).expected_gain)


def test_the_best_mode_is_the_best_of_the_three():
    modes = set()
    for seed in range(6):
        arrangement = clutter(5, seed)
        push = plan_push(arrangement, best_contact_mode=True)
        changes = {mode: change(arrangement, plan_push(arrangement, contact_mode=mode)) for mode in ContactMode}
        assert change(arrangement, push) == pytest.approx(max(changes.values()), rel=0.05, abs=1e-4)
        assert push.expected_gain == pytest.approx(gain(arrangement, push), rel=0.05, abs=1e-4)
        modes.add(push.contact_mode)
    assert len(modes) > 1


def test_the_best_mode_says_why_there_is_none():
    crowded = squares([(0.0201 * column, 0.0201 * row) for column in range(2) for row in range(2)])
    tight = np.array(((-0.0102, -0.0102), (0.0303, -0.0102), (0.0303, 0.0303), (-0.0102, 0.0303)))
    with pytest.raises(SingulationError, match="in the way") as caught:
        plan_push(crowded, best_contact_mode=True, workspace=tight)
    assert caught.value.code is ResultCode.NO_PUSH
    assert plan_push(crowded, best_contact_mode=True).policy == "cluster_push"
