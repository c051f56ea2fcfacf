"""Planning from wherever a stopped arm stands."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motion_figures import tips, tool_poses, trajectories

from singulation_core import Arrangement, ContactMode, ResultCode, SingulationError
from yumi_push_executor import plan_clear_view, plan_motion
from yumi_push_executor.clearance import parts_in_view
from yumi_push_executor.kinematics import CLEAR_VIEW, FOLDED
from yumi_push_executor.supervision import Phase

MOVING = (Phase.APPROACH, Phase.DESCEND, Phase.PUSH, Phase.RETREAT, Phase.CLEAR_VIEW)


def standing(motion, phase, share):
    """Joint angles of both arms when the motion was stopped."""
    trajectory = motion.segment(phase).trajectory
    return {**CLEAR_VIEW, motion.arm: trajectory.sample(share * trajectory.duration)[0][0]}


@settings(max_examples=25)
@given(st.sampled_from(MOVING), st.floats(0.0, 1.0), st.sampled_from(list(ContactMode)))
def test_the_next_push_is_planned_from_there_and_the_view_is_left(phase, share, mode):
    # Not a fixture: hypothesis draws many examples for one of them.
    from conftest import WIDTHS
    from singulation_core import PlanarObject, Push

    corners = 0.018 * np.array(((-1, -1), (1, -1), (1, 1), (-1, 1)))
    blocks = Arrangement(
        [PlanarObject(k, corners + at, height=0.03) for k, at in enumerate(((0.02, -0.02), (0.02, 0.02)))]
    )
    push = Push(np.array((-0.03, 0.0)), np.array((0.05, 0.0)), mode, WIDTHS[mode])
    first = plan_motion(push, blocks)
    joints = standing(first, phase, share)
    again = plan_motion(push, blocks, joints=joints)
    assert again.arm != first.arm or np.allclose(again.start, joints[first.arm], atol=1e-12)
    way = plan_clear_view(first.arm, blocks, joints=joints, opening=first.opening)
    np.testing.assert_allclose(way.start, joints[first.arm], atol=1e-12)
    assert not parts_in_view({first.arm: way.end})


def test_low_jaws_rise_straight_before_they_open_and_before_anything_else(push_of, cluster):
    first = plan_motion(push_of(), cluster, arms=("left",))
    joints = standing(first, Phase.PUSH, 0.5)
    again = plan_motion(push_of(ContactMode.TWO_POINT), cluster, joints=joints, arms=("left",))
    phases = [segment.phase for segment in again.segments]
    assert phases[:3] == [Phase.APPROACH, Phase.GRIPPER, Phase.APPROACH]
    rising = tips(tool_poses("left", trajectories(again)[0][1].positions))
    assert np.ptp(rising[:, :2], axis=0).max() < 1e-5
    assert rising[-1][2] > rising[0][2] + 0.04


def test_an_arm_beside_the_table_does_not_rise_first(push_of):
    phases = [segment.phase for segment in plan_motion(push_of(), joints=FOLDED).segments]
    assert phases[0] is Phase.GRIPPER


def test_an_arm_that_stands_in_the_other_is_refused_with_both_names(push_of):
    low = plan_motion(push_of(), arms=("left",)).segment(Phase.PUSH).trajectory.end
    crossing = plan_motion(push_of(), arms=("right",)).segment(Phase.PUSH).trajectory.end
    with pytest.raises(SingulationError) as caught:
        plan_clear_view("left", joints={"left": low, "right": crossing})
    assert caught.value.code is ResultCode.PATH_BLOCKED
    assert "left" in caught.value.message and "right" in caught.value.message
    assert plan_clear_view("left", joints={"left": low, "right": CLEAR_VIEW["right"]}).duration > 0.0
