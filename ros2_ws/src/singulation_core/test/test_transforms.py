"""Rigid transforms and the cell's geometry."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from singulation_core import CellGeometry, InvalidInputError
from singulation_core.transforms import inverse, pose_matrix, quaternion_of, transform_points

UNIT = st.floats(-1.0, 1.0)


@st.composite
def quaternions(draw):
    values = np.array([draw(UNIT) for _ in range(4)])
    assume(np.linalg.norm(values) > 0.1)
    return values / np.linalg.norm(values)


@given(quaternions(), UNIT, UNIT, UNIT)
def test_poses_are_rigid_and_their_inverse_undoes_them(quaternion, x, y, z):
    pose = pose_matrix((x, y, z), quaternion)
    assert pose[:3, :3] @ pose[:3, :3].T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0)
    assert inverse(pose) @ pose == pytest.approx(np.eye(4), abs=1e-12)


@given(quaternions())
def test_quaternion_and_matrix_belong_together(quaternion):
    found = quaternion_of(pose_matrix((0.0, 0.0, 0.0), quaternion))
    assert found[3] >= 0.0
    assert abs(float(found @ quaternion)) == pytest.approx(1.0, abs=1e-9)


def test_a_quarter_turn_about_z():
    pose = pose_matrix((1.0, 2.0, 3.0), (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    points = np.array((((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),))
    assert transform_points(pose, points) == pytest.approx(np.array((((1.0, 3.0, 3.0), (0.0, 2.0, 3.0)),)))


@pytest.mark.parametrize(
    ("position", "quaternion"),
    [
        ((0.0, 0.0), (0.0, 0.0, 0.0, 1.0)),
        ((0.0, 0.0, math.nan), (0.0, 0.0, 0.0, 1.0)),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.1)),
        ((0.0, 0.0, 0.0), (0.0, 0.0, math.inf, 1.0)),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    ],
)
def test_malformed_poses_are_refused(position, quaternion):
    with pytest.raises(InvalidInputError, match="pose"):
        pose_matrix(position, quaternion)
    assert pose_matrix((0.0, 0.0, 0.0)) == pytest.approx(np.eye(4))


def test_the_camera_looks_down_at_the_middle_of_the_table():
    camera = CellGeometry().table_from_camera
    origin, sight = camera[:3, 3], camera[:3, 2]
    hit = origin - origin[2] / sight[2] * sight
    assert hit == pytest.approx(np.zeros(3), abs=1e-9)
    assert sight[2] < -0.9
    assert camera[:3, 0] == pytest.approx((0.0, -1.0, 0.0), abs=1e-9)  # image right is -y of the table
    assert (-camera[:3, 1])[0] > 0.9  # image top is the far side, +x


def test_the_workspace_is_the_bin_of_the_lab():
    cell = CellGeometry()
    corners = np.column_stack((cell.workspace_polygon, np.zeros(4)))
    in_body = transform_points(cell.body_from_table, corners)
    assert in_body.min(axis=0) == pytest.approx((0.23, -0.22, 0.04))
    assert in_body.max(axis=0) == pytest.approx((0.55, 0.20, 0.04))
