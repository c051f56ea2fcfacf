"""The policy rollout_push: what it promises about its answers."""

import itertools
import math
from collections import Counter

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import (
    ContactMode,
    InvalidInputError,
    PusherGeometry,
    ResultCode,
    SingulationError,
    singulation_distance,
    smallest_gap,
)
from singulation_core.push_world import PushPhysics, simulate_push
from singulation_core.push_world.compiled import DIVERGED, CompiledWorld
from singulation_planner import plan_push
from singulation_planner.placement import Placement
from singulation_planner.placer import NOT_SIMULATED
from singulation_planner.rollout.judge import Judge
from singulation_planner.rollout.options import Options
from singulation_planner.testing import clutter, squares

OBJECTIVES = ("singulation_distance", "clearance")


def plan(arrangement, **options):
    """Limited by work alone: the processor time of a first call also loads compiled code."""
    return plan_push(arrangement, "rollout_push", **{"budget": 1e6, **options})


def gain_of(push, arrangement):
    unit = float(arrangement.bounding_radii.mean())
    before, after = singulation_distance(arrangement, unit), singulation_distance(push.expected, unit)
    return (after - before) / before


@pytest.mark.parametrize("mode", list(ContactMode))
@pytest.mark.parametrize("objective", OBJECTIVES)
def test_the_answer_tells_what_it_expects(objective, mode):
    scene = clutter(6, 3)
    push = plan(scene, contact_mode=mode, objective=objective)
    assert push.expected_gain == pytest.approx(gain_of(push, scene), rel=1e-6)
    found = simulate_push(scene, push, PushPhysics.fine())
    ids = [item.id for item in scene.objects]
    assert [item.id for item in push.expected.objects] == [item.id for item in found.objects] == ids
    errors = np.hypot(*(push.expected.centroids - found.centroids).T) / scene.bounding_radii
    assert np.median(errors) < 0.05


def test_without_a_budget_the_score_decides_and_nothing_is_promised():
    push = plan(clutter(6, 3), budget=0)
    assert math.isnan(push.expected_gain)
    assert push.expected is None
    assert push.policy == "rollout_push"


@settings(max_examples=10, deadline=None)
@given(st.integers(2, 9), st.integers(0, 10**6), st.sampled_from(list(ContactMode)))
def test_more_work_never_expects_less(count, seed, mode):
    scene = clutter(count, seed)
    gains = [plan(scene, contact_mode=mode, rollouts=limit).expected_gain for limit in (1, 3, 8, 30, 64, 100, 250)]
    sign = 1.0 if singulation_distance(scene) > 0.0 else -1.0
    assert all(sign * later >= sign * earlier - 1e-7 for earlier, later in itertools.pairwise(gains))


def test_bad_options_are_named():
    scene = squares([(0.0, 0.0), (0.025, 0.0), (0.01, 0.03)])
    bad = {"budget": -1.0, "rollouts": 0, "objective": "speed", "clearance_width": float("nan"), "worlds": 0}
    for name, value in bad.items():
        with pytest.raises(InvalidInputError, match=name):
            plan(scene, **{name: value})
    with pytest.raises(SingulationError) as caught:
        plan(scene, min_gap=0.0)
    assert caught.value.code is ResultCode.NOTHING_TO_DO
    assert plan(scene, budget="5", objective="clearance").target_id in (0, 1, 2)


