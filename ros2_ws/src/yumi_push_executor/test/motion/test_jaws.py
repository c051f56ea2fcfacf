"""How the jaws stand for a push."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from singulation_core import ContactMode, Push, PusherGeometry
from singulation_core.push_world import pusher_footprint
from singulation_core.transforms import pose_matrix
from yumi_push_executor import MotionParameters
from yumi_push_executor.motion.jaws import headings, middle_line, opening, tool_pose

ANGLES = st.floats(-7.0, 7.0)
FINGER = 0.0062  # m; thickness of one finger along the closing direction, half of the closed pair's


def push(mode, angle, width):
    return Push(np.zeros(2), 0.05 * np.array((np.cos(angle), np.sin(angle))), mode, width)


@given(st.sampled_from((ContactMode.EDGE, ContactMode.TWO_POINT)), ANGLES)
def test_edge_and_two_points_close_across_the_push_in_two_ways(mode, angle):
    one, other = headings(push(mode, angle, 0.01))
    for heading in (one, other):
        closing = np.array((np.cos(heading), np.sin(heading)))
        assert abs(closing @ push(mode, angle, 0.01).direction) < 1e-9
    assert abs(one - other) == pytest.approx(np.pi)


@given(ANGLES)
def test_single_point_may_turn_all_around(angle):
    found = np.sort(np.mod(headings(push(ContactMode.SINGLE_POINT, angle, 0.0)), 2 * np.pi))
    assert np.diff(found).max() <= np.deg2rad(30.0) + 1e-9
    assert len(found) == 12


@given(st.floats(1e-4, 0.05), ANGLES)
def test_only_two_points_open_the_jaws(width, angle):
    middles = opening(push(ContactMode.TWO_POINT, angle, width), PusherGeometry()) + FINGER
    assert middles == pytest.approx(max(width, FINGER))
    assert opening(push(ContactMode.SINGLE_POINT, angle, 0.0), PusherGeometry()) == 0.0
    assert opening(push(ContactMode.EDGE, angle, min(width, 0.0124)), PusherGeometry()) == 0.0


@given(st.sampled_from(list(ContactMode)), ANGLES)
def test_the_jaws_front_is_where_the_push_physics_has_it(mode, angle):
    asked, pusher = push(mode, angle, 0.0 if mode is ContactMode.SINGLE_POINT else 0.0124), PusherGeometry()
    line, along = middle_line(asked, pusher), asked.direction
    np.testing.assert_allclose(line.end - line.start, asked.end - asked.start, atol=1e-12)
    if mode is ContactMode.SINGLE_POINT:
        np.testing.assert_allclose(line.start, asked.start, atol=1e-12)
        return
    footprint = pusher_footprint(asked, pusher)
    parts = [one.x + one.radius for one in footprint.discs] + [one[:, 0].max() for one in footprint.polygons]
    np.testing.assert_allclose(line.start + 0.006 * along, asked.start + max(parts) * along, atol=1e-12)


@given(st.floats(0.007, 0.05))
def test_opened_fingers_stay_within_the_clearance_that_the_planner_keeps(width):
    asked, pusher = push(ContactMode.TWO_POINT, 0.0, width), PusherGeometry()
    gap, ahead = opening(asked, pusher), float(middle_line(asked, pusher).start[0])
    for disc in pusher_footprint(asked, pusher).discs:
        middle = np.sign(disc.y) * 0.5 * (gap + FINGER)
        corners = [(ahead + x, middle + y) for x in (-0.006, 0.006) for y in (-0.5 * FINGER, 0.5 * FINGER)]
        reach = max(float(np.hypot(x - disc.x, y - disc.y)) for x, y in corners)
        assert reach < pusher.tip_radius + pusher.tip_radius / 6.0 - MotionParameters().margins.descent


@given(st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2)), st.floats(0.0, 0.2), ANGLES, ANGLES)
def test_tips_stand_over_the_point_with_the_jaws_straight_down(point, height, heading, turn):
    table = pose_matrix((0.4, 0.1, 0.04), (0.0, 0.0, np.sin(turn / 2), np.cos(turn / 2)))
    pose = tool_pose(table, np.array(point), height, heading, 0.136)
    tip = np.linalg.inv(table) @ (pose @ np.array((0.0, 0.0, 0.136, 1.0)))
    np.testing.assert_allclose(tip[:3], (*point, height), atol=1e-12)
    np.testing.assert_allclose(pose[:3, 2], -table[:3, 2], atol=1e-12)
    closing = np.linalg.inv(table)[:3, :3] @ pose[:3, 0]
    np.testing.assert_allclose(closing, (np.cos(heading), np.sin(heading), 0.0), atol=1e-12)
    assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0)
