"""What one arm is commanded, cycle by cycle."""

import numpy as np
import pytest
from numpy.typing import NDArray

from singulation_core import InvalidInputError
from singulation_sim.driver.controller import TrajectoryController
from singulation_sim.driver.trajectory import JointTrajectory, TrajectoryPoint, point

JOINTS = ("a", "b")


def controller() -> TrajectoryController:
    return TrajectoryController(JOINTS, np.array((0.0, 0.0)))


def state(a: float = 0.0, b: float = 0.0, velocity: float = 0.0) -> TrajectoryPoint:
    return point(0.0, [a, b], [velocity, velocity])


def reference(arm: TrajectoryController, now: float, measured: TrajectoryPoint | None = None) -> NDArray[np.float64]:
    return arm.reference(now, measured or state())


def test_it_holds_without_a_trajectory() -> None:
    arm = controller()
    assert reference(arm, 1.0, state(0.3, 0.3)).tolist() == [0.0, 0.0]
    assert not arm.is_moving


def test_it_starts_from_the_measured_state_not_from_the_last_command() -> None:
    arm = controller()
    arm.command(JointTrajectory(JOINTS, [point(1.0, [1.0, 1.0])]), 5.0)
    assert reference(arm, 5.0, state(0.2, 0.4)) == pytest.approx([0.2, 0.4])
    assert reference(arm, 5.5) == pytest.approx([0.6, 0.7])
    assert reference(arm, 6.0) == pytest.approx([1.0, 1.0])
    assert not arm.is_moving
    assert reference(arm, 60.0) == pytest.approx([1.0, 1.0])


def test_with_velocities_the_first_piece_takes_up_the_measured_velocity() -> None:
    arm = controller()
    arm.command(JointTrajectory(JOINTS, [point(1.0, [1.0, 1.0], [0.0, 0.0])]), 0.0)
    before = reference(arm, 0.0, state(velocity=0.5))
    after = reference(arm, 1e-4)
    assert (after - before) / 1e-4 == pytest.approx([0.5, 0.5], abs=1e-3)


def test_a_first_point_at_time_zero_is_commanded_at_once() -> None:
    arm = controller()
    arm.command(JointTrajectory(JOINTS, [point(0.0, [1.0, 1.0]), point(1.0, [2.0, 2.0])]), 3.0)
    assert reference(arm, 3.0) == pytest.approx([1.0, 1.0])
    assert reference(arm, 3.5) == pytest.approx([1.5, 1.5])


def test_a_stamp_in_the_future_is_approached_from_now_on() -> None:
    arm = controller()
    arm.command(JointTrajectory(JOINTS, [point(0.0, [1.0, 1.0]), point(1.0, [2.0, 2.0])], stamp=12.0), 10.0)
    assert reference(arm, 10.0) == pytest.approx([0.0, 0.0])
    assert reference(arm, 11.0) == pytest.approx([0.5, 0.5])
    assert reference(arm, 12.5) == pytest.approx([1.5, 1.5])


def test_points_in_the_past_are_skipped() -> None:
    arm = controller()
    arm.command(JointTrajectory(JOINTS, [point(1.0, [1.0, 1.0]), point(3.0, [3.0, 3.0])], stamp=10.0), 12.0)
    assert reference(arm, 12.0) == pytest.approx([2.0, 2.0])


def test_a_new_trajectory_replaces_the_old_one_entirely() -> None:
    arm = controller()
    arm.command(JointTrajectory(JOINTS, [point(1.0, [1.0, 1.0]), point(2.0, [9.0, 9.0])]), 0.0)
    reference(arm, 0.0)
    arm.command(JointTrajectory(JOINTS, [point(1.0, [-1.0, -1.0])]), 0.5)
    assert reference(arm, 0.5, state(0.4, 0.4)) == pytest.approx([0.4, 0.4])
    assert reference(arm, 5.0) == pytest.approx([-1.0, -1.0])


def test_a_refused_trajectory_leaves_the_running_one_alone() -> None:
    arm = controller()
    arm.command(JointTrajectory(JOINTS, [point(1.0, [1.0, 1.0])]), 0.0)
    reference(arm, 0.0)
    with pytest.raises(InvalidInputError):
        arm.command(JointTrajectory(JOINTS, []), 0.2)
    assert reference(arm, 0.5) == pytest.approx([0.5, 0.5])
    arm.command(JointTrajectory(JOINTS, [point(0.5, [0.0, 0.0])]), 0.5)
    assert reference(arm, 0.5, state(0.5, 0.5)) == pytest.approx([0.5, 0.5])
    assert reference(arm, 1.0) == pytest.approx([0.0, 0.0])


def test_hold_forgets_everything() -> None:
    arm = controller()
    arm.command(JointTrajectory(JOINTS, [point(1.0, [1.0, 1.0])]), 0.0)
    reference(arm, 0.0)
    arm.hold(np.array((0.3, 0.4)))
    assert not arm.is_moving
    assert reference(arm, 0.9) == pytest.approx([0.3, 0.4])
