"""The policy rollout_push: what it promises about its answers."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from singulation_core import ContactMode, InvalidInputError, ResultCode, SingulationError, singulation_distance
from singulation_core.push_world import PushPhysics, simulate_push
from singulation_planner import plan_push
from singulation_planner.testing import clutter, squares

OBJECTIVES = ("singulation_distance", "clearance")


def plan(arrangement, **options):
    return plan_push(arrangement, "rollout_push", **options)


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
