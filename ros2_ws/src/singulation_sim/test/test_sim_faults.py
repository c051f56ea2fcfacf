"""Every fault: what happens, and that the next good order works after a reset."""

import numpy as np
import pytest
from singulation_msgs.msg import DriverState

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_sim.driver import FAULTS, PERIOD, DriverMode, JointTrajectory, SimulatedDriver
from singulation_sim.driver.states import JointStates
from singulation_sim.driver.trajectory import point
from yumi_push_executor.kinematics import YumiArm

SPEED = 0.2  # rad/s of the motion that faults interrupt
STOPS = {
    "emergency_stop": DriverMode.EMERGENCY_STOP,
    "guard_stop": DriverMode.GUARD_STOP,
    "motors_off": DriverMode.MOTORS_OFF,
    "system_failure": DriverMode.SYSTEM_FAILURE,
}


def joint(driver: SimulatedDriver) -> float:
    return float(driver.arms["left"].positions[1])


def run(driver: SimulatedDriver, seconds: float) -> list[float]:
    """Way of the joint while time passes."""
    way = []
    for _ in range(round(seconds / PERIOD)):
        driver.step()
        way.append(joint(driver))
    return way


def order(driver: SimulatedDriver, change: float = SPEED * 5.0, seconds: float = 5.0) -> float:
    """Start a motion of constant speed; its target."""
    target = np.array(driver.arms["left"].positions)
    target[1] += change
    driver.command_arm("left", JointTrajectory(driver.settings.joints["left"], [point(seconds, target)]))
    return float(target[1])


def states(driver: SimulatedDriver) -> JointStates:
    shown = driver.joint_states()
    assert shown is not None
    return shown


@pytest.fixture
def moving(exact_driver: SimulatedDriver) -> SimulatedDriver:
    """A driver whose left arm moves at ``SPEED``."""
    order(exact_driver)
    run(exact_driver, 0.5)
    return exact_driver


def works_again(driver: SimulatedDriver) -> None:
    """After a reset nothing moves by itself, and the next order is carried out."""
    driver.reset()
    assert driver.status.mode is DriverMode.MOTORS_ON
    assert driver.status.motion_enabled
    before = joint(driver)
    assert run(driver, 0.5)[-1] == pytest.approx(before, abs=1e-6)
    target = order(driver, 0.1, 0.3)
    run(driver, 0.5)
    assert joint(driver) == pytest.approx(target, abs=1e-6)
    driver.command_gripper("left", 0.01)
    run(driver, 0.5)
    assert driver.arms["left"].gripper.opening == pytest.approx(0.01)
    assert np.isfinite(states(driver).positions).all()


def works_again_downwards(driver: SimulatedDriver) -> None:
    """As ``works_again`` for an arm that stands at the upper end of its range."""
    driver.reset()
    target = order(driver, -0.2, 0.5)
    run(driver, 0.7)
    assert joint(driver) == pytest.approx(target, abs=1e-6)
    works_again(driver)


def test_modes_are_those_of_the_message() -> None:
    constants = {name: getattr(DriverState, name) for name in dir(DriverState) if name.isupper()}
    assert {mode.name: int(mode) for mode in DriverMode} == {k: v for k, v in constants.items() if isinstance(v, int)}


@pytest.mark.parametrize(("fault", "mode"), STOPS.items())
def test_a_stop_brakes_and_release_does_not_resume(moving: SimulatedDriver, fault: str, mode: DriverMode) -> None:
    moving.inject(fault, 0.5)
    way = run(moving, 0.4)
    assert moving.status.mode is mode
    assert not moving.status.motion_enabled
    # 0.2 rad/s braked at 20 rad/s^2 is 10 ms and 1 mrad.
    assert way[5:] == pytest.approx([way[5]] * len(way[5:]))
    assert way[-1] - way[0] < 0.002
    with pytest.raises(SingulationError) as failure:
        order(moving)
    assert failure.value.code is ResultCode.REJECTED
    after_release = run(moving, 2.0)
    assert moving.status.mode is DriverMode.MOTORS_OFF
    assert "reset needed" in moving.status.message
    assert np.ptp(after_release) == 0.0
    works_again(moving)


def test_a_stop_without_release_stays(moving: SimulatedDriver) -> None:
    moving.inject("emergency_stop")
    run(moving, 30.0)
    assert moving.status.mode is DriverMode.EMERGENCY_STOP
    works_again(moving)


def test_a_collision_stops_backs_off_and_is_acknowledged(moving: SimulatedDriver) -> None:
    at = joint(moving)
    moving.inject("collision", 0.3)
    assert not moving.status.motion_enabled
    way = run(moving, 0.25)
    assert max(way) > at
    assert at - way[-1] == pytest.approx(moving.settings.back_off, abs=0.002)
    assert moving.status.mode is DriverMode.COLLISION_STOP
    with pytest.raises(SingulationError):
        order(moving)
    stood = run(moving, 1.0)
    assert np.ptp(stood) < 1e-6
    assert (moving.status.mode, moving.status.motion_enabled) == (DriverMode.MOTORS_ON, True)
    target = order(moving, 0.1, 0.3)  # the retreat needs no reset
    assert run(moving, 0.5)[-1] == pytest.approx(target, abs=1e-6)
    works_again(moving)


def test_a_collision_can_wait_for_a_reset(moving: SimulatedDriver) -> None:
    moving.inject("collision", -1.0)
    run(moving, 20.0)
    assert (moving.status.mode, moving.status.motion_enabled) == (DriverMode.COLLISION_STOP, False)
    works_again(moving)


