"""What is promised of every planned motion."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from motion_figures import STEP, off_line, sampled, smallest_distance, tips, tool_poses, trajectories

from singulation_core import Arrangement, CellGeometry, ContactMode, Push, PusherGeometry
from yumi_push_executor import MotionParameters, YumiArm, plan_motion
from yumi_push_executor.clearance import parts_in_view
from yumi_push_executor.kinematics import CLEAR_VIEW
from yumi_push_executor.motion.jaws import middle_line
from yumi_push_executor.supervision import Phase

ORDER = [Phase.GRIPPER, Phase.APPROACH, Phase.DESCEND, Phase.PUSH, Phase.RETREAT, Phase.CLEAR_VIEW]
CELL, PUSHER, PARAMETERS = CellGeometry(), PusherGeometry(), MotionParameters()
X_MIN, X_MAX, Y_MIN, Y_MAX = CELL.workspace


def in_body(point, height):
    pose = CELL.body_from_table
    return pose[:3, :2] @ point + pose[:3, 3] + height * pose[:3, 2]


def check_joints(motion):
    arm, before = YumiArm(motion.arm), CLEAR_VIEW[motion.arm]
    for _, trajectory in trajectories(motion):
        positions, velocities = sampled(trajectory)
        np.testing.assert_allclose(positions[0], before, atol=1e-9)
        before = positions[-1]
        assert (positions >= arm.lower + PARAMETERS.limit_margin - 1e-9).all()
        assert (positions <= arm.upper - PARAMETERS.limit_margin + 1e-9).all()
        assert (np.abs(velocities) <= PARAMETERS.velocity_share * arm.velocity + 1e-9).all()
        accelerations = np.abs(np.diff(velocities, axis=0)) / STEP
        assert (accelerations <= np.array(PARAMETERS.joint_acceleration) * 1.001).all()
        assert np.abs(np.diff(positions, axis=0)).max() < 0.02  # no jump to another branch
        assert np.abs(velocities[[0, -1]]).max() < 1e-9
    np.testing.assert_allclose(before, CLEAR_VIEW[motion.arm], atol=1e-9)


def check_lines(motion):
    push, high, low = middle_line(motion.push, PUSHER), PARAMETERS.travel_height, PARAMETERS.tip_height
    start, end, up = in_body(push.start, low), in_body(push.end, low), np.array((0.0, 0.0, 1.0))
    along = (end - start) / push.length
    expected = {Phase.DESCEND: (start, up), Phase.PUSH: (start, along), Phase.RETREAT: (end, up)}
    for phase, trajectory in trajectories(motion):
        poses = tool_poses(motion.arm, sampled(trajectory)[0])
        points = tips(poses)
        speed = np.linalg.norm(np.diff(points, axis=0), axis=1) / STEP
        if phase not in expected:
            assert speed.max() <= PARAMETERS.approach_speed * 1.001
            continue
        assert off_line(points, *expected[phase]) <= PARAMETERS.straightness
        assert poses[:, 2, 2].max() < -np.cos(np.deg2rad(0.05))
        if phase is Phase.PUSH:
            np.testing.assert_allclose(points[[0, -1]], (start, end), atol=1e-5)
            check_push(motion, poses, speed, along)
        else:
            assert speed.max() <= PARAMETERS.vertical_speed * 1.001
            assert max(points[0][2], points[-1][2]) >= CELL.table_position[2] + high - 1e-6


def check_push(motion, poses, speed, along):
    steady = speed[speed > 0.99 * speed.max()]
    assert speed.max() <= PARAMETERS.push_speed * 1.001
    assert steady.sum() * STEP >= motion.push.length - 2 * PARAMETERS.push_speed**2 / PARAMETERS.linear_acceleration
    if motion.push.contact_mode is not ContactMode.SINGLE_POINT:
        assert np.abs(poses[:, :3, 0] @ along).max() < 1e-3  # the jaws close across the push
    two = motion.push.contact_mode is ContactMode.TWO_POINT
    wanted = max(motion.push.contact_width - 0.5 * PUSHER.edge_width, 0.0) if two else 0.0
    assert motion.opening == wanted == motion.segment(Phase.GRIPPER).opening


@pytest.mark.parametrize("mode", list(ContactMode))
@pytest.mark.parametrize("arm", ["left", "right"])
def test_each_contact_mode_on_each_arm_keeps_every_promise(mode, arm, push_of, cluster):
    motion = plan_motion(push_of(mode), cluster, arms=(arm,))
    assert [segment.phase for segment in motion.segments] == ORDER
    assert {segment.arm for segment in motion.segments} == {arm}
    check_joints(motion)
    check_lines(motion)
    distance, what = smallest_distance(motion, cluster, CELL, PUSHER)
    assert distance > 0.0, what
    assert not parts_in_view({arm: trajectories(motion)[-1][1].end})


@settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.sampled_from(list(ContactMode)),
    st.tuples(st.floats(X_MIN, X_MAX), st.floats(Y_MIN, Y_MAX)),
    st.tuples(st.floats(X_MIN, X_MAX), st.floats(Y_MIN, Y_MAX)),
    st.floats(0.001, 0.05),
)
def test_any_push_inside_the_workspace_is_planned_and_keeps_its_promises(mode, start, end, width):
    if np.hypot(start[0] - end[0], start[1] - end[1]) < 0.002:
        end = (-0.5 * start[0] + 0.01, -0.5 * start[1])
    widths = {ContactMode.SINGLE_POINT: 0.0, ContactMode.EDGE: PUSHER.edge_width, ContactMode.TWO_POINT: width}
    motion = plan_motion(Push(np.array(start), np.array(end), mode, widths[mode]))
    check_joints(motion)
    check_lines(motion)


def test_the_nearer_arm_is_chosen(push_of):
    assert plan_motion(push_of(start=(0.0, 0.15), end=(0.05, 0.15))).arm == "left"
    assert plan_motion(push_of(start=(0.0, -0.15), end=(0.05, -0.15))).arm == "right"


def test_either_arm_reaches_the_other_side(push_of):
    for y, arm in ((0.19, "right"), (-0.19, "left")):
        assert plan_motion(push_of(start=(-0.1, y), end=(0.0, y)), arms=(arm,)).arm == arm


def test_slower_settings_are_kept(push_of):
    slow = MotionParameters(push_speed=0.01, approach_speed=0.05, vertical_speed=0.02)
    motion = plan_motion(push_of(), parameters=slow)
    speeds = {
        phase: np.linalg.norm(np.diff(tips(tool_poses(motion.arm, sampled(one)[0])), axis=0), axis=1).max() / STEP
        for phase, one in trajectories(motion)
    }
    assert speeds[Phase.PUSH] == pytest.approx(0.01, rel=1e-3)
    assert max(speeds[Phase.DESCEND], speeds[Phase.RETREAT]) == pytest.approx(0.02, rel=1e-3)
    assert max(speeds[Phase.APPROACH], speeds[Phase.CLEAR_VIEW]) <= 0.05


def test_a_tilted_table_gets_a_tilted_push(push_of):
    tilt = np.deg2rad(2.0)
    cell = CellGeometry(table_quaternion=(float(np.sin(tilt / 2)), 0.0, 0.0, float(np.cos(tilt / 2))))
    motion = plan_motion(push_of(ContactMode.EDGE), cell=cell)
    poses = tool_poses(motion.arm, sampled(motion.segment(Phase.PUSH).trajectory)[0])
    pose = cell.body_from_table
    np.testing.assert_allclose(poses[:, :3, 2], np.repeat(-pose[None, :3, 2], len(poses), axis=0), atol=1e-6)
    heights = (tips(poses) - pose[:3, 3]) @ pose[:3, 2]
    np.testing.assert_allclose(heights, PARAMETERS.tip_height, atol=1e-4)


def test_the_same_request_gives_the_same_motion(push_of, cluster):
    first, second = (plan_motion(push_of(), cluster) for _ in range(2))
    for (_, a), (_, b) in zip(trajectories(first), trajectories(second), strict=True):
        np.testing.assert_array_equal(a.positions, b.positions)


def test_travel_is_above_the_tallest_block(push_of, block):
    tall = Arrangement([block(1, 0.1, 0.1, height=0.09)])
    motion = plan_motion(push_of(), tall)
    top = tips(tool_poses(motion.arm, motion.segment(Phase.DESCEND).trajectory.positions[:1]))[0]
    assert top[2] - CELL.table_position[2] >= 0.09 + PARAMETERS.travel_clearance - 1e-6
