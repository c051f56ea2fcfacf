"""The robot behind the controllers: following, limits, hands, joint states."""

import numpy as np
import pytest
from numpy.typing import NDArray

from singulation_core import InvalidInputError, ResultCode, SingulationError
from singulation_sim.driver import (
    ARMS,
    PERIOD,
    DriverMode,
    DriverSettings,
    JointTrajectory,
    SimulatedDriver,
)
from singulation_sim.driver.trajectory import point
from yumi_push_executor.kinematics import YumiArm

MAX_SPEED = YumiArm("left").velocity


def run(driver: SimulatedDriver, seconds: float) -> NDArray[np.float64]:
    """(cycles, 7) positions of the left arm while time passes."""
    path = []
    for _ in range(round(seconds / PERIOD)):
        driver.step()
        path.append(driver.arms["left"].positions)
    return np.array(path)


def order(driver: SimulatedDriver, change: float, seconds: float, arm: str = "left") -> NDArray[np.float64]:
    """Send the second joint (free both ways at home) elsewhere; the target."""
    target = np.array(driver.arms[arm].positions)
    target[1] += change
    trajectory = JointTrajectory(driver.settings.joints[arm], [point(seconds, target, np.zeros(7))])
    driver.command_arm(arm, trajectory)
    return target


def test_it_starts_at_home_and_stays_there(exact_driver: SimulatedDriver) -> None:
    path = run(exact_driver, 1.0)
    assert np.ptp(path, axis=0).max() == 0.0
    for name in ARMS:
        assert exact_driver.arms[name].positions == pytest.approx(YumiArm(name).clear_view)
    assert exact_driver.now == pytest.approx(11.0)
    assert not exact_driver.is_moving


def test_without_lag_it_is_where_the_spline_is(exact_driver: SimulatedDriver) -> None:
    start = exact_driver.arms["left"].positions
    target = order(exact_driver, 0.4, 1.0)
    path = run(exact_driver, 1.2)
    # From rest to rest in 1 s a cubic is half way after 0.5 s, 15.625 % of the way after 0.25 s.
    assert (path[125, 1] - start[1]) / 0.4 == pytest.approx(0.5, abs=0.01)
    assert (path[63, 1] - start[1]) / 0.4 == pytest.approx(0.15625, abs=0.01)
    assert path[-1] == pytest.approx(target, abs=1e-12)


def test_lag_delays_by_its_time_constant() -> None:
    driver = SimulatedDriver(DriverSettings(lag=0.05, position_noise=0.0, velocity_noise=0.0))
    start = driver.arms["left"].positions
    target = start + np.array((0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0))
    driver.command_arm("left", JointTrajectory(driver.settings.joints["left"], [point(2.0, target)]))
    path = run(driver, 1.0)
    # A ramp of 0.25 rad/s is followed 0.05 s late once the transient has gone.
    commanded = start[1] + 0.25 * (len(path) - 1) * PERIOD
    assert commanded - path[-1, 1] == pytest.approx(0.25 * 0.05, rel=0.1)
    assert run(driver, 2.0)[-1] == pytest.approx(target, abs=1e-8)


def test_joints_are_never_faster_than_they_can(exact_driver: SimulatedDriver) -> None:
    order(exact_driver, 1.5, PERIOD)
    path = run(exact_driver, 2.0)
    assert np.abs(np.diff(path, axis=0) / PERIOD).max() <= MAX_SPEED[1] * (1.0 + 1e-9)
    assert exact_driver.status.mode is DriverMode.MOTORS_ON


def test_a_reference_outside_the_joint_range_shuts_the_motors_down(exact_driver: SimulatedDriver) -> None:
    order(exact_driver, 4.0, 1.0)
    path = run(exact_driver, 2.0)
    status = exact_driver.status
    assert (status.mode, status.motion_enabled) == (DriverMode.MOTORS_OFF, False)
    assert "yumi_robl_joint_2" in status.message
    assert (path[:, 1] <= YumiArm("left").upper[1]).all()
    exact_driver.reset()
    target = order(exact_driver, -0.2, 0.5)
    assert run(exact_driver, 1.0)[-1] == pytest.approx(target, abs=1e-9)


def test_arms_move_independently(exact_driver: SimulatedDriver) -> None:
    target = order(exact_driver, 0.3, 0.5, arm="right")
    path = run(exact_driver, 0.6)
    assert np.ptp(path, axis=0).max() == 0.0
    assert exact_driver.arms["right"].positions == pytest.approx(target)


def test_unknown_arm_is_refused(exact_driver: SimulatedDriver) -> None:
    with pytest.raises(InvalidInputError, match="one of: left, right"):
        exact_driver.command_gripper("middle", 0.01)
    exact_driver.command_gripper("left", 0.01)


def test_fingers_move_25_mm_per_second(exact_driver: SimulatedDriver) -> None:
    hand = exact_driver.arms["left"].gripper
    exact_driver.command_gripper("left", 0.05)
    run(exact_driver, 0.5)
    assert hand.finger_position == pytest.approx(0.0125, abs=1e-4)
    assert hand.finger_velocity == pytest.approx(0.025)
    run(exact_driver, 0.6)
    assert hand.opening == pytest.approx(0.05)
    assert not exact_driver.is_moving
    assert exact_driver.arms["right"].gripper.opening == 0.0


@pytest.mark.parametrize(("asked", "reached"), [(0.08, 0.05), (-0.01, 0.0), (0.03, 0.03)])
def test_openings_are_clipped_to_the_travel(exact_driver: SimulatedDriver, asked: float, reached: float) -> None:
    exact_driver.command_gripper("right", asked)
    run(exact_driver, 1.5)
    assert exact_driver.arms["right"].gripper.opening == pytest.approx(reached)


def test_an_uncalibrated_hand_refuses(exact_driver: SimulatedDriver) -> None:
    driver = SimulatedDriver(DriverSettings(grippers_calibrated=False))
    with pytest.raises(SingulationError) as failure:
        driver.command_gripper("left", 0.02)
    assert failure.value.code is ResultCode.GRIPPER_NOT_CALIBRATED
    assert not driver.status.left_gripper_calibrated
    with pytest.raises(InvalidInputError):
        exact_driver.command_gripper("left", float("nan"))
    exact_driver.command_gripper("left", 0.02)


def test_states_have_all_joints_by_name(exact_driver: SimulatedDriver) -> None:
    exact_driver.command_gripper("right", 0.02)
    run(exact_driver, 1.0)
    states = exact_driver.joint_states()
    assert states is not None
    values = dict(zip(states.names, states.positions, strict=True))
    assert len(values) == 16
    for letter, name in (("l", "left"), ("r", "right")):
        shown = [values[f"yumi_rob{letter}_joint_{number}"] for number in range(1, 8)]
        assert shown == pytest.approx(YumiArm(name).clear_view)
    assert values["gripper_r_joint"] == pytest.approx(0.01)
    assert values["gripper_l_joint"] == 0.0


def test_noise_is_as_large_as_told_and_repeats_with_the_seed() -> None:
    def series(seed: int) -> NDArray[np.float64]:
        driver = SimulatedDriver(DriverSettings(position_noise=1e-3, velocity_noise=1e-2), seed=seed)
        states = [driver.joint_states() for _ in range(300)]
        return np.array([(item.positions[:14], item.velocities[:14]) for item in states if item is not None])

    first = series(1)
    assert first[:, 0].std(axis=0).mean() == pytest.approx(1e-3, rel=0.1)
    assert first[:, 1].std(axis=0).mean() == pytest.approx(1e-2, rel=0.1)
    assert (series(1) == first).all()
    assert (series(2) != first).any()
