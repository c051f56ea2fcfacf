"""What is refused before anything moves; a good push works after each."""

import dataclasses

import numpy as np
import pytest

from singulation_core import Arrangement, CellGeometry, ContactMode, InvalidInputError, ResultCode, SingulationError
from yumi_push_executor import MotionParameters, plan_motion
from yumi_push_executor.clearance import Margins
from yumi_push_executor.kinematics import CLEAR_VIEW
from yumi_push_executor.supervision import Phase


@pytest.fixture
def refused(push_of):
    """Code and text of the refusal of a push; then a good push is planned."""

    def plan(push, arrangement=None, **settings):
        with pytest.raises(SingulationError) as caught:
            plan_motion(push, arrangement, **settings)
        assert plan_motion(push_of()).duration > 0.0
        return caught.value.code, caught.value.message

    return plan


@pytest.mark.parametrize("start, end, which", [((-0.17, 0.0), (0.0, 0.0), "start"), ((0.0, 0.0), (0.0, 0.25), "end")])
def test_outside_the_workspace_with_the_end_and_the_distance(refused, push_of, start, end, which):
    code, text = refused(push_of(start=start, end=end))
    assert code is ResultCode.PUSH_OUTSIDE_WORKSPACE
    assert f"the {which} of the push" in text and ("10.0 mm" in text or "40.0 mm" in text)


def test_on_the_border_is_inside(push_of):
    assert plan_motion(push_of(start=(-0.16, -0.21), end=(-0.16, -0.15))).arm == "right"


@pytest.mark.parametrize("mode, width", [(ContactMode.TWO_POINT, 0.0563), (ContactMode.EDGE, 0.013)])
def test_jaws_too_narrow(refused, push_of, mode, width):
    code, text = refused(push_of(mode, width=width))
    assert code is ResultCode.CONTACT_WIDTH
    assert f"{width * 1e3:.1f} mm" in text


def test_fully_open_jaws_are_fine(push_of):
    assert plan_motion(push_of(ContactMode.TWO_POINT, width=0.0562)).opening == pytest.approx(0.05)


def test_a_workspace_beyond_the_arms_names_the_arm_and_the_miss(refused, push_of):
    cell = dataclasses.replace(CellGeometry(), table_position=(0.9, 0.0, 0.04))
    code, text = refused(push_of(), cell=cell)
    assert code is ResultCode.UNREACHABLE
    assert "arm" in text and "mm" in text


def test_a_push_that_leaves_the_reach_on_its_way_names_the_way_point(refused, push_of):
    cell = dataclasses.replace(CellGeometry(), table_position=(0.55, 0.0, 0.04))
    code, text = refused(push_of(start=(-0.05, 0.1), end=(0.155, 0.1)), cell=cell)
    assert code is ResultCode.UNREACHABLE
    assert "way-point" in text


def test_a_start_on_a_block_names_finger_block_and_distance(refused, push_of, block):
    code, text = refused(push_of(), Arrangement([block(7, -0.03, 0.0)]))
    assert code is ResultCode.PATH_BLOCKED
    assert "block 7" in text and "finger" in text and "mm apart" in text


def test_a_block_too_tall_for_the_palm(refused, push_of, block):
    code, text = refused(push_of(), Arrangement([block(3, 0.03, 0.0, height=0.1)]))
    assert code is ResultCode.PATH_BLOCKED
    assert "tool0 and block 3" in text


def test_a_block_of_unknown_height_counts_as_tall(refused, push_of, block):
    arrangement = Arrangement([block(3, 0.03, 0.0, height=0.0)])
    code, _ = refused(push_of(), arrangement)
    assert code is ResultCode.PATH_BLOCKED
    assert plan_motion(push_of(), arrangement, parameters=MotionParameters(unknown_height=0.03)).arm


def test_a_narrow_gap_takes_the_single_point_sideways_or_not_at_all(refused, push_of, block):
    def gap(width):
        return Arrangement([block(1, -0.03, 0.018 + width / 2), block(2, -0.03, -0.018 - width / 2)])

    assert plan_motion(push_of(), gap(0.016)).arm
    code, text = refused(push_of(), gap(0.0125))
    assert code is ResultCode.PATH_BLOCKED and "start of the push" in text


def test_the_other_arm_in_the_way(refused, push_of):
    standing = plan_motion(push_of(), arms=("left",)).segment(Phase.PUSH).trajectory.end
    joints = {"left": standing, "right": CLEAR_VIEW["right"]}
    code, text = refused(push_of(), joints=joints, arms=("right",))
    assert code is ResultCode.PATH_BLOCKED
    assert "right" in text and "left" in text and "candidates tried" in text


@pytest.mark.parametrize(
    "joints",
    [
        {"left": CLEAR_VIEW["left"]},
        {"left": np.full(7, np.nan), "right": CLEAR_VIEW["right"]},
        {"left": np.zeros(6), "right": CLEAR_VIEW["right"]},
    ],
)
def test_joint_angles_that_are_none(refused, push_of, joints):
    code, _ = refused(push_of(), joints=joints)
    assert code is ResultCode.INVALID_INPUT


@pytest.mark.parametrize("arms", [(), ("middle",)])
def test_no_such_arm(refused, push_of, arms):
    assert refused(push_of(), arms=arms)[0] is ResultCode.INVALID_INPUT


@pytest.mark.parametrize(
    "field, value",
    [
        ("push_speed", 0.3),
        ("approach_speed", float("nan")),
        ("tip_height", 0.001),
        ("travel_height", 0.01),
        ("velocity_share", 1.5),
        ("joint_acceleration", (1.0, 2.0)),
        ("joint_acceleration", (1.0,) * 6 + (0.0,)),
    ],
)
def test_parameters_out_of_range_name_the_field(field, value):
    with pytest.raises(InvalidInputError, match=field):
        MotionParameters(**{field: value})
    assert MotionParameters().push_speed == 0.05


def test_margins_out_of_range_name_the_field():
    with pytest.raises(InvalidInputError, match="other_arm"):
        Margins(other_arm=-0.001)
    assert Margins().other_arm > 0.0