def test_in_sampled_worlds_the_same_seed_gives_the_same_push():
    scene = clutter(5, 7)
    first, second, other = (plan(scene, worlds=4, rollouts=150, seed=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first.start, second.start)
    assert first.expected_gain == second.expected_gain != other.expected_gain


def test_more_work_in_sampled_worlds_never_expects_less():
    scene = clutter(5, 11)
    gains = [plan(scene, worlds=4, rollouts=limit).expected_gain for limit in (6, 80, 110, 140, 260)]
    assert all(later >= earlier - 1e-9 for earlier, later in itertools.pairwise(gains))


def gap_at_start(push, scene):
    tip = PusherGeometry().tip_radius
    outlines = (item.outline.astype(np.float32) for item in scene.objects)
    x, y = (float(value) for value in push.start)
    return min(-cv2.pointPolygonTest(outline, (x, y), True) for outline in outlines) - tip


def test_in_sampled_worlds_starts_leave_room_for_what_is_not_known():
    scenes = [clutter(6, seed) for seed in range(5)]
    room = [0.05 * np.mean([item.bounding_radius for item in scene.objects]) for scene in scenes]
    near = Placement(clearance=2e-4)
    alone = [gap_at_start(plan(scene, rollouts=30, placement=near), scene) for scene in scenes]
    sampled = [gap_at_start(plan(scene, rollouts=60, placement=near, worlds=2), scene) for scene in scenes]
    assert all(gap >= least - 1e-6 for gap, least in zip(sampled, room, strict=True))
    assert any(gap < least - 1e-6 for gap, least in zip(alone, room, strict=True))


def test_where_there_is_no_such_room_narrower_starts_are_taken(monkeypatch):
    scene, half = clutter(5, 7), 0.4
    table = [(-half, -half), (half, -half), (half, half), (-half, half)]
    monkeypatch.setattr(Options, "start_room", 1000.0)
    push = plan(scene, worlds=2, rollouts=40, workspace=table)
    assert gap_at_start(push, scene) > 0.0


def test_looking_ahead_takes_a_push_that_leads_further():
    scene = clutter(5, 3)
    options = {"objective": "clearance", "budget": 60000.0}
    greedy, ahead = plan(scene, **options), plan(scene, look_ahead=2, rollouts=600, **options)
    following = [plan(one.expected, **options).expected for one in (greedy, ahead)]
    assert smallest_gap(following[1]) >= smallest_gap(following[0]) - 1e-3
    with pytest.raises(InvalidInputError, match="look_ahead"):
        plan(scene, look_ahead=2, worlds=2)


def test_simulations_that_fail_are_left_out_and_counted(monkeypatch):
    scene, rejected = clutter(4, 1), []
    roll_out = CompiledWorld.roll_out

    def blown_up(self, starts, ends):
        poses, codes = roll_out(self, starts, ends)
        if len(poses) > 1:  # not where a push is looked at again
            poses[::2], codes[::2] = np.nan, DIVERGED
        return poses, codes

    outcomes = Judge.outcomes

    def counted(self, proposals):
        found = outcomes(self, proposals)
        rejected.append(Counter(self.placer.rejected)[NOT_SIMULATED])
        return found

    monkeypatch.setattr(CompiledWorld, "roll_out", blown_up)
    monkeypatch.setattr(Judge, "outcomes", counted)
    push = plan(scene, rollouts=20)
    assert push.expected is not None
    assert rejected[-1] >= 9
    monkeypatch.setattr(CompiledWorld, "roll_out", lambda self, starts, ends: (np.full((len(starts), 4, 3), np.nan), 0))
    assert plan(scene, rollouts=20).expected is None
    monkeypatch.undo()
    assert plan(scene, rollouts=20).expected is not None


def test_the_contact_mode_with_the_best_value_is_chosen():
    scene = clutter(6, 5)
    gains = {mode: plan(scene, contact_mode=mode, rollouts=40).expected_gain for mode in ContactMode}
    best = plan(scene, best_contact_mode=True, rollouts=120)
    assert best.contact_mode is max(gains, key=gains.__getitem__)
    assert best.expected_gain == max(gains.values())


@pytest.mark.parametrize("budget", [0.0, 1e6])
def test_blocks_with_room_enough_are_left_alone(budget):
    """Spreading those too would gain distance for ever, while the two that touch stay together."""
    scene = squares([(0.0, 0.0), (0.0201, 0.003), (0.06, 0.08), (-0.05, 0.09), (0.07, -0.06)])
    push = plan(scene, objective="clearance", budget=budget)
    assert push.target_id in (0, 1)