def test_a_standing_arm_does_not_back_off(exact_driver: SimulatedDriver) -> None:
    order(exact_driver, 0.3, 0.5)
    run(exact_driver, 1.0)
    before = joint(exact_driver)
    exact_driver.inject("collision")
    assert np.ptp([before, *run(exact_driver, 2.0)]) == 0.0
    works_again(exact_driver)


def test_without_link_the_arm_moves_on_until_the_session_ends(moving: SimulatedDriver) -> None:
    at, before = joint(moving), states(moving)
    moving.inject("egm_timeout", 0.4)
    order(moving, -0.1, 0.1)  # does not arrive
    run(moving, 0.2)
    assert (states(moving).positions == before.positions).all()
    assert moving.status.motion_enabled
    run(moving, 0.5)
    assert joint(moving) - at == pytest.approx(SPEED * 0.4, abs=0.005)
    assert (moving.status.mode, moving.status.motion_enabled) == (DriverMode.MOTORS_ON, False)
    assert "41822" in moving.status.message
    assert states(moving).positions[1] == pytest.approx(joint(moving))
    assert np.ptp(run(moving, 1.0)) == 0.0
    works_again(moving)


def test_without_link_the_arm_does_not_leave_its_range(exact_driver: SimulatedDriver) -> None:
    upper = YumiArm("left").upper
    order(exact_driver, float(upper[1]) - 0.02 - joint(exact_driver), 2.0)
    run(exact_driver, 1.9)
    exact_driver.inject("egm_timeout", 2.0)
    run(exact_driver, 1.9)
    assert upper[1] - 0.02 < joint(exact_driver) <= upper[1]
    run(exact_driver, 0.2)
    works_again_downwards(exact_driver)


def test_frozen_states_repeat_while_the_arm_moves(moving: SimulatedDriver) -> None:
    before, at = states(moving), joint(moving)
    moving.inject("freeze_states", 0.5)
    run(moving, 0.4)
    assert (states(moving).positions == before.positions).all()
    assert joint(moving) > at + 0.05
    run(moving, 0.2)
    assert states(moving).positions[1] == pytest.approx(joint(moving))
    works_again(moving)


def test_lost_states_are_not_reported(moving: SimulatedDriver) -> None:
    moving.inject("drop_states")
    run(moving, 0.1)
    assert moving.joint_states() is None
    works_again(moving)


@pytest.mark.parametrize(("fault", "value"), [("nan_states", np.nan), ("zero_states", 0.0)])
def test_wrong_states_are_reported(moving: SimulatedDriver, fault: str, value: float) -> None:
    moving.inject(fault)
    shown = states(moving)
    assert shown.positions == pytest.approx(np.full(16, value), nan_ok=True)
    assert shown.velocities == pytest.approx(np.full(16, value), nan_ok=True)
    works_again(moving)


def test_slow_joints_fall_behind(moving: SimulatedDriver) -> None:
    at = joint(moving)
    moving.inject("slow", 0.05)
    run(moving, 1.0)
    assert joint(moving) - at == pytest.approx(0.05, abs=0.002)
    works_again(moving)


def test_lost_commands_change_nothing(moving: SimulatedDriver) -> None:
    moving.inject("drop_commands", 0.3)
    order(moving, 0.0, 0.1)
    at = joint(moving)
    assert run(moving, 0.25)[-1] == pytest.approx(at + SPEED * 0.25, abs=0.003)
    works_again(moving)


def test_late_commands_come_later(exact_driver: SimulatedDriver) -> None:
    exact_driver.inject("delay_commands", 0.4)
    at = joint(exact_driver)
    order(exact_driver, 0.1, 0.2)
    assert np.ptp([at, *run(exact_driver, 0.39)]) == 0.0
    assert run(exact_driver, 0.25)[-1] == pytest.approx(at + 0.1, abs=1e-6)
    works_again(exact_driver)


@pytest.mark.parametrize(("value", "left", "right"), [(0.0, False, False), (1.0, False, True), (2.0, True, False)])
def test_lost_calibration(exact_driver: SimulatedDriver, value: float, left: bool, right: bool) -> None:
    exact_driver.inject("gripper_uncalibrated", value)
    status = exact_driver.status
    assert (status.left_gripper_calibrated, status.right_gripper_calibrated) == (left, right)
    for name, calibrated in (("left", left), ("right", right)):
        if calibrated:
            exact_driver.command_gripper(name, 0.02)
        else:
            with pytest.raises(SingulationError, match="not calibrated"):
                exact_driver.command_gripper(name, 0.02)
    works_again(exact_driver)


def test_a_stuck_hand_does_not_move(exact_driver: SimulatedDriver) -> None:
    exact_driver.command_gripper("left", 0.04)
    run(exact_driver, 0.4)
    exact_driver.inject("gripper_stuck", 1.0)
    run(exact_driver, 1.0)
    assert exact_driver.arms["left"].gripper.opening == pytest.approx(0.02, abs=1e-3)
    works_again(exact_driver)


@pytest.mark.parametrize(
    ("fault", "value", "words"),
    [("unplugged", 0.0, "unknown fault"), ("slow", float("nan"), "finite"), ("gripper_stuck", 3.0, "1 left, 2 right")],
)
def test_nonsense_is_refused(exact_driver: SimulatedDriver, fault: str, value: float, words: str) -> None:
    with pytest.raises(InvalidInputError, match=words):
        exact_driver.inject(fault, value)
    works_again(exact_driver)


@pytest.mark.parametrize("fault", FAULTS)
def test_every_fault_ends_with_a_reset(moving: SimulatedDriver, fault: str) -> None:
    moving.inject(fault)
    run(moving, 0.1)
    works_again(moving)
