"""Forward kinematics against RobotStudio, ABB's Home, and Pinocchio."""

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st

from singulation_core import InvalidInputError
from singulation_core.transforms import inverse, pose_matrix
from yumi_push_executor import YumiArm
from yumi_push_executor.kinematics import CLEAR_VIEW, FOLDED, TIP_OFFSET
from yumi_push_executor.kinematics.model import arm_model, robot

HUNDREDTH_MM = 1e-5
ABB_ORDER = (0, 1, 6, 2, 3, 4, 5)  # where axes 1, 2, 7, 3, 4, 5, 6 stand when axis 7 comes last

# RobotStudio, single arm (IRB 14050): all joints at one angle [deg]; tool0 [mm]; fixed-axes roll, pitch, yaw [deg].
ROBOTSTUDIO = [
    (0, (341.5, 0.0, 598.0), (0.0, 90.0, 0.0)),
    (20, (292.46, 234.73, 348.75), (148.67, 16.13, 175.45)),
    (30, (165.49, 290.86, 255.37), (157.34, -19.80, -175.99)),
    (-40, (-219.17, 12.62, 796.12), (13.67, -3.39, -152.29)),
    (-80, (-126.60, 499.23, 441.88), (5.30, 17.08, 34.27)),
]


def kinematic(degrees):
    return np.deg2rad(np.array(degrees, dtype=float))[list(ABB_ORDER)]


def by_pinocchio(name, q):
    model = robot()
    data, full = model.createData(), np.zeros(model.nq)
    full[list(arm_model(name).positions)] = q
    pin.framesForwardKinematics(model, data, full)
    return data.oMf[model.getFrameId(f"{name}_tool0")].homogeneous


def joint_angles(name):
    arm = YumiArm(name)
    return st.tuples(*(st.floats(low, high) for low, high in zip(arm.lower, arm.upper, strict=True))).map(np.array)


@pytest.mark.parametrize("angle, position, rpy", ROBOTSTUDIO)
@pytest.mark.parametrize("name", ["left", "right"])
def test_chain_equals_robotstudio_within_a_hundredth_of_a_millimetre(name, angle, position, rpy):
    mount = np.eye(4)  # of the single arm: 206 mm up, turned by half a turn
    mount[:3, :3], mount[2, 3] = pin.rpy.rpyToMatrix(0.0, 0.0, np.pi), 0.206
    first = robot().jointPlacements[robot().getJointId(f"yumi_rob{name[0]}_joint_1")].homogeneous
    pose = mount @ inverse(first) @ YumiArm(name).forward(np.full(7, np.deg2rad(angle)))
    np.testing.assert_allclose(pose[:3, 3], np.array(position) * 1e-3, atol=HUNDREDTH_MM)
    turn = pose[:3, :3].T @ pin.rpy.rpyToMatrix(*np.deg2rad(rpy))
    assert np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1)) < np.deg2rad(0.01)


@pytest.mark.parametrize("name, side", [("left", 1.0), ("right", -1.0)])
def test_home_is_abbs_robtarget(name, side):
    # The same target stands in many RAPID programs: tool0 in wobj0, quaternion w, x, y, z.
    position = (-0.009578368507, side * 0.182609892723, 0.198627808149)
    quaternion = (side * 0.842420918, -0.111214912, side * 0.523068661, 0.066010726)
    q = kinematic((0, -130, 30, 0, 40, 0, side * 135))
    np.testing.assert_allclose(q, FOLDED[name], atol=1e-12)
    expected = pose_matrix(position, quaternion)
    pose = YumiArm(name).forward(q)
    np.testing.assert_allclose(pose[:3, 3], expected[:3, 3], atol=HUNDREDTH_MM)
    np.testing.assert_allclose(pose[:3, :3], expected[:3, :3], atol=2e-6)


def test_real_robot_with_its_tool_straight_down():
    # Recorded on a lab's robot, left arm; its positions are good to about 3 mm.
    q = kinematic((-62.62, -20.31, 44.91, 78.61, 74.79, -90.07, 36.71))
    pose = YumiArm("left").forward(q)
    np.testing.assert_allclose(pose[:3, 3], (0.3836, -0.0344, 0.4158), atol=0.004)
    assert pose[2, 2] < -0.999


@pytest.mark.parametrize("name", ["left", "right"])
@given(data=st.data())
def test_compiled_chain_equals_pinocchio(name, data):
    q = data.draw(joint_angles(name))
    np.testing.assert_allclose(YumiArm(name).forward(q), by_pinocchio(name, q), atol=1e-12)


@given(q=joint_angles("left"))
def test_jacobian_is_the_derivative_of_forward(q):
    arm, step = YumiArm("left"), 1e-6
    jacobian = arm.jacobian(q)
    for k in range(7):
        shift = np.eye(7)[k] * step
        plus, minus = arm.forward(q + shift), arm.forward(q - shift)
        np.testing.assert_allclose((plus[:3, 3] - minus[:3, 3]) / (2 * step), jacobian[:3, k], atol=1e-6)
        turn = pin.log3((plus[:3, :3] @ minus[:3, :3].T).copy()) / (2 * step)
        np.testing.assert_allclose(turn, jacobian[3:, k], atol=1e-6)


@given(q=joint_angles("left"))
def test_arms_are_mirror_images(q):
    mirror = np.array((-1, 1, -1, 1, -1, 1, -1))
    left, right = YumiArm("left").forward(q), YumiArm("right").forward(q * mirror)
    np.testing.assert_allclose(left[:3, 3] * (1, -1, 1), right[:3, 3], atol=1e-9)
    np.testing.assert_allclose(left[:3, 2] * (1, -1, 1), right[:3, 2], atol=1e-9)


def test_tip_lies_below_tool0_and_turns_about_the_last_axis():
    arm, q = YumiArm("left"), CLEAR_VIEW["left"]
    pose, tip = arm.forward(q), arm.tip(q)
    np.testing.assert_allclose(inverse(pose) @ tip[:, 3], (0, 0, TIP_OFFSET, 1), atol=1e-12)
    turned = q + np.array((0, 0, 0, 0, 0, 0, 0.5))
    np.testing.assert_allclose(arm.tip(turned)[:3, 3], tip[:3, 3], atol=1e-12)


def test_limits_are_those_of_abbs_controller():
    arm = YumiArm("right")
    degrees = np.rad2deg(np.column_stack((arm.lower, arm.upper)))
    expected = [(-168.5, 168.5), (-143.5, 43.5), (-168.5, 168.5), (-123.5, 80), (-290, 290), (-88, 138), (-229, 229)]
    np.testing.assert_allclose(degrees, expected, atol=1e-3)
    np.testing.assert_allclose(np.rad2deg(arm.velocity), (180, 180, 180, 180, 400, 400, 400), atol=1e-3)


@pytest.mark.parametrize("bad", [np.zeros(6), np.full(7, np.nan), np.zeros((7, 1)), [np.inf] * 7])
def test_angles_that_are_none_are_refused_and_good_ones_work_after(bad):
    arm = YumiArm("left")
    with pytest.raises(InvalidInputError, match="need 7 finite numbers"):
        arm.forward(bad)
    assert np.isfinite(arm.forward(np.zeros(7))).all()


def test_a_third_arm_is_refused():
    with pytest.raises(InvalidInputError, match="left and right"):
        YumiArm("middle")
    assert YumiArm("left").name == "left"
